"""What stands between the settings and the hardware: found, identified, checked.

Nothing is ever written to a module.
"""
