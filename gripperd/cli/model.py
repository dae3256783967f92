"""Commands about versions of a model: list, show, compare, activate, go back."""

import json
from collections.abc import Iterator
from typing import TYPE_CHECKING, Annotated

import typer
from rich.table import Table

from gripperd.cli.app import ConfigFile, Json, app
from gripperd.cli.console import console

if TYPE_CHECKING:
    from gripperd.store import Change, Shelf, Version

model_app = typer.Typer(help="Look at versions of the model.", no_args_is_help=True)
app.add_typer(model_app, name="model")

PIPE_WIDTH = 240
"""Columns where there is no terminal to ask: nothing is wrapped."""
FACTS = ("parent", "created_at", "added", "refitted", "gap")
"""What is listed of a version beside its name."""

GripperName = Annotated[
    str | None,
    typer.Option("--gripper", "-g", help="Whose model; without one, the first."),
]
Which = Annotated[
    str, typer.Argument(help="Number or name of a version, or 'active'; 0: configured.")
]


@model_app.command("list")
def list_versions(
    config: ConfigFile = None, gripper: GripperName = None, as_json: Json = False
) -> None:
    """List every version, with the gap it closed."""
    from gripperd.cli.versions import chosen, summary

    shelf = chosen(config, gripper).versions.all()
    if as_json:
        found = [summary(version, shelf.active) for version in shelf.versions]
        facts = {
            "active": shelf.active,
            "versions": found,
            "complaints": shelf.complaints,
        }
        typer.echo(json.dumps(facts))
        return
    for line in _listed(shelf):
        typer.echo(line)
    for complaint in shelf.complaints:
        typer.echo(f"warning: {complaint}", err=True)


@model_app.command()
def show(
    version: Which,
    config: ConfigFile = None,
    gripper: GripperName = None,
    as_json: Json = False,
) -> None:
    """Show a version as a model file, with where it comes from."""
    from gripperd.cli.versions import chosen
    from gripperd.config import model_document, model_text

    found = chosen(config, gripper).versions.get(version)
    if as_json:
        typer.echo(json.dumps(model_document(found.model)))
    else:
        typer.echo(model_text(found.model), nl=False)


@model_app.command()
def diff(
    before: Which,
    after: Which,
    config: ConfigFile = None,
    gripper: GripperName = None,
    as_json: Json = False,
) -> None:
    """List the constants and effects in which two versions differ."""
    from gripperd.cli.versions import chosen
    from gripperd.store import difference

    versions = chosen(config, gripper).versions
    old, new = versions.get(before), versions.get(after)
    changes = difference(old.model, new.model)
    if as_json:
        listed = [
            {"path": one.path, "before": one.before, "after": one.after}
            for one in changes
        ]
        facts = {"before": old.number, "after": new.number, "changes": listed}
        typer.echo(json.dumps(facts))
    elif changes:
        _print(_change_table(old, new, changes))
    else:
        typer.echo(f"{old.name} and {new.name} do not differ")


@model_app.command()
def activate(
    version: Which,
    config: ConfigFile = None,
    gripper: GripperName = None,
    as_json: Json = False,
) -> None:
    """Go by another version; refused while a gripper of the model may hold."""
    from gripperd.cli.versions import chosen

    _tell(*chosen(config, gripper).activate(version), as_json=as_json)


@model_app.command()
def rollback(
    config: ConfigFile = None, gripper: GripperName = None, as_json: Json = False
) -> None:
    """Go back to the version that was active before; refused as for activate."""
    from gripperd.cli.versions import chosen

    _tell(*chosen(config, gripper).activate(None), as_json=as_json)


def _tell(version: "Version", taken_up: bool, *, as_json: bool) -> None:
    if as_json:
        facts = {
            "active": version.number,
            "name": version.name,
            "taken_up": taken_up,
        }
        typer.echo(json.dumps(facts))
        return
    typer.echo(f"{version.name} is active")
    if taken_up:
        typer.echo("the daemon that runs goes by it from now on")
    else:
        typer.echo("no control runs here; it goes by it from its next start")


def _listed(shelf: "Shelf") -> Iterator[str]:
    """A version and what is known of it, a line each: a table would be too wide."""
    from gripperd.cli.versions import summary

    for version in shelf.versions:
        facts = summary(version, shelf.active)
        yield f"{'*' if facts['active'] else ' '} {version.number}  {version.name}"
        for key in FACTS:
            value = facts[key]
            for index, one in enumerate(value if isinstance(value, list) else [value]):
                if one is not None:
                    yield f"     {'' if index else key:<10}  {one}"


def _change_table(
    old: "Version", new: "Version", changes: "tuple[Change, ...]"
) -> Table:
    table = Table("what", old.name, new.name, box=None)
    for change in changes:
        table.add_row(change.path, _shown(change.before), _shown(change.after))
    return table


def _shown(value: object) -> str:
    if value is None:
        return "-"
    return f"{value:.6g}" if isinstance(value, float) else str(value)


def _print(table: Table) -> None:
    told = console(highlight=True)
    if not told.is_terminal:
        told.width = PIPE_WIDTH
    told.print(table)
