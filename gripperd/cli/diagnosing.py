"""The command that finds what a model lacks, and may add it."""

import json
import os
from datetime import UTC, datetime
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from gripperd import __version__
from gripperd.cli.app import ConfigFile, app
from gripperd.cli.waiting import progress
from gripperd.errors import ConfigError, InputError

if TYPE_CHECKING:
    from gripperd.config import ModelFile
    from gripperd.diagnose.diagnosis import Diagnosis

STDOUT = "-"


@app.command()
def diagnose(  # noqa: PLR0913  (its options)
    recording: Annotated[Path, typer.Argument(help="Recording: CSV or Parquet.")],
    model: Annotated[
        Path | None,
        typer.Option(
            "--model", help="Model file, instead of the gripper's active one."
        ),
    ] = None,
    as_json: Annotated[
        str | None, typer.Option("--json", help="File to write, - for stdout.")
    ] = None,
    report: Annotated[
        Path | None, typer.Option("--report", help="Page to write, HTML.")
    ] = None,
    add: Annotated[
        bool, typer.Option("--apply", help="Keep what was named as a new version.")
    ] = False,
    seed: Annotated[int, typer.Option(min=0, help="Of every random draw.")] = 0,
    config: ConfigFile = None,
    gripper: Annotated[
        str | None,
        typer.Option("--gripper", "-g", help="Whose model; without one, the first."),
    ] = None,
) -> None:
    """Find where a model is wrong, which effect it lacks, and how much that closes."""
    for place in (report, Path(as_json) if as_json not in (None, STDOUT) else None):
        _check_place(place)
    asked = _asked(model, config, gripper)
    found = _found(recording, asked, seed)
    if as_json is not None:
        _write_json(found, asked, as_json)
    # JSON on stdout stands alone there.
    told = as_json != STDOUT
    if told:
        from gripperd.cli.verdict import show

        show(found)
    if report is not None:
        _write_report(found, asked, report, told=told)
    if add:
        _apply(found, asked, config, told=told)


def _asked(model: Path | None, config: Path | None, gripper: str | None) -> "ModelFile":
    from gripperd.cli.versions import chosen
    from gripperd.config import load_model

    if model is None:
        return chosen(config, gripper).versions.get().model
    try:
        return load_model(model)
    except ConfigError as broken:
        # The file is what was asked about, not the configuration of a daemon.
        raise InputError(str(broken), key="--model") from None


def _found(recording: Path, model: "ModelFile", seed: int) -> "Diagnosis":
    with progress() as tell:
        tell("reading", 0.0)
        from gripperd.diagnose.diagnosis import diagnose as found
        from gripperd.effects import EFFECTS
        from gripperd.recordings import read_recording

        read = read_recording(recording)
        try:
            return found(
                read,
                model.explanation(),
                model.tolerances,
                EFFECTS,
                seed,
                tell,
                len(os.sched_getaffinity(0)),
            )
        except InputError as broken:
            # The diagnosis knows no files: it names the recording.
            said = str(broken).removeprefix(f"{read.name}: ")
            raise InputError(f"{recording}: {said}", key=broken.key) from None


def _write_json(found: "Diagnosis", model: "ModelFile", place: str) -> None:
    from gripperd.diagnose.document import document

    said = document(found, model=model.name, program=__version__)
    text = json.dumps(said, indent=2, ensure_ascii=False, allow_nan=False) + "\n"
    if place == STDOUT:
        typer.echo(text, nl=False)
    else:
        _write(Path(place), text)


def _write_report(
    found: "Diagnosis", model: "ModelFile", place: Path, *, told: bool
) -> None:
    from gripperd.report import page

    _write(place, page(found, model=model.name, program=__version__))
    if told:
        typer.echo(f"wrote {place.resolve().as_uri()}")


def _apply(
    found: "Diagnosis", model: "ModelFile", config: Path | None, *, told: bool
) -> None:
    from gripperd.cli.parentage import parent_of
    from gripperd.store.improvement import improvement

    parent = parent_of(model, config)
    better = improvement(model, found, __version__)
    version = parent.versions.add(
        better.model,
        parent=parent.number,
        created_at=datetime.now(UTC),
        provenance=better.provenance,
    )
    if told:
        typer.echo(f"kept as {version.name}: {version.model.source}")
        if parent.is_configured:
            typer.echo(f"to go by it: gripperd model activate {version.number}")
        else:
            typer.echo("to go by it, name that file as the model of a gripper")


def _check_place(place: Path | None) -> None:
    """Complain before the work, not after it."""
    if place is None:
        return
    if not place.parent.is_dir():
        message = f"{place}: there is no folder {place.parent}"
        raise InputError(message)
    if place.is_dir():
        message = f"{place}: is a folder; name a file in it"
        raise InputError(message)


def _write(place: Path, text: str) -> None:
    try:
        place.write_text(text, encoding="utf-8")
    except OSError as refusal:
        message = f"{place}: cannot be written: {refusal.strerror}"
        raise InputError(message) from refusal
