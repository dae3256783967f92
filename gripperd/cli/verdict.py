"""A diagnosis on a terminal."""

from collections.abc import Mapping

from rich.console import Group
from rich.padding import Padding
from rich.table import Table
from rich.text import Text

from gripperd.cli.console import console
from gripperd.cli.model import PIPE_WIDTH
from gripperd.diagnose.diagnosis import Diagnosis
from gripperd.diagnose.objection import contradicted, left_out
from gripperd.diagnose.readings.columns import BY_QUANTITY
from gripperd.diagnose.statement import offered, statement, summary
from gripperd.diagnose.verdict.conclude import Verdict
from gripperd.diagnose.verdict.figures import chance, fixed, stopped
from gripperd.diagnose.verdict.gap import Gap
from gripperd.diagnose.verdict.key import Key, keys_of, public
from gripperd.diagnose.verdict.named import Named
from gripperd.diagnose.verdict.recalibrated import recalibrated
from gripperd.diagnose.verdict.region import Region, span, way
from gripperd.model.effect import Signal
from gripperd.report.untested import untested

COLOURS = {
    Verdict.NAMED: "green",
    Verdict.NONE: "green",
    Verdict.AMBIGUOUS: "yellow",
    Verdict.UNEXPLAINED: "yellow",
    Verdict.UNUSABLE: "red",
}
REGION = {"time": "", "pressure": "", "contraction": "contraction ", "temperature": ""}
"""What is told of a region, and the word before it where the unit does not say."""
FAR = 0.7
"""Tolerances by which a constant has moved far enough to be told. [-]"""
PLACES = 6
"""Places told on a terminal; all are in the document."""


def show(diagnosis: Diagnosis) -> None:
    """Print the verdict and what it rests on."""
    told = console()
    if not told.is_terminal:
        told.width = PIPE_WIDTH
    colour = COLOURS[diagnosis.verdict]
    told.print(
        Text.assemble(
            (f"{diagnosis.verdict.value}  ", f"bold {colour}"),
            (summary(diagnosis), "bold"),
        )
    )
    unseen = untested(diagnosis)
    parts = [
        (_found_title(diagnosis), _effects(diagnosis)),
        ("where the recalibrated model is off", _where(diagnosis)),
        (
            "how far measured and predicted are apart, on held-out runs",
            _gaps(diagnosis, diagnosis.gaps) if diagnosis.gaps else None,
        ),
        (
            "the same where no other sweep went: extrapolation",
            _extrapolation(diagnosis),
        ),
        ("constants that moved by most of their tolerance", _lines(_moved(diagnosis))),
        ("what is left, in words", _lines(diagnosis.signature)),
        ("what could be taken off", _lines(list(map(offered, diagnosis.corrections)))),
        ("what to run next", _lines(_next(diagnosis))),
        ("left out", _lines(left_out(diagnosis.recording.rejected))),
        ("contradictions", _lines(_contradictions(diagnosis))),
        ("remarks", _lines(diagnosis.recording.remarks)),
        ("not testable with this recording", _lines(unseen.recording)),
        ("not testable with this model", _lines(unseen.model)),
    ]
    for title, part in parts:
        if part is not None:
            told.print(Text(f"\n{title}", style="bold"))
            told.print(Padding(part, (0, 0, 0, 2), expand=False))


def _found_title(diagnosis: Diagnosis) -> str:
    unexplained = diagnosis.verdict is Verdict.UNEXPLAINED
    return "what came nearest" if unexplained else "what was found"


def _effects(diagnosis: Diagnosis) -> Group | None:
    if not diagnosis.named:
        return None
    table = Table(
        "name", "stage", "parameters (± 1 sigma)", "p", "ΔBIC", "also", box=None
    )
    for entry in diagnosis.named:
        keys = keys_of(entry)
        words = [f"{name} {word}" for name, word in entry.chosen.items()]
        numbers = [_number(entry, name, key) for name, key in keys.items()]
        table.add_row(
            public(entry.name),
            entry.stage,
            "\n".join((*words, *numbers)),
            chance(entry.p_value),
            f"{entry.delta_bic:.0f}",
            "\n".join(map(public, entry.equivalents)) or "-",
        )
    said = [Text(statement(diagnosis, entry)) for entry in diagnosis.named]
    return Group(*said, Text(), table)


def _number(entry: Named, name: str, key: Key) -> str:
    one = entry.parameters[name]
    value, doubt = (
        fixed(size / key.factor, one.std / key.factor) for size in (one.value, one.std)
    )
    if one.std == 0:
        return f"{key.text} {value}, chosen"
    held = ", at its bound" if stopped(one) else ""
    return f"{key.text} {value} ± {doubt}{held}"


def _where(diagnosis: Diagnosis) -> Table | None:
    if not diagnosis.where:
        return None
    table = Table("stage", "run", "region", "off by", "p", box=None)
    for one in diagnosis.where[:PLACES]:
        table.add_row(
            one.stage, one.run, _region(one.region), _sized(one.signal, one.bias),
            chance(one.p_value),
        )  # fmt: skip
    if more := len(diagnosis.where) - PLACES:
        table.add_row("", f"and {more} more", "", "", "") if more > 0 else None
    return table


def _region(region: Region) -> str:
    said = [
        f"{label}{span(region, name)} {BY_QUANTITY[name].unit}".rstrip()
        for name, label in REGION.items()
        if name in region
    ]
    return ", ".join([*said, way(region)] if way(region) else said)


def _extrapolation(diagnosis: Diagnosis) -> Group | None:
    beyond = diagnosis.extrapolation
    if beyond is None:
        return None
    runs = ", ".join(beyond.runs)
    if beyond.gaps == diagnosis.gaps:
        return Group(Text(f"{runs}: nothing else was held out, so it is the gap above"))
    return Group(Text(runs), _gaps(diagnosis, beyond.gaps))


def _gaps(diagnosis: Diagnosis, gaps: Mapping[Signal, Gap]) -> Table:
    adds = diagnosis.verdict.establishes
    after = ["with what was found"] if adds else []
    table = Table("", "as it came", "recalibrated", *after, "noise floor", box=None)
    for signal, gap in gaps.items():
        left = [gap.after] if adds else []
        sizes = (gap.before, gap.recalibrated, *left, gap.noise_floor)
        style = "bold" if signal is diagnosis.main else ""
        table.add_row(
            signal.value, *(_sized(signal, size) for size in sizes), style=style
        )
    return table


def _sized(signal: Signal, size: float) -> str:
    column = BY_QUANTITY[signal.value]
    return f"{size / column.scale:.3g} {column.unit}"


def _next(diagnosis: Diagnosis) -> list[str]:
    proposal = diagnosis.proposal
    if proposal is None:
        return []
    title = f"{proposal.title}: " if proposal.title else ""
    return [f"{title}{proposal.why}"]


def _moved(diagnosis: Diagnosis) -> list[str]:
    told = recalibrated(diagnosis.found.problem, diagnosis.told)
    far = [one for one in told if abs(one.moved) > FAR]
    return [
        f"{one.key.title} {one.key.shown(one.model * one.key.factor)} ->"
        f" {one.key.shown(one.fit * one.key.factor)}, {one.moved:+.1f} tolerances"
        for one in sorted(far, key=lambda one: -abs(one.moved))
    ]


def _contradictions(diagnosis: Diagnosis) -> list[str]:
    found = diagnosis.recording.contradictions
    return [contradicted(one, len(one.runs + one.others)) for one in found]


def _lines(lines: "list[str] | tuple[str, ...]") -> Text | None:
    return Text("\n".join(lines)) if lines else None
