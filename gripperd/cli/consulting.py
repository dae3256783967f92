"""What ``gripperd doctor`` looks at: machine, ports, whoever answers, grippers."""

from collections.abc import Callable, Iterator, Sequence
from pathlib import Path

from gripperd.cli.processes import REAL_TIME_PRIORITY, control_socket
from gripperd.config import BenchBus, GripperSettings, Settings, load_settings
from gripperd.config.durable import create_file
from gripperd.doctor.attempt import Attempt
from gripperd.doctor.examination import LINE, Examination
from gripperd.doctor.finding import Finding, Result
from gripperd.doctor.first_settings import settings_text
from gripperd.doctor.identity import AnyModule, Certainty
from gripperd.doctor.machine import this_machine
from gripperd.doctor.ports import serial_port, serial_ports
from gripperd.doctor.probe import Found, Probe, opened
from gripperd.drivers.bus import Address, SerialAddress, TcpAddress, open_bus
from gripperd.drivers.serial_port import IN_USE
from gripperd.errors import InputError, LinkError
from gripperd.link.buses import BusFigures, ReadBuses
from gripperd.link.client import Client

FREE = (
    "end the program that has it open; a daemon shows its exchanges with `bus monitor`"
)
ODD = (
    "see whether another master, another protocol or noise is on the line, and whether"
    " it echoes"
)


def surroundings(port: str | None, settings: Settings | None) -> Iterator[Finding]:
    """Findings about the machine and its serial ports, without opening any."""
    yield from this_machine().findings(REAL_TIME_PRIORITY)
    known = {each.path: each for each in serial_ports()}
    grippers = settings.grippers.values() if settings else ()
    buses = (gripper.bus for gripper in grippers)
    configured = (bus.port for bus in buses if isinstance(bus, SerialAddress))
    for path in filter(None, (port, *configured)):
        device = Path(path).resolve()
        if not any(Path(each).resolve() == device for each in known):
            known[path] = serial_port(Path(path))
    for each in known.values():
        yield from each.findings
    if not known:
        remedy = "plug the adapter in, if the modules are on a serial line"
        yield Finding("machine", "serial ports", Result.not_possible("none", remedy))


async def probe(
    attempts: Sequence[Attempt],
    modules: Sequence[AnyModule],
    tell: Callable[[str, float], None],
) -> tuple[list[Found], list[Finding]]:
    """Whoever answers, and findings about them."""
    subject, asking = str(attempts[0].address), Probe(modules, tell)
    try:
        found = await asking.search(attempts)
    except LinkError as error:
        remedy = FREE if str(error).endswith(IN_USE) else LINE
        found, result = [], Result.failed(str(error), remedy)
        return found, [Finding(subject, "probe", result)]
    findings = [
        Finding(subject, f"unit {each.unit}", _identified(each)) for each in found
    ]
    findings += [
        Finding(subject, "line", Result.warning(note, ODD))
        for note in dict.fromkeys(asking.notes)
    ]
    if not found:
        result = Result.failed("nobody answered", LINE)
        findings.append(Finding(subject, "probe", result))
    return found, findings


def _identified(found: Found) -> Result:
    identity = found.identity
    names = " or ".join(module.name for module in identity.modules)
    said = f"{names or 'something that answers'}, {identity.certainty}: "
    said += identity.grounds
    if identity.certainty in {Certainty.NAMED, Certainty.LIKELY}:
        return Result.ok(said)
    return Result.warning(said, "see on the label which module it is")


async def examine(settings: Settings) -> list[Finding]:
    """Findings about every gripper of the settings, with what its modules say."""
    findings = [Finding("daemon", "owner of the buses", await _owner(settings))]
    for name, gripper in settings.grippers.items():
        examination = Examination(
            name, gripper.output, gripper.input, gripper.chain.regulator
        )
        findings += examination.on_paper()
        address = _address(gripper, settings)
        if address is None:
            said = "the bench takes any free port"
            remedy = "name one under bench.tcp to have it asked"
            unknown = Result.not_possible(said, remedy)
            findings.append(Finding(name, "link", unknown))
            continue
        async with open_bus(address) as bus:
            await opened(bus)
            findings += [each async for each in examination.on_the_line(bus)]
    return findings


async def _owner(settings: Settings) -> Result:
    """Whether a daemon with these settings has its buses open."""
    control = Client(control_socket(settings), "the control process")
    try:
        buses = await control.ask(ReadBuses(), list[BusFigures])
    except LinkError:
        return Result.ok("no daemon with these settings runs")
    finally:
        await control.close()
    names = " and ".join(bus.name for bus in buses)
    remedy = (
        "stop it to have modules on a serial line checked; `gripperd bus monitor` shows"
        " what it says to them"
    )
    return Result.warning(f"a daemon runs, and owns {names}", remedy)


def write_settings(path: Path, found: Sequence[Found]) -> None:
    """Write a first settings file; one that is there stays as it is.

    Raises
    ------
    InputError
        There is a file of that name, or none can be written there.
    Refused
        No output module was identified.
    """
    text = settings_text(found, path.parent)
    try:
        create_file(path, text, load_settings)
    except FileExistsError as error:
        message = f"{path} is there already, and stays as it is; name another file"
        raise InputError(message, key="--write") from error
    except OSError as error:
        message = f"{path} cannot be written: {error.strerror}"
        raise InputError(message, key="--write") from error


def _address(gripper: GripperSettings, settings: Settings) -> Address | None:
    """Where to ask; None where nobody knows."""
    if not isinstance(gripper.bus, BenchBus):
        return gripper.bus
    bench = settings.bench
    return TcpAddress(host=bench.host, port=bench.port) if bench.port else None
