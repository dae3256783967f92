"""What the page tells in tables: numbers as a person reads them."""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from gripperd.diagnose.correction.offer import Offer
from gripperd.diagnose.diagnosis import Diagnosis
from gripperd.diagnose.fit.rival import Rival
from gripperd.diagnose.readings.columns import BY_QUANTITY
from gripperd.diagnose.search.found import Found
from gripperd.diagnose.search.rivalry import EVEN
from gripperd.diagnose.verdict.figures import chance, fixed, stopped
from gripperd.diagnose.verdict.gap import Gap
from gripperd.diagnose.verdict.key import keys_of, public
from gripperd.diagnose.verdict.recalibrated import recalibrated
from gripperd.diagnose.verdict.region import span, way
from gripperd.reproduce.chapters import Table

RANKED = 12
"""Candidates listed with their gain."""
PLACES = 12
"""Findings listed; the document has all."""
NARROW_SPACE = "\u202f"
IDLE = 0.05
"""Loss of evidence below which something more changed nothing at all. [nat]"""
NORMAL_95 = 1.96
"""Half width of the central 95 % of a normal law. [standard deviations]"""


@dataclass(frozen=True, slots=True)
class Bar:
    """One line of a chart."""

    label: str
    value: str
    share: float
    """Length, of the whole width. [0..1]"""
    chosen: bool = False


@dataclass(frozen=True, slots=True)
class Bars:
    """A chart of lines, and a mark across them."""

    caption: str
    lines: tuple[Bar, ...]
    mark: float
    """Place of the mark, of the whole width. [0..1]"""


def gap_bars(diagnosis: Diagnosis, gap: Gap) -> Bars:
    """Draw the gap on held-out runs: as it came, recalibrated, with what was found."""
    column = BY_QUANTITY[gap.signal.value]
    sizes = {
        "as it came": gap.before,
        "better constants alone": gap.recalibrated,
        "with what was found": gap.after,
        "noise floor": gap.noise_floor,
    }
    adds = diagnosis.verdict.establishes
    if not adds:
        del sizes["with what was found"]
    top = max(sizes.values()) or 1.0
    lines = tuple(
        Bar(
            label,
            f"{size / column.scale:.3g} {column.unit}",
            size / top,
            chosen=label == "with what was found",
        )
        for label, size in sizes.items()
    )
    caption = f"{gap.signal.value}: root mean square of measured minus predicted"
    if adds:
        low, high = (end / column.scale for end in gap.ci95_after)
        caption += f"; with what was found {low:.3g} to {high:.3g} {column.unit} (95 %)"
    return Bars(caption, lines, gap.noise_floor / top)


def ranking(diagnosis: Diagnosis) -> Bars | None:
    """Draw what each candidate alone would gain, best first."""
    found = diagnosis.found
    gains = sorted(_alone(found).items(), key=lambda pair: -pair[1])[:RANKED]
    if not gains or gains[0][1] <= 0:
        return None
    top = max(gains[0][1], found.threshold)
    names = {entry.name for entry in diagnosis.named}
    lines = tuple(
        Bar(
            public(name),
            f"{gain:,.0f}".replace(",", NARROW_SPACE),
            max(gain, 0.0) / top,
            chosen=name in names,
        )
        for name, gain in gains
    )
    caption = (
        "Gain of each candidate alone, in log odds (nat), to first order where it came"
        " nowhere near. Noise alone passes the line"
        " in fewer than one recording of a hundred; an offset or a constant, which has"
        " no form to choose, is believed from less"
    )
    return Bars(caption, lines, found.threshold / top)


def _alone(found: Found) -> dict[str, float]:
    """Gain of each name, of those that came near by a full fit. [nat].

    Far from where the model is, the first order may promise what no fit keeps.
    """
    full: dict[str, float] = {}
    for rival in found.rivals:
        if len(rival.names) == 1:
            full.setdefault(rival.names[0], rival.evidence - found.null.evidence)
    return found.gains | full


def contenders(diagnosis: Diagnosis) -> Table:
    """Explanations that were fitted in full, best first."""
    best = diagnosis.contest.best
    rows: dict[tuple[str, ...], tuple[str, ...]] = {}
    for rival in sorted(_fitted(diagnosis), key=lambda one: -one.evidence):
        names = tuple(sorted(map(public, rival.names)))
        behind = best.evidence - rival.evidence
        if set(rival.names) > set(best.names) and abs(behind) < IDLE:
            continue
        misfit = 1 + rival.excess / rival.fit.samples
        label = " + ".join(names) or "better constants alone"
        rows.setdefault(names, (label, f"{behind + 0.0:.1f}", f"{misfit:.2f}"))
    best_is = "is told" if diagnosis.told is best else "came nearest"
    return Table(
        "Explanations fitted in full",
        ("explanation", f"behind what {best_is} [nat]", "χ² per sample"),
        tuple(list(rows.values())[:RANKED]),
    )


def overruled(diagnosis: Diagnosis) -> bool:
    """Whether something else than what is told has more evidence."""
    told = diagnosis.told.evidence
    return any(one.evidence > told + EVEN for one in _fitted(diagnosis))


def _fitted(diagnosis: Diagnosis) -> list[Rival]:
    contest = diagnosis.contest
    rivals = [contest.best, *(one for place in contest.places for one in place.rivals)]
    return rivals + [one for one in diagnosis.found.rivals if one.names]


def numbers(diagnosis: Diagnosis) -> Table | None:
    """Everything fitted of what was found, with intervals."""
    rows = tuple(_numbers(diagnosis))
    columns = ("of", "parameter", "value", "± 1 sigma", "95 % interval")
    return Table("Parameters", columns, rows) if rows else None


def _numbers(diagnosis: Diagnosis) -> Iterator[tuple[str, ...]]:
    for entry in diagnosis.named:
        for name, word in entry.chosen.items():
            yield public(entry.name), name, word, "chosen", "-"
        for name, key in keys_of(entry).items():
            one = entry.parameters[name]
            half = NORMAL_95 * one.std
            ends = np.clip([one.value - half, one.value + half], one.low, one.high)
            value, doubt, low, high = (
                fixed(size / key.factor, one.std / key.factor)
                for size in (one.value, one.std, *ends.tolist())
            )
            # A law that was chosen for its 0 is not fitted.
            if one.std == 0:
                yield public(entry.name), key.text, value, "chosen", "-"
                continue
            held = ", at its bound" if stopped(one) else ""
            yield public(entry.name), key.text, value, doubt, f"{low} to {high}{held}"


def constants(diagnosis: Diagnosis) -> Table:
    """Constants of the model: as they came, and as they fit."""
    rows = tuple(
        (
            one.key.title,
            f"{one.model:.5g}",
            f"{one.tolerance:.2g}" + ("" if one.constant.stated else " (assumed)"),
            f"{one.fit:.5g}",
            f"{one.std:.2g}",
            f"{one.moved:+.1f} sigma",
            (one.key.unit or "-").replace("_per_", "/"),
        )
        for one in recalibrated(diagnosis.found.problem, diagnosis.told)
    )
    columns = ("constant", "model", "tolerance", "fit", "± 1 sigma", "moved by", "unit")
    return Table("Constants of the model", columns, rows)


def correction(offer: Offer) -> Table:
    """What a correction depends on, over which way, and how far it reaches."""
    found = offer.correction
    table = []
    for one, length, ends in zip(
        found.regressors, found.lengths, found.ends.T, strict=True
    ):
        low, high = one.written(ends).tolist()
        over = "does not matter" if length is None else f"{length / one.scale:.3g}"
        reach = f"{low:.4g} to {high:.4g}"
        table.append((one.quantity, over, reach, one.unit or "-"))
    columns = ("quantity", "changes over", "fence", "unit")
    return Table("What the correction depends on", columns, tuple(table))


def places(diagnosis: Diagnosis) -> Table | None:
    """Stretches in which the recalibrated model is off, largest first."""
    rows = tuple(
        (
            one.run,
            one.stage,
            f"{one.bias / BY_QUANTITY[one.signal.value].scale:+.3g}"
            f" {BY_QUANTITY[one.signal.value].unit}",
            chance(one.p_value),
            *(span(one.region, name) for name in ("time", "pressure", "contraction")),
            way(one.region) or "-",
        )
        for one in diagnosis.where[:PLACES]
    )
    columns = (
        "run", "stage", "off by", "p-value", "time [s]", "pressure [kPa]",
        "contraction", "way",
    )  # fmt: skip
    return Table("Where, with better constants alone", columns, rows) if rows else None
