"""Units at the boundaries. Inside the package every value is SI.

A name in a file, a request or a reply carries its unit as a suffix, such as
``diameter_mm``; :func:`split` tells name and unit apart.
"""

import math

MILLI = 1e-3
KILO = 1e3
MEGA = 1e6

STANDARD_GRAVITY = 9.80665
"""Standard acceleration of free fall, exact by definition (CGPM 1901). [m/s²]"""

SI_PER_UNIT = {
    "N_per_mm_s": 1e3,
    "N_per_mm": 1e3,
    "mA_per_s": MILLI,
    "kPa_per_s": KILO,
    "m_per_s2": 1.0,
    "mm_per_N": MILLI,
    "N_per_s": 1.0,
    "per_s": 1.0,
    "per_cycle": 1.0,
    "per_kN": 1e-3,
    "per_MPa": 1e-6,
    "per_K2": 1.0,
    "per_K": 1.0,
    "N_s": 1.0,
    "percent": 0.01,
    "kPa": KILO,
    "MPa": MEGA,
    "mA": MILLI,
    "mm": MILLI,
    "deg": math.pi / 180.0,
    "ms": MILLI,
    "Hz": 1.0,
    "g": 1e-3,
    "N": 1.0,
    "s": 1.0,
}
"""Factor from each boundary unit to SI; longer suffixes stand first."""


def split(key: str) -> tuple[str, str | None]:
    """Tell the name and the unit of a boundary key apart.

    >>> split("spring_rate_N_per_mm")
    ('spring_rate', 'N_per_mm')
    >>> split("friction_coefficient")
    ('friction_coefficient', None)
    """
    for unit in SI_PER_UNIT:
        if key.endswith(f"_{unit}"):
            return key.removesuffix(f"_{unit}"), unit
    return key, None
