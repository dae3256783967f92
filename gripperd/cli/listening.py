"""Listening to a bus of a running daemon, through its control process."""

import asyncio
from collections.abc import AsyncGenerator, AsyncIterator

import typer

from gripperd.cli.processes import control_socket
from gripperd.config import BenchBus, Settings
from gripperd.drivers.address import TcpAddress
from gripperd.drivers.traffic import Heard
from gripperd.drivers.transcript import Spoken, Transcript
from gripperd.errors import NotFound
from gripperd.link.buses import BusFigures, ReadBuses, ReadTraffic
from gripperd.link.client import Client

LOOK_EVERY = 0.1
"""Pause between two looks at what control has kept. [s]"""


async def listen(
    settings: Settings, gripper: str | None, address: str | None
) -> AsyncGenerator[tuple[Spoken, Spoken]]:
    """Request and reply of every exchange from now on.

    Parameters
    ----------
    settings
        Of the daemon.
    gripper, address
        Whose bus, or which; without either, that of the first gripper.

    Raises
    ------
    NotFound
        The daemon has no such bus.
    LinkError
        It does not run, or ended.
    """
    control = Client(control_socket(settings), "the control process")
    try:
        bus = await _chosen(control, gripper, address)
        transcript = _transcript(settings, bus)
        async for heard in _traffic(control, bus.grippers[0]):
            yield transcript.read(heard)
    finally:
        await control.close()


async def _chosen(
    control: Client, gripper: str | None, address: str | None
) -> BusFigures:
    buses = await control.ask(ReadBuses(), list[BusFigures])
    if gripper is None and address is None:
        return buses[0]
    for bus in buses:
        if gripper in bus.grippers or address == bus.name:
            return bus
    known = ", ".join(f"{bus.name} of {' and '.join(bus.grippers)}" for bus in buses)
    message = f"the daemon has no bus of {gripper or address!r}; it has {known}"
    raise NotFound(message)


async def _traffic(control: Client, gripper: str) -> AsyncIterator[Heard]:
    kept = await control.ask(ReadTraffic(gripper), list[Heard])
    last = kept[-1].number if kept else 0
    while True:
        for heard in await control.ask(ReadTraffic(gripper, last), list[Heard]):
            if last and heard.number > last + 1:
                lost = heard.number - last - 1
                typer.echo(f"warning: {lost} exchanges came too fast", err=True)
            last = heard.number
            yield heard
        await asyncio.sleep(LOOK_EVERY)


def _transcript(settings: Settings, bus: BusFigures) -> Transcript:
    grippers = [settings.grippers[name] for name in bus.grippers]
    spoken = grippers[0].bus
    if isinstance(spoken, BenchBus):
        spoken = TcpAddress(host=settings.bench.host, port=settings.bench.port)
    fitted = (each for gripper in grippers for each in (gripper.output, gripper.input))
    return Transcript(spoken, [wiring for wiring in fitted if wiring is not None])
