"""Pictures of sweeps: those held out, before and after, and the one to run next."""

import numpy as np

from gripperd.diagnose.readings.columns import BY_QUANTITY, Column
from gripperd.diagnose.readings.recording import Kind
from gripperd.diagnose.verdict.next_experiment import Proposal
from gripperd.model.track import Array
from gripperd.report.trace import State, Trace, broken, elided, stretches
from gripperd.report.where import COLOURS
from gripperd.reproduce.drawing import BLUE, INK, MUTED, VERMILION, canvas
from gripperd.reproduce.picture import Picture

MOST = 3
"""Sweeps shown side by side."""
DOTS = 400
"""Samples drawn of each."""
TITLE = 24
"""Letters that fit above one of them."""
ALONG = {
    Kind.ISOMETRIC: "pressure",
    Kind.ISOBARIC: "contraction",
    Kind.CYCLE: "contraction",
}
DASHES = {
    State.NOMINAL: ":",
    State.RECALIBRATED: "--",
    State.EXPLAINED: "-",
    State.NEAREST: "-",
}


def held_out(found: tuple[Trace, ...], column: Column) -> Picture | None:
    """Sweeps that took no part, as measured and as three models have them."""
    shown = [one for one in found if one.held_out.sum() > 1][:MOST]
    if not shown:
        return None
    drawing = canvas(9.0, 5.2)
    grid = drawing.subplots(
        2, len(shown), squeeze=False, sharex="col", sharey="row", height_ratios=(3, 2)
    )
    for index, one in enumerate(shown):
        upper, lower = grid[0, index], grid[1, index]
        label, x = _along(one)
        rows = np.flatnonzero(one.held_out)
        stride = max(1, rows.size // DOTS)
        dots = rows[::stride]
        upper.plot(
            x[dots], one.measured[dots], ".", color=INK, ms=3, alpha=0.55,
            label="measured",
        )  # fmt: skip
        parts = [rows[part] for part in stretches(one.time[rows], stride)]
        way = broken(x, parts)
        for state in one.expected:
            look = {"color": COLOURS[state], "ls": DASHES[state]}
            expected = broken(one.expected[state], parts)
            upper.plot(way, expected, lw=1.6, label=state.value, **look)
            lower.plot(way, broken(one.residual(state), parts), lw=1.2, **look)
        lower.axhline(0, color=INK, lw=0.8)
        upper.set_title(elided(one.run, TITLE), parse_math=False)
        lower.set_xlabel(label)
    unit = column.unit or "-"
    grid[0, 0].set_ylabel(f"{column.quantity} [{unit}]")
    grid[1, 0].set_ylabel(f"measured - predicted [{unit}]")
    grid[0, 0].legend(loc="best", fontsize=9)
    caption = (
        "None of these samples was used to fit anything, but for the side to which dry"
        " friction points where a muscle is held. Above what was measured and"
        " predicted, below the difference. Lines are broken where samples are missing"
        " or passed over."
    )
    made = len(shown[0].expected)
    alt = f"The measurement and {made} predictions of each sweep: {len(shown)} of them."
    return Picture("held_out", "Sweeps that took no part", caption, alt, drawing)


def plan(proposal: Proposal | None) -> Picture | None:
    """Pressure and contraction over time of the sweep to run next."""
    if proposal is None or "t_s" not in proposal.plan:
        return None
    drawing = canvas(8.0, 3.4)
    upper, lower = drawing.subplots(2, 1, sharex=True)
    time = proposal.plan["t_s"]
    for axes, key, colour in (
        (upper, "pressure_kPa", BLUE),
        (lower, "contraction", VERMILION),
    ):
        values = proposal.plan[key]
        axes.plot(time, values, color=colour, marker="o", ms=4, mec=MUTED, mew=0.5)
        axes.margins(y=0.15)
    upper.set_ylabel("pressure [kPa]")
    lower.set(ylabel="contraction [-]", xlabel="time [s]")
    title = proposal.title[:1].upper() + proposal.title[1:]
    caption = f"{title}: {proposal.why}."
    return Picture("plan", "The sweep to run next", caption, caption, drawing)


def _along(one: Trace) -> tuple[str, Array]:
    """What a sweep was swept along, or time."""
    name = ALONG.get(one.kind) if one.kind else None
    if name is None or name not in one.levels:
        return "time in the sweep [s]", one.time
    return f"{name} [{BY_QUANTITY[name].unit or '-'}]", one.levels[name]
