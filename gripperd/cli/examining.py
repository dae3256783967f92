"""``gripperd doctor``: what is wrong with the hardware, and what to do about it."""

import asyncio
import json
import re
from collections.abc import Sequence
from logging import CRITICAL
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import structlog
import typer

from gripperd.cli.app import FAILED, ConfigFile, Json, app
from gripperd.cli.waiting import progress
from gripperd.doctor.attempt import BAUDS, PARITIES, Attempt, Protocol, SerialSearch
from gripperd.drivers.address import Parity, TcpAddress
from gripperd.errors import InputError
from gripperd.units import MILLI

if TYPE_CHECKING:
    from gripperd.doctor.finding import Finding
    from gripperd.doctor.probe import Found

UNITS = re.compile(r"([0-9]{1,3})(?:-([0-9]{1,3}))?")
LAST_UNIT = 247
"""Of Modbus on a serial line (Modbus over serial line V1.02, section 2.2)."""
HOST_PORT = re.compile(r"(?:\[([0-9A-Fa-f:.]+)\]|([^\s:\[\]]+)):([0-9]{1,5})")
TCP_TIMEOUT, SERIAL_TIMEOUT = 500.0, 150.0
"""Longest wait for a unit; a gateway has to wait for its own line. [ms]"""


@app.command()
def doctor(  # noqa: PLR0913  (its options)
    port: Annotated[
        str | None, typer.Option(help="Serial port to probe, such as /dev/ttyUSB0.")
    ] = None,
    tcp: Annotated[
        str | None, typer.Option(help="HOST:PORT of Modbus TCP to probe.")
    ] = None,
    config: ConfigFile = None,
    units: Annotated[str, typer.Option(help="Units to ask, as 1-8 or 3.")] = "1-8",
    baud: Annotated[
        list[int] | None, typer.Option(min=1200, help="Speed to try; else common ones.")
    ] = None,
    parity: Annotated[
        Parity | None, typer.Option(help="Parity to try; else N and E.")
    ] = None,
    protocol: Annotated[
        list[Protocol] | None, typer.Option(help="What to speak; else all.")
    ] = None,
    timeout_ms: Annotated[
        float | None, typer.Option(min=1, max=10_000, help="Wait for each reply.")
    ] = None,
    write: Annotated[
        Path | None, typer.Option(help="Write first settings for what is found.")
    ] = None,
    as_json: Json = False,
) -> None:
    """Look at machine, ports and modules, and say what to do about what is wrong.

    With --port or --tcp it asks who is there; with a configuration it checks what the
    modules say against it. It only reads. Exit 1 if a check has failed.
    """
    from gripperd.cli import consulting
    from gripperd.config import load_settings

    _check_targets(port, tcp, write)
    # What happens to a line is among the findings.
    structlog.configure(wrapper_class=structlog.make_filtering_bound_logger(CRITICAL))
    numbers = _units(units)
    attempts: Sequence[Attempt] = ()
    if tcp is not None:
        attempts = (_over_tcp(tcp, numbers, timeout_ms or TCP_TIMEOUT),)
    elif port is not None:
        search = SerialSearch(
            port=port,
            units=numbers,
            timeout=(timeout_ms or SERIAL_TIMEOUT) * MILLI,
            bauds=baud or BAUDS,
            parities=(parity,) if parity else PARITIES,
            protocols=protocol or tuple(Protocol),
        )
        attempts = tuple(search.attempts)
    settings = load_settings(config) if config is not None else None
    findings = list(consulting.surroundings(port, settings))
    found, answers = _probed(attempts)
    findings += answers
    if settings is not None:
        findings += asyncio.run(consulting.examine(settings))
    _report(found, findings, as_json=as_json)
    if write is not None:
        consulting.write_settings(write, found)
        typer.echo(f"{write} is written; read it before anything else", err=True)
    if any(each.result.verdict == "failed" for each in findings):
        raise typer.Exit(FAILED)


def _check_targets(port: str | None, tcp: str | None, write: Path | None) -> None:
    if port is not None and tcp is not None:
        message = "give --port or --tcp, not both"
        raise InputError(message, key="--port")
    if write is not None and port is None and tcp is None:
        message = "--write needs --port or --tcp, to know what is there"
        raise InputError(message, key="--write")


def _probed(
    attempts: Sequence[Attempt],
) -> "tuple[list[Found], list[Finding]]":
    from gripperd.cli.consulting import probe
    from gripperd.config.module_library import ModuleLibrary

    if not attempts:
        return [], []
    longest = sum(attempt.longest for attempt in attempts)
    asked = f"{len(attempts[0].units)} units, {len(attempts)} ways of asking"
    typer.echo(
        f"probing {attempts[0].address}: {asked}, only reads; at most {longest:.0f} s"
        " while nobody answers",
        err=True,
    )
    with progress() as tell:
        return asyncio.run(probe(attempts, tuple(ModuleLibrary().all()), tell))


def _over_tcp(address: str, units: tuple[int, ...], timeout: float) -> Attempt:
    found = HOST_PORT.fullmatch(address)
    if found is None or int(found[3]) > 65535:
        message = f"--tcp {address!r} is not HOST:PORT, such as 192.168.0.7:502"
        raise InputError(message, key="--tcp")
    host, port = found[1] or found[2], int(found[3])
    return Attempt(TcpAddress(host=host, port=port, timeout=timeout * MILLI), units)


def _units(text: str) -> tuple[int, ...]:
    found = UNITS.fullmatch(text)
    first, last = (int(found[1]), int(found[2] or found[1])) if found else (0, 0)
    if not 1 <= first <= last <= LAST_UNIT:
        message = f"--units {text!r} is not a unit or a range, within 1-{LAST_UNIT}"
        raise InputError(message, key="--units")
    return tuple(range(first, last + 1))


def _report(
    found: "Sequence[Found]", findings: "Sequence[Finding]", *, as_json: bool
) -> None:
    if as_json:
        facts = {
            "found": [_found_document(each) for each in found],
            "checks": [_document(each) for each in findings],
        }
        typer.echo(json.dumps(facts))
        return
    subject = ""
    for finding in findings:
        if finding.subject != subject:
            subject = finding.subject
            typer.echo(subject)
        result = finding.result
        typer.echo(f"  {result.verdict:<13} {finding.check}: {result.said}")
        if result.remedy and result.verdict != "ok":
            typer.echo(f"  {'':<13} -> {result.remedy}")


def _document(finding: "Finding") -> dict[str, object]:
    return {
        "subject": finding.subject,
        "check": finding.check,
        "verdict": finding.result.verdict,
        "said": finding.result.said,
        "remedy": finding.result.remedy,
    }


def _found_document(found: "Found") -> dict[str, object]:
    return {
        "bus": str(found.address),
        "unit": found.unit,
        "certainty": found.identity.certainty,
        "modules": [module.name for module in found.identity.modules],
        "grounds": found.identity.grounds,
    }
