"""How good the answers are: each figure with its goal and its interval.

References
----------
.. [1] C. J. Clopper, E. S. Pearson, "The use of confidence or fiducial limits
       illustrated in the case of the binomial", Biometrika 26(4), 404-413, 1934.
"""

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from itertools import permutations

from scipy.stats import binomtest

from tests.exam.answer import Answer, Entry, Hidden, Residue

LARGEST_CLASS = 3
"""Names that a stated equivalence class may have."""
CLOSED = 1.15
"""Held-out residual over noise floor that counts as closed. [-]"""
WORSE = 1.01
"""Residual over that of recalibration from which it counts as worse. [-]"""
RECOGNISED = {"offset_80ms": "channel_delay"}
"""Artefacts for which the library has a name."""


@dataclass(frozen=True, slots=True)
class Mark:
    """One share, and what it should be."""

    what: str
    goal: float
    """Share to reach, or not to exceed. [0..1]"""
    at_least: bool
    hits: int
    total: int

    @property
    def share(self) -> float:
        """Share of the cases. [0..1]."""
        return self.hits / self.total if self.total else float("nan")

    @property
    def interval(self) -> tuple[float, float]:
        """Where the true share lies with 95 % confidence [1]_."""
        if not self.total:
            return 0.0, 1.0
        found = binomtest(self.hits, self.total).proportion_ci(0.95, "exact")
        return float(found.low), float(found.high)

    @property
    def verdict(self) -> str:
        """Whether the goal is met, beyond doubt or as far as these cases tell."""
        if not self.total:
            return "-"
        low, high = self.interval
        met = self.share >= self.goal if self.at_least else self.share <= self.goal
        sure = not low < self.goal < high
        return ("met" if met else "missed") + ("" if sure else " (open)")


def marks(answers: Sequence[Answer]) -> list[Mark]:
    """Mark the answers of one family."""
    singles, pairs = _kind(answers, "single"), _kind(answers, "pair")
    drift, outside = _kind(answers, "drift"), _kind(answers, "outside")
    artefacts = _kind(answers, "artefact")
    floored = [one for one in singles if one.verdict == "named"]
    return [
        _mark("single: exact name, alone", 0.90, exact, singles),
        worst(singles),
        _mark("single: truth within a class of 3", 0.98, within, singles),
        _mark("single: right stage", 0.98, staged, singles),
        _mark("pair: both within their classes", 0.80, both, pairs),
        _mark("pair: at least one", 0.97, within, pairs),
        _mark("none: false alarm", -0.02, alarmed, _kind(answers, "none")),
        _mark("drift: false alarm", -0.04, alarmed, drift),
        _mark("outside: unexplained", 0.90, abstained, outside),
        _mark("outside: confident wrong name", -0.04, confident, outside),
        _mark("artefact: false physical name", -0.05, misled, artefacts),
        _mark("named single: after <= 1.15 stated floor", 0.90, closed, floored),
        _mark("  the same against the sensors' floor", 0.90, closed_truly, floored),
        _mark("all: worse than recalibrated constants", -0.02, worsened, answers),
        _mark("  the same of the signal that is spoilt", -0.02, spoilt, answers),
        _mark("  the same of any above 1.15 stated floor", -0.02, harmed, answers),
        _mark("all: error", -0.0, lambda one: bool(one.error), answers),
    ]


def exact(one: Answer) -> bool:
    """Whether the one effect is named, no other, and nothing is left open."""
    return one.verdict == "named" and [e.name for e in one.physical] == _truth(one)


def within(one: Answer) -> bool:
    """Whether some effect that is hidden is in a class that is named."""
    return any(_covers(entry, truth) for entry in one.physical for truth in one.hidden)


def both(one: Answer) -> bool:
    """Whether each of two hidden effects has an entry of its own."""
    return any(
        all(map(_covers, chosen, one.hidden))
        for chosen in permutations(one.physical, len(one.hidden))
    )


def staged(one: Answer) -> bool:
    """Whether an effect is named where the hidden one acts."""
    stages = {truth.stage for truth in one.hidden}
    return within(one) or any(entry.stage in stages for entry in one.physical)


def alarmed(one: Answer) -> bool:
    """Whether physics is said to be missing; better constants are no alarm."""
    return bool(one.physical) or one.verdict not in ("none", "named", "ambiguous")


def abstained(one: Answer) -> bool:
    """Whether it is said that the library does not explain it."""
    return one.verdict == "unexplained"


def confident(one: Answer) -> bool:
    """Whether an effect is named without any doubt."""
    return one.verdict == "named" and bool(one.physical)


def misled(one: Answer) -> bool:
    """Whether an effect is named that is not what was done to the recording."""
    done = {RECOGNISED.get(name, "") for name in one.question.names}
    return any(not entry.members & done for entry in one.physical)


def residue(one: Answer) -> Residue | None:
    """Held-out residual of the signal that the hidden effect spoils.

    None when no sweep that was left out measured it: then nothing was shown. A wrong
    contraction has no residual of its own and shows in the main signal.
    """
    signal = one.hidden[0].signal if one.hidden else one.main
    return one.gaps.get(one.main if signal == "contraction" else signal)


def closed(one: Answer) -> bool:
    """Whether the residual is down at the noise the diagnosis states."""
    left = residue(one)
    return left is not None and left.after <= CLOSED * left.stated_floor


def closed_truly(one: Answer) -> bool:
    """Whether the residual is down at the noise the rig put on."""
    left = residue(one)
    return left is not None and left.after <= CLOSED * left.sensor_floor


def worsened(one: Answer) -> bool:
    """Whether any signal is worse off than with better constants alone."""
    return any(gap.after > WORSE * gap.recalibrated for gap in one.gaps.values())


def spoilt(one: Answer) -> bool:
    """Whether the signal that the hidden effect spoils is worse off so."""
    left = residue(one)
    return left is not None and left.after > WORSE * left.recalibrated


def harmed(one: Answer) -> bool:
    """Whether any signal is worse off and is not down at the noise."""
    return any(
        gap.after > max(WORSE * gap.recalibrated, CLOSED * gap.stated_floor)
        for gap in one.gaps.values()
    )


def worst(singles: Sequence[Answer]) -> Mark:
    """Mark the effect that is named exactly least often."""
    names = sorted({one.hidden[0].name for one in singles if one.hidden})
    each = [
        _mark(
            f"  worst effect: {name}",
            0.60,
            exact,
            [one for one in singles if one.hidden and one.hidden[0].name == name],
        )
        for name in names
    ]
    none = Mark("  worst effect", 0.60, at_least=True, hits=0, total=0)
    return min(each, key=lambda mark: (mark.share, -mark.total), default=none)


def _truth(one: Answer) -> list[str]:
    return [truth.name for truth in one.hidden]


def _covers(entry: Entry, truth: Hidden) -> bool:
    return truth.name in entry.members and len(entry.members) <= LARGEST_CLASS


def _kind(answers: Iterable[Answer], kind: str) -> list[Answer]:
    return [one for one in answers if one.question.kind == kind]


def _mark(
    what: str, goal: float, hit: Callable[[Answer], bool], of: Sequence[Answer]
) -> Mark:
    """Mark a share; a goal of minus x means x at most."""
    at_least = goal > 0
    return Mark(what, abs(goal), at_least, sum(map(hit, of)), len(of))
