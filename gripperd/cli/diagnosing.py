"""The command that finds what a model lacks, and may add it."""

import json
import os
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from gripperd import __version__
from gripperd.cli.app import ConfigFile, app
from gripperd.cli.interrupt import interruptible
from gripperd.cli.outputs import check_outputs, write
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
    # JSON on stdout stands alone there.
    told = as_json != STDOUT
    written: list[str] = []
    with interruptible(lambda: f"wrote {', '.join(written) or 'nothing'}"):
        asked = _asked(model, config, gripper)
        read = {"the recording": recording, "the model": Path(asked.source)}
        if recording.name:
            read["the side file of the recording"] = recording.with_suffix(".yaml")
        if config is not None:
            read["the configuration"] = config
        check_outputs(_outputs(as_json, report), read)
        if add:
            from gripperd.cli.parentage import parent_of

            # What cannot be kept is refused before anybody waits for it.
            parent_of(asked, config)
        found = _found(recording, asked, seed)
        if as_json is not None:
            _write_json(found, asked, as_json)
            written.append(as_json if told else "stdout")
        if told:
            told = _shown(found)
        if report is not None:
            _write_report(found, asked, report, told=told)
            written.append(str(report))
        if add:
            from gripperd.cli.acceptance import accept

            # JSON on stdout stands alone there, but what was kept is told.
            typer.echo("\n".join(accept(found, asked, config)), err=not told)


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


def _outputs(as_json: str | None, report: Path | None) -> dict[str, Path]:
    """Files to write, by their options."""
    written: dict[str, Path] = {}
    if as_json is not None and as_json != STDOUT:
        written["--json"] = Path(as_json)
    if report is not None:
        written["--report"] = report
    return written


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


def _shown(found: "Diagnosis") -> bool:
    """Print the verdict; False where nobody reads on, as behind ``| head``.

    Then what is to be written is written all the same.
    """
    from gripperd.cli.verdict import show

    try:
        show(found)
    # So rich ends a program whose output nobody takes.
    except SystemExit:
        return False
    return True


def _write_json(found: "Diagnosis", model: "ModelFile", place: str) -> None:
    from gripperd.diagnose.document import document

    said = document(found, model=model.name, program=__version__)
    text = json.dumps(said, indent=2, ensure_ascii=False, allow_nan=False) + "\n"
    if place == STDOUT:
        typer.echo(text, nl=False)
    else:
        write(Path(place), text)


def _write_report(
    found: "Diagnosis", model: "ModelFile", place: Path, *, told: bool
) -> None:
    from gripperd.report import page

    write(place, page(found, model=model.name, program=__version__))
    if told:
        typer.echo(f"wrote {place.resolve().as_uri()}")
