"""Find where simulation and measurement disagree, name the effect, show the gain.

Pure: recordings come in as arrays, verdicts go out as values.
"""
