"""The simulated rig at the far end of a line that can be cut, and all that it heard."""

import asyncio
from collections.abc import AsyncIterator
from contextlib import asynccontextmanager
from enum import StrEnum
from pathlib import Path
from random import Random

from gripperd.bench import contacts
from gripperd.bench.rig import Rig
from gripperd.bench.sensors import Channel, Sensor, SensorSettings
from gripperd.config import GripperSettings, load_settings, shipped
from gripperd.drivers.bus import ModbusBus
from gripperd.protocol.modbus import WRITE_REGISTER, Table

from ..drivers.far_end import (  # noqa: TID252
    Asked,
    FarEnd,
    RtuFarEnd,
    TcpFarEnd,
    dead,
    over_rtu,
    over_tcp,
)

MICRO = 1e-6
RANGE_CODES = 0x1000
IN_MICROAMPERE = 2
"""Range code of a Waveshare input module: 0-20 mA."""
SETTINGS = load_settings(shipped("gripperd.yaml"))
GRIPPER: GripperSettings = SETTINGS.grippers["g0"]
"""As shipped: output register 0 of unit 1, in µA; inputs from 0 of unit 2, in µA."""


class Fault(StrEnum):
    """How a line is cut."""

    TCP_SILENT = "TCP, nothing answers"
    TCP_CLOSED = "TCP, every connection is closed"
    RTU_SILENT = "RTU, nothing answers"
    RTU_UNPLUGGED = "RTU, the adapter is unplugged"


class FarRig:
    """The modules of the shipped settings, in front of the simulated rig."""

    def __init__(self, far: FarEnd) -> None:
        assert GRIPPER.input is not None
        sensors = {
            name: Sensor(wiring.scale, noise=5e-4)
            for name, wiring in GRIPPER.input.sensors.items()
            if name in set(Channel)
        }
        self.rig = Rig(GRIPPER.chain, Random(1), sensors=SensorSettings(**sensors))
        self.far = far
        self.output = 0
        """What the output register holds. [µA]"""
        self._now = asyncio.get_running_loop().time
        self._start = self._now()
        far.behave = self.answer

    @property
    def heard(self) -> list[Asked]:
        """Every request that has arrived, answered or not."""
        return self.far.asked

    def cut(self) -> None:
        """From now on nothing is carried out."""
        self.far.behave = dead

    def mend(self) -> None:
        """The line is as before."""
        self.far.behave = self.answer

    def answer(self, far: FarEnd, asked: Asked) -> None:
        """Carry out a request."""
        self.rig.advance(self._now() - self._start)
        if asked.pdu[0] == WRITE_REGISTER:
            assert asked.address == 0
            self.output = asked.value
            self.rig.write_current(self.output * MICRO)
            far.reply(asked, asked.pdu)
            return
        words = b"".join(word.to_bytes(2, "big") for word in self._read(asked))
        far.reply(asked, bytes([asked.pdu[0], len(words)]) + words)

    def _read(self, asked: Asked) -> list[int]:
        if asked.pdu[0] == Table.INPUT:
            currents = *self.rig.read_inputs(), *contacts.currents(set())
            return [round(current / MICRO) for current in currents][: asked.value]
        if asked.address >= RANGE_CODES:
            return [IN_MICROAMPERE] * asked.value
        return [self.output if asked.address == 0 else 0] * asked.value


class _ClosedRig(FarRig):
    """Every connection is closed, at the latest when something is asked on it."""

    far: TcpFarEnd

    def cut(self) -> None:
        self.far.behave = lambda far, asked: self.far.hang_up()
        self.far.hang_up()


class _UnpluggedRig(FarRig):
    """The device of the port is gone."""

    far: RtuFarEnd

    def cut(self) -> None:
        self.far.unplug()

    def mend(self) -> None:
        self.far.plug()


@asynccontextmanager
async def far_rig(
    fault: Fault, folder: Path, patience: float
) -> AsyncIterator[tuple[ModbusBus, FarRig]]:
    """A bus, and the rig behind it; `patience` is the time-out. [s]."""
    if fault in {Fault.TCP_SILENT, Fault.TCP_CLOSED}:
        async with over_tcp(patience) as (bus, tcp):
            yield bus, (_ClosedRig if fault is Fault.TCP_CLOSED else FarRig)(tcp)
        return
    async with over_rtu(folder / "adapter", patience) as (bus, rtu):
        yield bus, (_UnpluggedRig if fault is Fault.RTU_UNPLUGGED else FarRig)(rtu)
