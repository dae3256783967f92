"""What drawing needs and not every installation has."""

from gripperd.errors import InputError

DRAWING = frozenset({"jinja2", "markupsafe", "matplotlib"})
"""Packages of the extras ``reproduce`` and ``report``."""


def not_installed(missing: ModuleNotFoundError, extra: str) -> Exception:
    """Say which extra would help; give back the error when none would."""
    package = (missing.name or "").partition(".")[0]
    if package not in DRAWING:
        return missing
    return InputError(f"drawing needs {package}: pip install 'gripperd[{extra}]'")
