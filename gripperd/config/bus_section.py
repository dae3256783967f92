"""Sections of the settings file about buses."""

import re
from dataclasses import asdict
from typing import Annotated, Literal, NamedTuple, TypeAlias

from pydantic import (
    AfterValidator,
    Discriminator,
    Field,
    PlainValidator,
    Tag,
    ValidationInfo,
    field_validator,
)

from gripperd.config.complaint import printable
from gripperd.config.section import Section, numbers
from gripperd.config.wording import shown
from gripperd.drivers.bus import Address as BusAddress
from gripperd.drivers.bus import (
    DconAddress,
    ItvAddress,
    RtuAddress,
    SerialAddress,
    TcpAddress,
)
from gripperd.protocol.modules import Module, ModuleDialect
from gripperd.units import MILLI

BENCH: Literal["bench"] = "bench"
"""Name of the bus of the simulated rig."""
ADDRESS = re.compile(r"(?:\[([0-9A-Fa-f:.]+)\]|([^\s:\[\]]+)):([0-9]{1,5})")
BAUDS = (1200, 2400, 4800, 9600, 19_200, 38_400, 57_600, 115_200)
"""What the modules described can be set to."""
NUMBERED = re.compile(r"/dev/tty(USB|ACM)[0-9]+")
"""Names given in the order in which adapters are found."""
UNDERSTOOD = {
    "rtu": (ModuleDialect.MODBUS,),
    "dcon": (ModuleDialect.DCON, ModuleDialect.ADAM_ASCII),
    "itv": (ModuleDialect.ITV,),
}
"""Dialects of modules that can be spoken with each protocol."""
ECHOING = ("rtu", "dcon")
"""Protocols on two-wire lines, where a port may hear itself."""
SUMMED = ("dcon",)
"""Protocols whose checksum can be left out."""


class Address(NamedTuple):
    """A host and a port."""

    host: str
    port: int


def _address(text: object) -> Address:
    found = ADDRESS.fullmatch(text) if isinstance(text, str) else None
    if not found or int(found[3]) > 65535:
        message = f'{shown(text)} is not "host:port" with a port of 0 to 65535'
        raise ValueError(message)
    return Address(found[1] or found[2], int(found[3]))


def _device(path: str) -> str:
    if not path.startswith("/") or not path.isprintable():
        message = f"{shown(path)} is not the path of a device, such as /dev/ttyS0"
        raise ValueError(message)
    return path


def _baud(baud: int) -> int:
    if baud not in BAUDS:
        message = f"{baud} Bd is not one of {', '.join(map(str, BAUDS))}"
        raise ValueError(message)
    return baud


HostPort: TypeAlias = Annotated[Address, PlainValidator(_address)]


class TcpSection(Section):
    """A Modbus TCP device or gateway."""

    tcp: HostPort
    timeout_ms: float = Field(default=200.0, gt=0, le=10_000)

    @property
    def address(self) -> TcpAddress:
        """The same for the driver."""
        return TcpAddress(host=self.tcp.host, port=self.tcp.port, **numbers(self))

    @property
    def dialects(self) -> tuple[ModuleDialect, ...]:
        """What modules on it may speak."""
        return (ModuleDialect.MODBUS,)

    @property
    def manner(self) -> str:
        """How it is set up, for a person."""
        return f"timeout_ms {self.timeout_ms:g}"

    @property
    def warnings(self) -> tuple[str, ...]:
        """What is doubtful about it."""
        return ()


class SerialSection(Section):
    """A serial line."""

    serial: Annotated[str, Field(min_length=1, max_length=255), AfterValidator(_device)]
    protocol: Literal["rtu", "dcon", "itv"]
    baud: Annotated[int, AfterValidator(_baud)] = 9600
    parity: Literal["N", "E", "O"] = "N"
    stop_bits: Literal[1, 2] = 1
    local_echo: bool = False
    checksum: bool = False
    timeout_ms: float = Field(default=250.0, gt=0, le=10_000)

    @field_validator("local_echo", "checksum")
    @classmethod
    def _fits(cls, wanted: bool, read: ValidationInfo) -> bool:
        fitting = ECHOING if read.field_name == "local_echo" else SUMMED
        protocol = read.data.get("protocol", fitting[0])
        if wanted and protocol not in fitting:
            message = f"is for protocol {' or '.join(fitting)}, not for {protocol}"
            raise ValueError(message)
        return wanted

    @property
    def address(self) -> BusAddress:
        """The same for the driver."""
        line = asdict(
            SerialAddress(
                port=self.serial,
                baud=self.baud,
                parity=self.parity,
                stop_bits=self.stop_bits,
                timeout=self.timeout_ms * MILLI,
            )
        )
        match self.protocol:
            case "rtu":
                return RtuAddress(**line, local_echo=self.local_echo)
            case "dcon":
                return DconAddress(
                    **line, local_echo=self.local_echo, checksum=self.checksum
                )
            case "itv":
                return ItvAddress(**line)

    @property
    def dialects(self) -> tuple[ModuleDialect, ...]:
        """What modules on it may speak."""
        return UNDERSTOOD[self.protocol]

    @property
    def manner(self) -> str:
        """How it is set up, for a person."""
        given = ((key, value) for key, value in self if key != "serial")
        return ", ".join(f"{key} {shown(value)}" for key, value in given)

    @property
    def warnings(self) -> tuple[str, ...]:
        """What is doubtful about it."""
        if not NUMBERED.fullmatch(self.serial):
            return ()
        name = printable(self.serial)
        return (
            f"{name} may be another line after a restart; name the one under"
            " /dev/serial/by-id that leads to it",
        )


BusSection: TypeAlias = TcpSection | SerialSection


def _kind(bus: object) -> str:
    if not isinstance(bus, dict):
        return "the bench"
    return "a serial bus" if "serial" in bus else "a TCP bus"


BusName: TypeAlias = Annotated[
    Annotated[Literal["bench"], Tag("the bench")]
    | Annotated[TcpSection, Tag("a TCP bus")]
    | Annotated[SerialSection, Tag("a serial bus")],
    Discriminator(_kind),
]


def dialect_on(bus: BusSection | Literal["bench"], module: Module) -> ModuleDialect:
    """Dialect in which a module is asked on a bus.

    Raises
    ------
    ValueError
        They have none in common.
    """
    understood = (ModuleDialect.MODBUS,) if bus == BENCH else bus.dialects
    for dialect in module.dialects:
        if dialect in understood:
            return dialect
    where = "the bench" if bus == BENCH else f"the bus at {bus.address}"
    message = (
        f"{module.name} speaks {' or '.join(module.dialects)}, {where} speaks"
        f" {' or '.join(understood)}"
    )
    raise ValueError(message)
