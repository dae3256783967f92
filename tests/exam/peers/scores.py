"""Methods side by side."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
from rich.table import Table

from tests.exam.marks import CLOSED, WORSE, Mark
from tests.exam.peers.classes import families
from tests.exam.peers.contest import METHODS, OURS, Outcome, Turn
from tests.exam.peers.exhibit import Guess

BLIND = tuple(METHODS)[3:]
"""Methods that cannot name a single effect, only a family."""
WITHIN = ("single", "pair")
"""Kinds of cases that hide what the library holds."""


@dataclass(frozen=True, slots=True)
class Seen:
    """A case and the guess of one method."""

    outcome: Outcome
    guess: Guess

    @property
    def exact(self) -> bool:
        """Whether the first name is that of the hidden effect."""
        return self.guess.names[:1] == (self.outcome.hidden[0].name,)

    @property
    def familiar(self) -> bool:
        """Whether it points at a family of the hidden effect."""
        return bool(self.guess.families & families(self.outcome.hidden[0].name))

    @property
    def alarmed(self) -> bool:
        """Whether it finds anything at all."""
        return bool(self.guess.names or self.guess.families)

    @property
    def worse(self) -> bool:
        """Whether any signal is worse off than with better constants alone."""
        before = self.outcome.recalibrated
        return any(self.guess.after[s] > WORSE * before[s] for s in before)

    @property
    def harmed(self) -> bool:
        """Whether any signal is worse off so, and is not down at the noise."""
        before, floors = self.outcome.recalibrated, self.outcome.floors
        return any(
            self.guess.after[s] > max(WORSE * before[s], CLOSED * floors[s])
            for s in before
        )

    @property
    def gap(self) -> float:
        """Held-out residual over the noise floor, in the worst signal of an effect."""
        after, floors = self.guess.after, self.outcome.floors
        shown = {one.signal for one in self.outcome.hidden}
        signals = {signal if signal in after else "force" for signal in shown}
        return max(after[signal] / floors[signal] for signal in signals)


def side_by_side(outcomes: Sequence[Outcome]) -> Table:
    """One line a method; each share with the number of cases behind it."""
    table = Table(
        "method",
        "exact",
        "family",
        "false alarms",
        "gap / floor",
        "made worse",
        "above noise",
        "seconds",
        title=f"{len(outcomes)} cases, the same for all",
    )
    for name in (OURS, *METHODS):
        turns = [(one, one.turns[name]) for one in outcomes if name in one.turns]
        table.add_row(name, *_line(name, turns))
    return table


def _line(name: str, turns: Sequence[tuple[Outcome, Turn]]) -> tuple[str, ...]:
    seen = [Seen(outcome, turn.guess) for outcome, turn in turns if turn.guess]
    failed = [turn.error for _, turn in turns if not turn.guess]
    if not seen:
        return (failed[0].splitlines()[-1] if failed else "", *[""] * 6)
    singles = [one for one in seen if one.outcome.question.kind == "single"]
    nothing = [one for one in seen if one.outcome.question.kind in ("none", "drift")]
    within = [one.gap for one in seen if one.outcome.question.kind in WITHIN]
    gaps = np.percentile(within, (50, 90)) if within else (np.nan, np.nan)
    seconds = np.mean([turn.seconds for _, turn in turns if turn.guess])
    return (
        "cannot" if name in BLIND else _share(singles, lambda one: one.exact),
        _share(singles, lambda one: one.familiar),
        _share(nothing, lambda one: one.alarmed),
        "{:.2f}, {:.2f}".format(*gaps),
        _share(seen, lambda one: one.worse),
        _share(seen, lambda one: one.harmed),
        f"{seconds:.1f}" + (f", {len(failed)} failed" if failed else ""),
    )


def _share(of: Sequence[Seen], hit: Callable[[Seen], bool]) -> str:
    mark = Mark("", 0.0, at_least=True, hits=sum(map(hit, of)), total=len(of))
    if not of:
        return "-"
    low, high = mark.interval
    return f"{100 * mark.share:.0f} % ({100 * low:.0f}..{100 * high:.0f})"
