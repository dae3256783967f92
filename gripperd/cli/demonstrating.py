"""The command that shows the discrepancy workflow from end to end."""

from collections.abc import Iterator
from datetime import UTC, datetime
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from gripperd import __version__
from gripperd.cli.app import app
from gripperd.cli.console import console
from gripperd.cli.interrupt import interruptible
from gripperd.cli.waiting import progress
from gripperd.demo.hidden import Hidden

if TYPE_CHECKING:
    from gripperd.demo.story import Story


@app.command("demo-discrepancy")
def demo_discrepancy(
    effect: Annotated[
        Hidden, typer.Option(help="What the rig hides from the model.")
    ] = Hidden.CREEP,
    out: Annotated[Path, typer.Option(help="Folder to write.")] = Path("discrepancy"),
    seed: Annotated[int, typer.Option(min=0, help="Of every random draw.")] = 11,
) -> None:
    """Hide an effect in a rig, find it, add it, and show that the gap shrinks."""
    with interruptible(lambda: _left(out)), progress() as tell:
        tell("running the rig", 0.0)
        from gripperd.demo.story import demonstrate

        story = demonstrate(
            out, effect, seed, program=__version__, now=datetime.now(UTC), progress=tell
        )
    told = console(soft_wrap=True)
    told.print(f"hidden   A rig has {effect}, and its model does not know.")
    for word, sentence in _told(story):
        told.print(f"{word:<8}", end=" ", style="bold")
        told.print(sentence)
    told.print(f"\n{_again(out)}\nreport: {story.report.resolve().as_uri()}")


def _left(out: Path) -> str:
    from gripperd.demo.files import FILES

    there = [name for name in FILES if (out / name).exists()]
    return f"{out} holds {', '.join(there)}" if there else "wrote nothing"


def _told(story: "Story") -> Iterator[tuple[str, str]]:
    from gripperd.diagnose.readings.columns import BY_QUANTITY
    from gripperd.diagnose.statement import statement, summary
    from gripperd.diagnose.verdict.region import span

    found = story.diagnosis
    if found.main is None or not found.named:
        yield "verdict", summary(found)
        return
    gap, column = found.gaps[found.main], BY_QUANTITY[found.main.value]
    before, recalibrated, after, floor = (
        f"{size / column.scale:.3g} {column.unit}"
        for size in (gap.before, gap.recalibrated, gap.after, gap.noise_floor)
    )
    yield "wrong", f"The {found.main} is off by {before}; it repeats within {floor}."
    for finding in found.where[:1]:
        bias = f"{finding.bias / BY_QUANTITY[finding.signal.value].scale:+.3g}"
        yield (
            "where",
            f"Better constants alone leave {bias}"
            f" {BY_QUANTITY[finding.signal.value].unit} in {finding.run},"
            f" {span(finding.region, 'time')} s.",
        )
    for entry in found.named:
        yield "missing", statement(found, entry)
    if story.better is not None:
        yield "added", f"As {story.better.name}: {story.better.model.source}"
    yield (
        "closer",
        f"{before} as it came, {recalibrated} with better constants, {after} with what"
        f" was found, on sweeps that took no part.",
    )


def _again(out: Path) -> str:
    return f"again: gripperd diagnose {out / 'rig.csv'} --model {out / 'model.yaml'}"
