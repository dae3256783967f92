"""The zero of each force sensor, kept in the state directory over restarts."""

# ruff: noqa: N815  (names carry units, and units have capitals)

from dataclasses import dataclass
from datetime import UTC, datetime
from pathlib import Path
from typing import Annotated

from pydantic import AwareDatetime, Field

from gripperd.config.document import read_document
from gripperd.config.durable import replace_file
from gripperd.config.section import Section
from gripperd.config.settings import BenchBus, GripperSettings
from gripperd.config.text import yaml_text
from gripperd.config.validation import validated
from gripperd.control.tare import MOST
from gripperd.control.zero import UNTARED, Zero
from gripperd.errors import ConfigError

FOLDER = "zeros"
"""In the state directory."""
LASTS = 7 * 86400.0
"""After so long a force sensor may have drifted as far as a tare is worth. [s]"""
DAY = 86400.0


class ZeroSection(Section):
    """The file of one gripper."""

    zero_N: float = Field(ge=-MOST, le=MOST)
    taken_at: Annotated[AwareDatetime, Field(strict=False)]
    sensor: str
    """Which one it is the zero of."""


@dataclass(frozen=True, slots=True)
class KeptZero:
    """What counts at the start of control, and what a person should hear of it."""

    zero: Zero = UNTARED
    remark: str | None = None


def kept_zero(folder: Path, gripper: GripperSettings, now: float) -> KeptZero:
    """Read the zero that an earlier life kept.

    One that cannot be read, or is that of another sensor, does not count; an old one
    does. Whatever is found, the remark says so.

    Parameters
    ----------
    folder
        The state directory.
    gripper
        Whose force sensor it is.
    now
        Seconds since the epoch.
    """
    path = _file(folder, gripper)
    try:
        path.stat()
        found = validated(ZeroSection, read_document(path))
    except FileNotFoundError:
        return KeptZero()
    except (ConfigError, OSError) as error:
        return KeptZero(remark=f"the force sensor is not tared: {error}")
    if found.sensor != (sensor := sensor_of(gripper)):
        return KeptZero(
            remark=f"the force sensor is not tared: {path} is of {found.sensor}, not of"
            f" {sensor}"
        )
    zero = Zero(found.zero_N, found.taken_at.timestamp())
    text = f"adopted the zero of the force sensor, {zero.force:.2f} N"
    return KeptZero(zero, f"{text}, {_age(found.taken_at, now)}")


def keep_zero(folder: Path, gripper: GripperSettings, zero: Zero) -> None:
    """Keep a zero for the next life; after a power cut there is the old or the new.

    Raises
    ------
    OSError
        It was not kept.
    """
    assert zero.taken_at is not None
    kept = {
        "zero_N": zero.force,
        "taken_at": datetime.fromtimestamp(zero.taken_at, UTC).isoformat(),
        "sensor": sensor_of(gripper),
    }
    replace_file(_file(folder, gripper), yaml_text(kept))


def sensor_of(gripper: GripperSettings) -> str:
    """Name the force sensor by its place and its span, so that another is noticed."""
    inputs = gripper.input
    if inputs is None or "grip" not in inputs.sensors:
        return "no sensor"
    wiring, bus = inputs.sensors["grip"], gripper.bus
    scale = wiring.scale
    return (
        f"channel {wiring.channel} of {inputs.module.name}, unit {inputs.unit} on"
        f" {'the bench' if isinstance(bus, BenchBus) else bus},"
        f" {scale.value_low:g} to {scale.value_high:g} N"
    )


def _age(taken_at: datetime, now: float) -> str:
    age = now - taken_at.timestamp()
    when = f"taken at {taken_at:%Y-%m-%d %H:%M:%S} UTC"
    if age < 0:
        return f"{when}, which is yet to come: look at the clock, and tare again"
    if age > LASTS:
        return f"{when}, {age / DAY:.0f} days ago: tare again"
    return when


def _file(folder: Path, gripper: GripperSettings) -> Path:
    return folder / FOLDER / f"{gripper.name}.yaml"
