"""Constants of a model that may move within their tolerance, and by how much."""

from collections import defaultdict
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from math import inf, isfinite
from typing import TypeVar

from gripperd.diagnose.residuals.explanation import Explanation, moves
from gripperd.model.effect import Effect, Signal
from gripperd.model.parameter import parameters
from gripperd.model.regulator import Regulator
from gripperd.model.track import Array
from gripperd.units import split

Sign = TypeVar("Sign", float, Array)

PLAIN = 0.0115
"""Tolerance of a constant without a stated one, relative, one sigma: parts are made to
about 2 %, and anywhere within is as likely (2 % / root 3). [-]"""
TOLERATED = 2.0
"""How far a part may be off, in sigma of its tolerance; beyond it is another part."""
MADE = 3**0.5
"""The same of a part without a stated one: where what is anywhere within ends."""
NUISANCE = 2.6
"""The same of what has no tolerance, such as the zero of a sensor."""

ZERO = 1e-3
"""Zero error that any transmitter has, of full scale, one sigma. [-]"""

CONTRACTION_ZERO = 3e-4
"""The same for contraction: 0.1 mm on 250 mm is 4e-4. [-]"""

RESPONSE = 0.02
"""Time in which a piezo or solenoid regulator follows, and how far that may be off:
10 to 60 ms at the outlet. [s]"""

SKEW = 0.004
"""Time between the samples of two channels of one scan, one sigma. [s]"""
SKEWED = ("pressure", "contraction")

FRICTION = 0.1
"""No coefficient of friction repeats better than that, whatever is stated, nor does an
effect that the model has from elsewhere without a stated tolerance. [-]"""

RESTING = 0.4
"""Prior of the sign of friction before any travel: with the bounds of a constant it
stays between -1 and 1. [-]"""
RESTING_ALL = 0.38
"""The same of what all sweeps share: most rigs come to rest from one side. Its bound
is less than 1, so that a sweep may still rest the other way. [-]"""
SHARED = "rest.all"

MUSCLE = (
    "rest_length",
    "diameter", "braid_angle", "wall_thickness", "elastic_modulus",
    "friction_coefficient",
)  # fmt: skip
PARTS = ("muscle", "valve", "gripper", "effects")
"""Parts of a model, with tolerances; the rest is how it was measured."""
PULLED = frozenset({Signal.FORCE, Signal.GRIP})
"""What goes with the pull of the muscle."""
VALVE = ("pressure_low", "pressure_high")
GRIPPER = ("open_width", "ratio", "spring_preload", "spring_rate")


@dataclass(frozen=True)
class Constant:
    """One number of the model and how far it may be off."""

    path: str
    """As in tolerances, such as ``muscle.diameter``; of an effect that the model has
    with its unit, such as ``effects.coulomb_friction.magnitude_N``."""
    nominal: float
    sigma: float
    stated: bool
    """Whether the model file states the tolerance."""
    usual: float = 0.0
    """The sigma of parts as they are made; 0 of what is no part."""
    effect: Effect | None = None
    """Of the model, that it is a size of."""

    @property
    def stated_as(self) -> str:
        """As in tolerances."""
        owner, _, name = self.path.rpartition(".")
        return self.path if self.effect is None else f"{owner}.{split(name)[0]}"

    @property
    def moves(self) -> frozenset[Signal]:
        """Signals it changes."""
        if self.effect is not None:
            return moves(self.effect) or frozenset(Signal)
        return _MOVES.get(self.path) or _MOVES[self.place[0]]

    @property
    def reads(self) -> bool:
        """Whether it changes what is thought to have happened, not what follows."""
        return self.place[0] != "gripper" and self.path not in _LATER

    @property
    def reach(self) -> float:
        """How far it may be off, in sigma."""
        if self.place[0] not in PARTS:
            return NUISANCE
        # Parts are made to a size; friction and effects are what they happen to be.
        happens = self.effect is not None or self.path.endswith("friction_coefficient")
        return TOLERATED if self.stated or happens else MADE

    def value(self, shift: float) -> float:
        """As it is when off by so many sigma, within what could be made at all."""
        low, high = self.limits
        return min(max(self.nominal + shift * self.sigma, low), high)

    @cached_property
    def place(self) -> tuple[str, str]:
        """Part that it is of, and its name there."""
        owner, _, name = self.path.partition(".")
        return owner, name

    @cached_property
    def limits(self) -> tuple[float, float]:
        """Between which it could be made at all."""
        if self.effect is not None:
            known = parameters(self.effect)[self.stated_as.rpartition(".")[2]]
            return known.low, known.high
        return _MADE_AT_ALL.get(self.path, (-inf, inf))

    @property
    def course(self) -> int | None:
        """The only sweep it changes, if there is but one."""
        owner, name = self.place
        return int(name) if owner == "rest" and self.path != SHARED else None


_MADE_AT_ALL: Mapping[str, tuple[float, float]] = {
    f"muscle.{name}": (1e-6, 1e12) for name in MUSCLE
} | {
    "muscle.braid_angle": (0.09, 0.95),
    "muscle.friction_coefficient": (0.0, 2.0),
    "gripper.open_width": (1e-6, inf),
    "gripper.ratio": (0.01, 100.0),
    "gripper.spring_preload": (0.0, inf),
    "gripper.spring_rate": (0.0, inf),
    "response.valve": (0.0, inf),
}
_JAWS = frozenset({Signal.OPENING, Signal.GRIP})
_LATER = frozenset(
    {"response.valve", "zero.opening", "zero.grip", "skew.opening", "skew.grip"}
)
_MOVES: Mapping[str, frozenset[Signal]] = {
    "muscle": frozenset({Signal.FORCE}),
    "muscle.rest_length": _JAWS | {Signal.FORCE},
    "valve": frozenset({Signal.PRESSURE}),
    "gripper": _JAWS,
    "rest": frozenset({Signal.FORCE, Signal.GRIP}),
    "response.valve": frozenset({Signal.PRESSURE}),
    "skew.pressure": frozenset({Signal.FORCE}),
    "skew.contraction": _JAWS | {Signal.FORCE},
    "skew.opening": frozenset({Signal.OPENING}),
    "skew.grip": frozenset({Signal.GRIP}),
    "zero.pressure": frozenset({Signal.PRESSURE, Signal.FORCE}),
    "zero.contraction": _JAWS | {Signal.FORCE},
    "zero.force": frozenset({Signal.FORCE, Signal.GRIP}),
    "zero.opening": frozenset({Signal.OPENING}),
    "zero.grip": frozenset({Signal.GRIP}),
}


def constants(
    explanation: Explanation,
    tolerances: Mapping[str, float],
    full_scale: Mapping[Signal, float],
    resting: Sequence[int],
) -> tuple[Constant, ...]:
    """Every constant that matters to what was measured.

    Parameters
    ----------
    explanation
        The model at its nominal constants.
    tolerances
        One sigma by path, as the model file states them. [SI]
    full_scale
        Largest value of each measured signal. [SI]
    resting
        Sweeps without travel, by index.
    """
    found = [
        constant
        for owner, part, names in (
            ("muscle", explanation.muscle, MUSCLE),
            ("valve", explanation.regulator, VALVE),
            ("gripper", explanation.linkage, GRIPPER),
        )
        for constant in _of_part(owner, part, names, tolerances)
    ]
    for effect in explanation.effects:
        found += _of_effect(effect, tolerances)
    found += [
        Constant(f"zero.{signal.value}", 0.0, zero * scale, stated=False)
        for signal, scale in full_scale.items()
        for zero in (CONTRACTION_ZERO if signal is Signal.CONTRACTION else ZERO,)
    ]
    if explanation.regulator is not None and Signal.PRESSURE in full_scale:
        found.append(Constant("response.valve", RESPONSE, RESPONSE, stated=False))
    skewed: tuple[str, ...] = SKEWED if PULLED & full_scale.keys() else ()
    skewed += tuple(signal.value for signal in full_scale if signal in _JAWS)
    found += [Constant(f"skew.{name}", 0.0, SKEW, stated=False) for name in skewed]
    found += [Constant(f"rest.{i}", 0.0, RESTING, stated=False) for i in resting]
    if resting:
        found.append(Constant(SHARED, 0.0, RESTING_ALL, stated=False))
    return tuple(found)


def _of_part(
    owner: str,
    part: object,
    names: Sequence[str],
    tolerances: Mapping[str, float],
) -> Iterator[Constant]:
    for name in names if part is not None else ():
        path = f"{owner}.{name}"
        nominal = float(getattr(part, name))
        usual = PLAIN * abs(nominal)
        if name == "pressure_low":
            assert isinstance(part, Regulator)
            usual = PLAIN / 4 * part.pressure_high
        sigma = tolerances.get(path, usual)
        if name == "friction_coefficient":
            usual = FRICTION * nominal
            sigma = max(sigma, usual)
        if sigma > 0 and isfinite(sigma):
            yield Constant(path, nominal, sigma, path in tolerances, usual)


def _of_effect(effect: Effect, tolerances: Mapping[str, float]) -> Iterator[Constant]:
    """Sizes of an effect that the model has; none of one that is as in the textbook."""
    plain = type(effect)()
    for name, known in parameters(effect).items():
        value = getattr(effect, name)
        if not known.is_amplitude or value == getattr(plain, name):
            continue
        path = f"effects.{effect.name}.{name}"
        usual = FRICTION * abs(value)
        sigma = tolerances.get(path, usual)
        if sigma > 0 and isfinite(sigma):
            unit = f"_{known.unit}" if known.unit else ""
            yield Constant(path + unit, value, sigma, path in tolerances, usual, effect)


def _resized(effect: Effect, sizes: Mapping[str, float]) -> Effect:
    """Give an effect of a model with its sizes by their paths in it."""
    own = {
        split(path.rpartition(".")[2])[0]: size
        for path, size in sizes.items()
        if path.partition(".")[0] == effect.name
    }
    return replace(effect, **own) if own else effect


def moved(
    explanation: Explanation, listed: Sequence[Constant], shifts: Sequence[float]
) -> Explanation:
    """Give the explanation with each constant off by so many sigma."""
    values: dict[str, dict[str, float]] = defaultdict(dict)
    for constant, shift in zip(listed, shifts, strict=True):
        owner, name = constant.place
        values[owner][name] = constant.value(shift)
    return replace(
        explanation,
        muscle=replace(explanation.muscle, **values.get("muscle", {})),
        regulator=explanation.regulator
        and replace(explanation.regulator, **values.get("valve", {})),
        linkage=explanation.linkage
        and replace(explanation.linkage, **values.get("gripper", {})),
        effects=tuple(
            _resized(effect, values.get("effects", {}))
            for effect in explanation.effects
        ),
        zeros={Signal(name): zero for name, zero in values.get("zero", {}).items()},
        rests=_signs(values.get("rest", {})),
        skews={Signal(name): skew for name, skew in values.get("skew", {}).items()},
        response=values.get("response", {}).get("valve", 0.0),
    )


def _signs(values: Mapping[str, float]) -> dict[int, float]:
    """Sign of friction in each sweep that rests, from its own part and the shared."""
    own = {path: min(max(sign, -1.0), 1.0) for path, sign in values.items()}
    shared = own.pop(SHARED.partition(".")[2], 0.0)
    return {int(name): together(sign, shared) for name, sign in own.items()}


def together(one: Sign, other: float) -> Sign:
    """Add two signs of friction as velocities add up: both are felt from -1 to 1."""
    return (one + other) / (1 + one * other)
