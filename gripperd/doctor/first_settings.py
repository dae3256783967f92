"""The first settings file for what a probe has found, with comments."""

import json
from collections.abc import Mapping, Sequence
from pathlib import Path

from gripperd.config import shipped
from gripperd.doctor.probe import Found
from gripperd.drivers.address import (
    Address,
    DconAddress,
    ItvAddress,
    RtuAddress,
    TcpAddress,
)
from gripperd.errors import Refused
from gripperd.protocol.modules import InputModule, OutputModule

PROTOCOLS = {RtuAddress: "rtu", DconAddress: "dcon", ItvAddress: "itv"}
OCTETS = {RtuAddress: 60, DconAddress: 92, ItvAddress: 26}
"""On the line in one period: the output read and written, eight inputs read."""
TURNAROUND = 0.03
"""Of three exchanges, on typical modules. [s]"""
LOAD = 0.7
"""Share of a period that the line may be busy."""
TCP_RATE = 10
"""What a gateway to a line of 9600 Bd still does. [Hz]"""

TEMPLATE = """\
# Written by `gripperd doctor` from what answered; nothing here was tried with air.
#
#     gripperd config check FILE      what is wrong with this file
#     gripperd doctor --config FILE   what is wrong with the hardware
#     gripperd run --config FILE

http:
  host: 127.0.0.1
  port: 8765

grippers:
  g0:
    bus: {bus}

{output}
{inputs}
    # Put a file with the constants of your own muscle, regulator and linkage here.
    model: {model}

    # What the hardware does without power or air: vent | freeze | spring_close.
    # No software can change it, so declare the worst that the data sheets allow.
    fail_mode: vent

    # A person, or the line's controller, enables the gripper after every start.
    auto_enable: false

    # One period asks the output and the inputs and writes the output.
    rate_Hz: {rate}

# A folder, one object a file.
profiles: {profiles}
"""

OUTPUT = """\
    # Taken for: {title}
    # because {grounds} ({certainty}).
    # The channel is a guess: say which one the valve is wired to.
    # When this daemon stops the last current stays, unless a watchdog is armed, such as
    # with `watchdog: {{timeout_s: 2}}` on a module that has one.
    output: {{module: {module}{place}}}
"""
PLACE = ", unit: {unit}, channel: 0"

INPUT = """\
    # Taken for: {title}
    # because {grounds} ({certainty}).
    # Nobody can tell from here which sensor is on which channel: say it, and take the
    # signs away. Each has the current at both ends of its span.
    input:
      module: {module}
      unit: {unit}
      # pressure: {{channel: 0, current_mA: [4, 20], pressure_kPa: [0, 600]}}
      # opening: {{channel: 1, current_mA: [4, 20], opening_mm: [0, 100]}}
      # grip: {{channel: 2, current_mA: [4, 20], grip_N: [0, 100]}}
"""
NO_INPUT = "    # No input module answered: all is left to the model.\n"


def settings_text(found: Sequence[Found], folder: Path) -> str:
    """Settings of one gripper on the first output module that was identified.

    Parameters
    ----------
    found
        What answered.
    folder
        Where the file will be; models and profiles are taken from there if they are.

    Raises
    ------
    Refused
        No output module was identified.
    """
    outputs = [each for each in found if isinstance(each.identity.module, OutputModule)]
    inputs = [each for each in found if isinstance(each.identity.module, InputModule)]
    if not outputs:
        message = "no output module was identified, so that no settings are written"
        hints = ("write them by hand after config/hardware.yaml",)
        raise Refused(message, code="nothing-identified", hints=hints)
    address = outputs[0].address
    return TEMPLATE.format(
        bus=_bus(address),
        output=OUTPUT.format_map(_taken(outputs[0])),
        inputs=INPUT.format_map(_taken(inputs[0])) if inputs else NO_INPUT,
        model=_near(folder, "models/reference.yaml"),
        profiles=_near(folder, "profiles"),
        rate=_rate(address),
    )


def _taken(found: Found) -> Mapping[str, object]:
    """What a section says of a module."""
    identity = found.identity
    module = identity.module
    assert module is not None
    alone = isinstance(module, OutputModule) and module.itv
    return {
        "title": module.title,
        "grounds": " ".join(identity.grounds.split()),
        "certainty": identity.certainty,
        "module": module.name,
        "unit": found.unit,
        "place": "" if alone else PLACE.format(unit=found.unit),
    }


def _bus(address: Address) -> str:
    if isinstance(address, TcpAddress):
        return f"{{tcp: {json.dumps(str(address))}, timeout_ms: 200}}"
    line = f"serial: {json.dumps(address.port)}, baud: {address.baud}"
    spoken = f"protocol: {PROTOCOLS[type(address)]}"
    echo = isinstance(address, RtuAddress | DconAddress) and address.local_echo
    more = ", local_echo: true" if echo else ""
    return f"{{{line}, {spoken}, parity: {address.parity}{more}}}"


def _near(folder: Path, name: str) -> str:
    """A file beside the settings, or else the shipped one."""
    return name if (folder / name).exists() else json.dumps(str(shipped(name)))


def _rate(address: Address) -> int:
    """Periods in a second that the line can carry. [Hz]."""
    if isinstance(address, TcpAddress):
        return TCP_RATE
    # A character takes ten or eleven bits.
    busy = OCTETS[type(address)] * 11 / address.baud + TURNAROUND
    return max(1, int(LOAD / busy))
