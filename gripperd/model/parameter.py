"""Parameters of an effect: their unit, their bounds, and how they are searched."""

from collections.abc import Mapping
from dataclasses import Field, dataclass, field, fields
from enum import StrEnum
from functools import cache
from math import inf
from types import MappingProxyType
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from _typeshed import DataclassInstance

_KEY = "parameter"


@dataclass(frozen=True, slots=True)
class Parameter:
    """What is known of one parameter before any measurement. SI values."""

    unit: str | None
    """Suffix of its name in files, such as ``kPa``; none for a ratio."""
    low: float
    high: float
    """Physical bounds; outside them the effect would be something else."""
    scale: float = 0.0
    """Typical size of an amplitude, 0 for a shape."""
    starts: tuple[float, ...] = ()
    """Values from which a shape is searched, none for an amplitude."""
    choices: tuple[StrEnum, ...] = ()
    """All values of a parameter that is a word, none for a number."""
    decides: bool = False
    """Whether it is a threshold: by a small step most stays, and a little leaps."""
    switches: bool = False
    """Whether 0 is a law of its own, to and from which no small step leads."""

    @property
    def is_amplitude(self) -> bool:
        """Whether the effect vanishes with it (together with its other amplitudes)."""
        return self.scale > 0

    def bends_from(self, value: object) -> bool:
        """Whether it is a shape, and a small step from a value bends the effect."""
        bends = bool(self.starts) and self.high > self.low
        return bends and not (self.switches and value == 0)


def amplitude(
    *,
    unit: str | None,
    scale: float,
    low: float,
    high: float,
    default: float = 0.0,
    decides: bool = False,
) -> Any:  # noqa: ANN401  (as dataclasses.field)
    """Declare a parameter the effect is proportional to, at least when it is small."""
    known = Parameter(unit, low, high, scale=scale, decides=decides)
    return field(default=default, metadata={_KEY: known})


def shape(
    *,
    unit: str | None,
    starts: tuple[float, ...],
    low: float,
    high: float,
    switches: bool = False,
) -> Any:  # noqa: ANN401  (as dataclasses.field)
    """Declare a parameter that bends the effect; the first start is its default."""
    known = Parameter(unit, low, high, starts=starts, switches=switches)
    return field(default=starts[0], metadata={_KEY: known})


def choice(among: type[StrEnum]) -> Any:  # noqa: ANN401  (as dataclasses.field)
    """Declare a parameter that is one of some words; the first is its default."""
    words = tuple(among)
    known = Parameter(None, -inf, inf, choices=words)
    return field(default=words[0], metadata={_KEY: known})


def parameters(
    effect: "type[DataclassInstance] | DataclassInstance",
) -> Mapping[str, Parameter]:
    """Every declared parameter of an effect, by the name of its field."""
    return _declared(effect if isinstance(effect, type) else type(effect))


@cache
def _declared(kind: "type[DataclassInstance]") -> Mapping[str, Parameter]:
    return MappingProxyType(
        {one.name: _known(one) for one in fields(kind) if _KEY in one.metadata}
    )


def in_use(
    effect: "DataclassInstance", idle: Mapping[str, tuple[str, ...]]
) -> dict[str, Parameter]:
    """Those of an effect that mean something, beside the words that it has chosen.

    Parameters
    ----------
    effect
        With its words chosen.
    idle
        Names of parameters without a meaning, by the word that takes it.
    """
    chosen = words(effect).values()
    without = {name for word in chosen for name in idle.get(word, ())}
    return {n: one for n, one in parameters(effect).items() if n not in without}


def words(effect: "DataclassInstance") -> dict[str, str]:
    """Give what an effect has chosen, by the names of the parameters that are words."""
    known = parameters(effect)
    return {
        name: str(getattr(effect, name)) for name, one in known.items() if one.choices
    }


def _known(declared: Field[Any]) -> Parameter:
    known = declared.metadata[_KEY]
    assert isinstance(known, Parameter)
    return known
