"""What could be missing: every effect of the library, and every constant."""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from itertools import product
from types import MappingProxyType

import numpy as np

from gripperd.diagnose.readings.course import is_table
from gripperd.diagnose.readings.travel import travel
from gripperd.diagnose.residuals.constants import PARTS, PULLED
from gripperd.diagnose.residuals.problem import Problem
from gripperd.model.effect import Effect, Signal, Stage, acts_in_gripper
from gripperd.model.parameter import in_use, parameters, words
from gripperd.model.track import Array

LINEAR = ("valve_offset", "valve_gain")
SAME: Mapping[str, str] = MappingProxyType({
    "valve.pressure_low": "valve_offset", "valve.pressure_high": "valve_gain",
})  # fmt: skip
"""Constants that are wrong in just the way in which an effect shows."""
NAMES: Mapping[str, str] = MappingProxyType({"contraction": "length"})
"""What people call a quantity that has another name here."""
TURNED = 0.05
"""Way back, as a share of the range, from which a pressure or a current has turned:
eight times the noise of common sensors, 0.2 to 0.6 %, and more. [-]"""
KEPT = "in the model already: its sizes were fitted again, its form is as it was"
"""Why an effect is no candidate whose form may be wrong all the same."""
UNUSUAL = 5.0
"""By so much more must an effect explain if with it the rest of the model means what it
seldom does: constants within their tolerance make up for that. [nat]"""
WRONG = "parameter:"
"""Start of the name of a candidate that is a wrong constant."""


@dataclass(frozen=True, slots=True)
class Candidate:
    """One form of one thing that could be missing."""

    name: str
    effect: Effect | None
    """With its shapes set and a typical size; none for a wrong constant."""
    constant: int | None = None
    """Index of the constant that is wrong."""

    @property
    def stage(self) -> str:
        """Where it acts, ``-`` for a constant."""
        return self.effect.stage.value if self.effect else "-"

    @property
    def kind(self) -> tuple[str, ...]:
        """Its name, and the words it chose, such as the channel that is late.

        What the rest of the model means beside it makes no other kind.
        """
        if self.effect is None:
            return (self.name,)
        known, unusual = parameters(self.effect), self.effect.unusual
        chosen = words(self.effect).items()
        own = (word for name, word in chosen if unusual.isdisjoint(known[name].choices))
        return (self.name, *own)

    @property
    def doubles(self) -> tuple[str, ...]:
        """Names of effects known to look alike."""
        return self.effect.confused_with if self.effect else ()


def surprise(effect: Effect) -> float:
    """By how much more an effect must explain than one like it. [nat]."""
    return 0.0 if effect.unusual.isdisjoint(words(effect).values()) else UNUSUAL


def candidates(
    library: Mapping[str, type[Effect]], problem: Problem, columns: frozenset[str]
) -> tuple[tuple[Candidate, ...], dict[str, str]]:
    """List everything this recording could show, and why the rest cannot be seen.

    Parameters
    ----------
    library
        Effects by name.
    problem
        The recording and the model; effects of the model are not candidates.
    columns
        Names of what was measured.
    """
    found: list[Candidate] = []
    unseen: dict[str, str] = {}
    known = {effect.name: effect for effect in problem.model.effects}
    present = frozenset(known)
    travels = any(course.direction.any() for course in problem.courses)
    has_time = not is_table(problem.courses)
    for name, kind in library.items():
        if name in present:
            if _is_bent(known[name]):
                unseen[name] = KEPT
            continue
        if reason := _unseen(problem, kind, columns):
            unseen[name] = reason
            continue
        found += [
            Candidate(name, effect)
            for effect in forms(kind)
            if present.issuperset(_bases(effect))
            and (has_time or not effect.rest().size)
            and (travels or kind.travelling.isdisjoint(words(effect).values()))
        ]
    found += _wrong_constants(library, problem)
    return tuple(found), unseen


def _is_bent(effect: Effect) -> bool:
    """Whether an effect of a model has a form of its own, beside its sizes."""
    return any(
        one.bends_from(getattr(effect, name)) and getattr(effect, name) != one.starts[0]
        for name, one in in_use(effect, effect.idle).items()
    )


def _unseen(problem: Problem, kind: type[Effect], columns: frozenset[str]) -> str:
    """Why an effect cannot be seen here; empty when it can."""
    plain = kind()
    told = columns
    if problem.is_blind and plain.stage is not Stage.SENSOR:
        told |= {Signal.FORCE.value}
    lacking = sorted(kind.needs - told)
    if lacking:
        return f"{', '.join(lacking)} not measured"
    if not (plain.stage is Stage.SENSOR or _is_compared(problem, plain)):
        return f"no sample of the {plain.signal.value} can be compared"
    basis = kind.basis
    if basis and basis not in {effect.name for effect in problem.model.effects}:
        return f"{basis} is not in the model"
    if kind.turns and not _turned(problem, kind.turns, plain.signal):
        felt = _is_felt(problem, plain.signal)
        gripped = " under a grip in what is fitted" if felt else ""
        return f"the {NAMES.get(kind.turns, kind.turns)} never went both ways{gripped}"
    if is_table(problem.courses) and (kind.timed or plain.rest().size):
        return "the recording is a table of settled points, without time"
    return ""


def _is_compared(problem: Problem, effect: Effect) -> bool:
    """Whether the signal of an effect is compared with what it follows from.

    Jaws that tell the length tell another where they are seen to bend, and so another
    pull. A play of theirs is not to be told from a length.
    """
    usual, shows = _typical(effect, 1), problem.shown(frozenset({effect.signal}))
    if acts_in_gripper(usual) and problem.model.told_by is not None:
        bends = any(course.bends for course in problem.courses)
        return effect.signal in shows or bool(bends and usual.widening(1.0, 1.0) != 0)
    return bool(shows) or effect.stage is Stage.GRIPPER


def _turned(problem: Problem, quantity: str, signal: Signal) -> bool:
    """Whether something went both ways, be it in one sweep or in two.

    Jaws that hold on hide the way back, and what rubs is as good as a constant.
    """
    courses = problem.courses
    if quantity == "contraction":
        ways = [course.direction for course in courses]
    else:
        levels = [course.level(quantity) for course in courses]
        known = np.concatenate(levels)
        least = TURNED * float(np.ptp(known[np.isfinite(known)]))
        ways = [_way(level, least) for level in levels]
    if _is_felt(problem, signal):
        blocks = [block for block in problem.blocks if block.signal in PULLED]
        ways = [ways[block.course][block.good] for block in blocks]
    return {-1.0, 1.0} <= set(np.concatenate(ways))


def _is_felt(problem: Problem, signal: Signal) -> bool:
    """Whether a signal is known but while jaws press on something."""
    return problem.is_blind and signal in PULLED


def _way(level: Array, least: float) -> Array:
    """Sign of the way of what is known, 0 where it is not."""
    known, sign = np.isfinite(level), np.zeros_like(level)
    sign[known] = travel(level[known], least) if known.any() else 0.0
    return sign


def _wrong_constants(
    library: Mapping[str, type[Effect]], problem: Problem
) -> Iterator[Candidate]:
    travelled = _turned(problem, "contraction", Signal.FORCE)
    for index, constant in enumerate(problem.constants):
        is_part = constant.place[0] in PARTS
        unseen = constant.path == "muscle.friction_coefficient" and not travelled
        if is_part and not unseen and SAME.get(constant.path) not in library:
            yield Candidate(WRONG + constant.path, None, index)


def is_exact(candidate: Candidate) -> bool:
    """Tell whether nature leaves it no form but ours: an offset, a factor, a drift."""
    effect = candidate.effect
    if effect is None:
        return False
    known = parameters(effect)
    if effect.stage is Stage.SENSOR:
        return True
    bent = any(
        one.starts and one.bends_from(getattr(effect, name))
        for name, one in in_use(effect, effect.idle).items()
    )
    return not bent and (not known or effect.name in LINEAR)


def is_plain(candidate: Candidate) -> bool:
    """Tell whether it is an offset or a factor of a reading, the same at all times."""
    effect = candidate.effect
    if effect is None or not is_exact(candidate):
        return False
    known = parameters(effect).values()
    return effect.name in LINEAR or not any(one.starts or one.choices for one in known)


def forms(kind: type[Effect]) -> list[Effect]:
    """Give an effect in all the shapes from which a search starts."""
    known = parameters(kind)
    shapes: dict[str, tuple[object, ...]] = {
        name: one.starts for name, one in known.items() if one.starts
    }
    shapes |= {name: one.choices for name, one in known.items() if one.choices}
    every = [
        _typical(replace(kind(), **dict(zip(shapes, values, strict=True))), sign)
        for sign in ((1, -1) if kind.one_sided else (1,))
        for values in product(*shapes.values())
    ]
    return [one for one in every if _is_possible(one) and not _starts_again(one)]


def _typical(effect: Effect, sign: int) -> Effect:
    """Give it the size it usually has."""
    known = in_use(effect, effect.idle).items()
    scales = {name: sign * one.scale for name, one in known if one.is_amplitude}
    return replace(effect, **scales)


def _bases(effect: Effect) -> list[str]:
    """Names of the effects that its words are about."""
    chosen = words(effect).values()
    return [effect.rests_on[word] for word in chosen if word in effect.rests_on]


def _is_possible(effect: Effect) -> bool:
    """Whether physics knows it of that sign."""
    known = parameters(effect)
    return all(known[name].low <= getattr(effect, name) for name in amplitudes(effect))


def _starts_again(effect: Effect) -> bool:
    """Whether it is another form but for what its words leave without a meaning."""
    idle = parameters(effect).keys() - in_use(effect, effect.idle).keys()
    plain = type(effect)()
    return any(getattr(effect, name) != getattr(plain, name) for name in idle)


def side(effect: Effect) -> int:
    """Sign of the amplitudes of an effect that is one-sided."""
    return -1 if sum(getattr(effect, name) for name in amplitudes(effect)) < 0 else 1


def amplitudes(effect: Effect) -> list[str]:
    """Names of the parameters in use that the effect is proportional to."""
    known = in_use(effect, effect.idle)
    return [name for name, one in known.items() if one.is_amplitude]
