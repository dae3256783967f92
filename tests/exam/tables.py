"""The results on paper."""

from collections import Counter
from collections.abc import Sequence

import numpy as np
from rich.table import Table

from tests.exam.answer import Answer
from tests.exam.marks import Mark, exact, marks, residue, within

SLOWEST, LARGEST = 15.0, 700.0
"""Goals for one case. [s, MB]"""


def confusion(answers: Sequence[Answer]) -> Table:
    """Truth against answers, a line for each truth."""
    table = Table("truth", "n", "exact", "class", "answers", title="Truth and answers")
    groups: dict[tuple[str, str], list[Answer]] = {}
    for one in answers:
        groups.setdefault((one.question.kind, _asked(one)), []).append(one)
    for (kind, truth), group in sorted(groups.items()):
        hides = kind in ("single", "pair")
        said = Counter(map(_said, group)).most_common()
        table.add_row(
            truth,
            str(len(group)),
            str(sum(map(exact, group))) if kind == "single" else "",
            str(sum(map(within, group))) if hides else "",
            ", ".join(f"{text} {n}" if n > 1 else text for text, n in said),
        )
    return table


def report(answers: Sequence[Answer], title: str) -> Table:
    """Every figure that counts, with goal and interval."""
    table = Table("figure", "goal", "cases", "share", "95 %", "", title=title)
    for mark in marks(answers):
        table.add_row(*_marked(mark))
    table.add_section()
    for name, values, goal in (
        ("seconds", [one.seconds for one in answers if not one.error], SLOWEST),
        ("MB, rig included", [one.peak_MB for one in answers], LARGEST),
    ):
        if values:
            spread = f"{np.mean(values):.1f} / {np.median(values):.1f} / "
            table.add_row(
                f"{name}: mean / median / max",
                f"<= {goal:g}",
                str(len(values)),
                spread + f"{max(values):.1f}",
                "",
                "met" if max(values) <= goal else "missed",
            )
    left = [gap for one in answers if one.hidden and (gap := residue(one))]
    if left:
        ratio = np.median([gap.stated_floor / gap.sensor_floor for gap in left])
        table.add_row("stated floor over the sensors'", "1", "", f"{ratio:.2f}", "", "")
    return table


def errors(answers: Sequence[Answer]) -> list[str]:
    """What went wrong, case by case."""
    return [f"{one.question}\n{one.error}" for one in answers if one.error]


def _marked(mark: Mark) -> tuple[str, ...]:
    low, high = mark.interval
    sign = ">=" if mark.at_least else "<="
    return (
        mark.what,
        f"{sign} {100 * mark.goal:.0f} %",
        f"{mark.hits} / {mark.total}",
        f"{100 * mark.share:.1f} %" if mark.total else "",
        f"{100 * low:.0f} .. {100 * high:.0f}" if mark.total else "",
        mark.verdict,
    )


def _asked(one: Answer) -> str:
    if one.hidden and one.question.kind != "outside":
        return " + ".join(sorted(truth.name for truth in one.hidden))
    return ": ".join((one.question.kind, *one.question.names))


def _said(one: Answer) -> str:
    if not one.entries or one.verdict not in ("named", "ambiguous"):
        return one.verdict
    return " + ".join(
        " ~ ".join((entry.name, *entry.equivalents)) for entry in one.entries
    )
