"""Commands that compute: no daemon, no hardware."""

import json
from datetime import UTC, datetime
from math import isfinite
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer
from rich.table import Table

from gripperd import __version__
from gripperd.cli.app import ConfigFile, Json, app
from gripperd.cli.console import console
from gripperd.errors import InputError
from gripperd.units import KILO, MILLI

if TYPE_CHECKING:
    from gripperd.model import Chain, Regulator

Model = Annotated[
    Path | None,
    typer.Option("--model", help="Model file; without one, the reference rig."),
]
OtherModel = Annotated[
    Path | None,
    typer.Option("--model", help="Model file, instead of the gripper's active one."),
]
GripperName = Annotated[
    str | None,
    typer.Option("--gripper", "-g", help="Whose model; without one, the first."),
]


@app.command()
def predict(  # noqa: PLR0913  (its options)
    diameter: Annotated[float, typer.Option(help="Size of the object. [mm]")],
    current: Annotated[float | None, typer.Option(help="Valve current. [mA]")] = None,
    force: Annotated[
        float | None, typer.Option(help="Grip force per jaw, instead. [N]")
    ] = None,
    stiffness: Annotated[
        float | None, typer.Option(help="Of the object; without, rigid. [N/mm]")
    ] = None,
    model: OtherModel = None,
    config: ConfigFile = None,
    gripper: GripperName = None,
    as_json: Json = False,
) -> None:
    """Predict the grip force at a current, or the current for a grip force."""
    from gripperd.model import PressedObject

    if (current is None) == (force is None):
        message = "give either --current in mA or --force in N"
        raise InputError(message, key="--current")
    chain = _chain(model, config, gripper)
    pressed = PressedObject(_above_zero("--diameter", diameter, "mm") * MILLI)
    if stiffness is not None:
        stiff = _above_zero("--stiffness", stiffness, "N/mm") * KILO
        pressed = PressedObject(pressed.diameter, stiff)
    if force is not None:
        wanted = _above_zero("--force", force, "N")
        chain.check_fits(pressed.diameter)
        amperes = chain.current_for(wanted, pressed)
    else:
        assert current is not None
        amperes = _above_zero("--current", current, "mA") * MILLI
    _check_valve(chain.regulator, amperes)
    found = chain.predict(amperes, pressed)
    facts = {
        "model": chain.name,
        "current_mA": round(found.current / MILLI, 4),
        "diameter_mm": diameter,
        "force_N": round(found.grip_force, 3),
        "std_N": round(found.grip_std, 3),
        "pressure_kPa": round(found.pressure / KILO, 3),
        "opening_mm": round(found.opening / MILLI, 3),
        "contraction": round(found.contraction, 5),
        "muscle_force_N": round(found.muscle_force, 2),
        "spring_force_N": round(found.spring_force, 2),
        "reaches": found.reaches,
        "extrapolated": found.extrapolated,
    }
    if as_json:
        typer.echo(json.dumps(facts))
        return
    typer.echo(
        f"{facts['force_N']:.1f} N per jaw, ± {facts['std_N']:.1f} N (1 sigma),"
        f" on {diameter:g} mm at {facts['current_mA']:.2f} mA"
        f" ({facts['pressure_kPa']:.1f} kPa)"
    )
    if not found.reaches:
        typer.echo("the jaws do not reach the object at this current")
    if found.extrapolated:
        typer.echo("extrapolated: the muscle is not specified for this contraction")


@app.command()
def reproduce(
    folder: Annotated[
        Path, typer.Option("--output", "-o", help="Folder to write.")
    ] = Path("reproduction"),
    model: Model = None,
) -> None:
    """Redo the paper: its equations, figures, table and claims, as a page."""
    from gripperd.config import load_chain, reference_chain
    from gripperd.reproduce import reproduce as redo

    chain = reference_chain() if model is None else load_chain(model)
    report = redo(chain, folder, version=__version__, made_at=datetime.now(UTC))
    table = Table("claim of the paper", "verdict", "here", title=None)
    for claim in report.claims:
        table.add_row(claim.statement, claim.verdict, claim.finding)
    console(highlight=True).print(table)
    typer.echo(f"wrote {(folder / 'index.html').resolve().as_uri()}")


def _chain(model: Path | None, config: Path | None, gripper: str | None) -> "Chain":
    from gripperd.cli.versions import chosen
    from gripperd.config import load_chain

    if model is not None:
        return load_chain(model)
    return chosen(config, gripper).versions.get().model.chain()


def _above_zero(name: str, value: float, unit: str) -> float:
    if not isfinite(value):
        message = f"{name} {value:g} is no finite number ({unit})"
        raise InputError(message, key=name)
    if value <= 0:
        message = f"{name} {value:g} {unit} is not above 0 {unit}"
        raise InputError(message, key=name)
    return value


def _check_valve(regulator: "Regulator", current: float) -> None:
    low, high = regulator.current_low, regulator.current_high
    if not low <= current <= high:
        message = (
            f"{current / MILLI:.2f} mA is outside {low / MILLI:g} to"
            f" {high / MILLI:g} mA, the span of the valve"
        )
        raise InputError(message, key="--current")
