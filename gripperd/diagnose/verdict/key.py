"""What files call the numbers of an effect or of a constant, and in which unit."""

from collections.abc import Mapping
from math import isfinite
from types import MappingProxyType
from typing import NamedTuple

from gripperd.diagnose.fit.candidates import WRONG
from gripperd.diagnose.verdict.named import Named
from gripperd.model.parameter import parameters
from gripperd.units import SI_PER_UNIT, split

DIGITS = 6
"""Significant digits of a number for others: far below any standard deviation."""


def rounded(value: float) -> float:
    """Round a number for others."""
    return float(f"{value:.{DIGITS}g}")


class Key(NamedTuple):
    """Key of one number in a file."""

    text: str
    """Name and unit, such as ``diameter_mm``."""
    title: str
    """For a person, such as ``diameter of the muscle``."""

    @property
    def unit(self) -> str | None:
        """Suffix of the key."""
        return split(self.text)[1]

    @property
    def factor(self) -> float:
        """SI per unit of the key; 1 for a ratio."""
        return SI_PER_UNIT[self.unit] if self.unit else 1.0

    @property
    def spelt(self) -> str:
        """Unit for a person; empty for a ratio."""
        return (self.unit or "").replace("_per_", "/")

    def shown(self, value: float) -> str:
        """Write an SI value with the unit of the key.

        >>> Key("spring_rate_N_per_mm", "rate of the spring").shown(1000.0)
        '1 N/mm'
        """
        return f"{value / self.factor:.4g} {self.spelt}".rstrip()

    def tidy(self, value: float) -> float:
        """Round an SI value in the unit of the key: no digit that means nothing."""
        return rounded(value / self.factor) * self.factor


CONSTANTS: Mapping[str, Key] = MappingProxyType(
    {
        "muscle.rest_length": Key("rest_length_mm", "rest length"),
        "muscle.diameter": Key("diameter_mm", "diameter"),
        "muscle.braid_angle": Key("braid_angle_deg", "braid angle"),
        "muscle.wall_thickness": Key("wall_thickness_mm", "wall thickness"),
        "muscle.elastic_modulus": Key("elastic_modulus_MPa", "elastic modulus"),
        "muscle.friction_coefficient": Key(
            "friction_coefficient", "friction coefficient"
        ),
        "valve.pressure_low": Key(
            "pressure_low_kPa", "pressure at the low end of the valve"
        ),
        "valve.pressure_high": Key(
            "pressure_high_kPa", "pressure at the high end of the valve"
        ),
        "gripper.open_width": Key("open_width_mm", "open width"),
        "gripper.ratio": Key("width_per_contraction", "ratio of the linkage"),
        "gripper.spring_preload": Key("spring_preload_N", "preload of the spring"),
        "gripper.spring_rate": Key("spring_rate_N_per_mm", "rate of the spring"),
        "response.valve": Key("valve_ms", "response time of the valve"),
    }
)
"""Keys by the path of a constant in a fit. Zeros and leads of the sensors, and signs of
friction, have none: they are nuisances, and never a candidate."""


def key_of(path: str) -> Key | None:
    """Key of a constant; none of a nuisance.

    >>> key_of("effects.coulomb_friction.magnitude_N").title
    'magnitude of the coulomb friction'
    """
    owner, _, rest = path.partition(".")
    if owner != "effects":
        return CONSTANTS.get(path)
    effect, _, text = rest.partition(".")
    name, _unit = split(text)
    words = (name.replace("_", " "), effect.replace("_", " "))
    return Key(text, " of the ".join(words))


def known_key(path: str) -> Key:
    """Key of a constant that has one."""
    key = key_of(path)
    assert key is not None
    return key


def keys_of(entry: Named) -> dict[str, Key]:
    """Keys of everything fitted of an effect or a constant, by its name inside."""
    if entry.path is not None:
        return dict.fromkeys(entry.parameters, known_key(entry.path))
    assert entry.effect is not None
    return {
        name: Key(f"{name}_{known.unit}" if known.unit else name, name)
        for name, known in parameters(entry.effect).items()
        if name in entry.parameters
    }


def public(name: str) -> str:
    """Name of a candidate as others read it: that of a constant with its unit.

    >>> public("parameter:muscle.diameter"), public("creep")
    ('parameter:muscle.diameter_mm', 'creep')
    """
    if not name.startswith(WRONG):
        return name
    path = name.removeprefix(WRONG)
    return f"{WRONG}{path.rpartition('.')[0]}.{known_key(path).text}"


def plain(name: str) -> str:
    """Name of a candidate in a sentence.

    >>> plain("parameter:muscle.diameter"), plain("valve_lag")
    ('a wrong diameter', 'valve lag')
    """
    if name.startswith(WRONG):
        return f"a wrong {known_key(name.removeprefix(WRONG)).title}"
    return name.replace("_", " ")


def number(value: float) -> float | None:
    """Round a number for others; none when it is not finite."""
    return rounded(value) if isfinite(value) else None
