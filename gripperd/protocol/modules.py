"""What a description of an analog module says: places, meanings, evidence.

The descriptions themselves are data: see :mod:`gripperd.config.module_file`.
"""

from abc import ABC, abstractmethod
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from enum import StrEnum

from gripperd.protocol.encoding import Encoding, Range, Registers
from gripperd.protocol.phrase import Phrase
from gripperd.protocol.watchdog import PhraseWatchdog, RegisterWatchdog


class Evidence(StrEnum):
    """Where a description was taken from."""

    MANUAL = "manual"
    """The maker's own text."""
    DRIVER = "driver"
    """Drivers or register maps that others published."""
    UNVERIFIED = "unverified"
    """Neither: memory, or a table that says so itself."""


class Beyond(StrEnum):
    """What an output module does with a current outside its range."""

    REFUSED = "refused"
    """It says no, and its output stays."""
    CLAMPED = "clamped"
    """It goes to the end of the range without a word."""
    CLAMPED_AND_TOLD = "clamped_and_told"
    """It goes to the end of the range, and says so."""


class Condition(StrEnum):
    """What can be wrong with a 4-20 mA loop."""

    OPEN = "open"
    UNDER = "under"
    OVER = "over"


class ModuleDialect(StrEnum):
    """What a module speaks."""

    MODBUS = "modbus"
    DCON = "dcon"
    ADAM_ASCII = "adam_ascii"
    ITV = "itv"


@dataclass(frozen=True, slots=True, kw_only=True)
class Status:
    """What a module says about its channels besides the value."""

    registers: Registers | None
    """None: it stands in the value itself."""
    words: int = 1
    """Registers a channel; bit 16 is the lowest of the second."""
    bits: Mapping[int, str] = field(default_factory=dict)
    """Meaning of each bit that is set."""
    codes: Mapping[int, str] = field(default_factory=dict)
    """Meaning of a whole value; it is looked up before the bits."""
    fail_safe: int | None = None
    """Bit that says that the communication watchdog has tripped."""
    signs: Mapping[Condition, int] = field(default_factory=dict)
    """What the whole status is in a condition."""

    def causes(self, words: Sequence[int]) -> tuple[str, ...]:
        """Everything that is wrong with a channel, for a person."""
        value = _joined(words)
        if value in self.codes:
            return (self.codes[value],)
        return tuple(said for bit, said in self.bits.items() if value >> bit & 1)

    def tripped(self, words: Sequence[int]) -> bool:
        """Whether the output is at its safe value."""
        return self.fail_safe is not None and bool(_joined(words) >> self.fail_safe & 1)


def _joined(words: Sequence[int]) -> int:
    return sum(word << 16 * place for place, word in enumerate(words))


@dataclass(frozen=True, slots=True, kw_only=True)
class Required:
    """A register that must hold one value, or the map means something else."""

    registers: Registers
    code: int
    meaning: str


@dataclass(frozen=True, slots=True)
class NameRegister:
    """A register in which a module says its type."""

    registers: Registers
    code: int


@dataclass(frozen=True, slots=True)
class RangePhrase:
    """Asks for the range of a channel.

    The answer is two hexadecimal digits of range code, and as many more as `rest`.
    """

    phrase: Phrase
    rest: str = ""
    """What follows the code on a module as it leaves the factory."""


@dataclass(frozen=True, slots=True, kw_only=True)
class RegisterMap:
    """One kind of channel, in registers."""

    values: Registers
    encoding: Encoding
    range_code: Registers | None = None
    required: Required | None = None
    status: Status | None = None
    type_name: NameRegister | None = None
    version: Registers | None = None
    """Where the firmware version stands, times 100."""


@dataclass(frozen=True, slots=True, kw_only=True)
class OutputMap(RegisterMap):
    """Outputs in registers."""

    read_back: Registers
    echo: bool = True
    """Whether the read-back is the set-point; otherwise it is measured."""
    safe: Registers | None = None
    """Current on time-out of the watchdog, encoded like the set-point."""
    watchdog: RegisterWatchdog | None = None
    beyond_range: Beyond = Beyond.REFUSED


@dataclass(frozen=True, slots=True, kw_only=True)
class OutputPhrases:
    """Outputs in lines of text; values are mA, such as ``+10.700``."""

    write: Phrase
    read_back: Phrase
    echo: bool = True
    safe: Phrase | None = None
    """Asks for the current on time-out; lines cannot set it without driving it."""
    watchdog: PhraseWatchdog | None = None
    beyond_range: Beyond = Beyond.CLAMPED_AND_TOLD
    range_code: RangePhrase | None = None
    type_name: Phrase | None = None
    """Asks for the type; the whole reply is what this module says."""


@dataclass(frozen=True, slots=True, kw_only=True)
class InputPhrases:
    """Inputs in lines of text; all channels come in one reply, in mA."""

    read: Phrase
    range_code: RangePhrase | None = None
    type_name: Phrase | None = None


@dataclass(frozen=True, slots=True, kw_only=True)
class Module(ABC):
    """What every description says."""

    name: str
    title: str
    """Maker and type, as on the label."""
    evidence: Evidence
    sources: tuple[str, ...]
    unverified: tuple[str, ...]
    """What in particular nobody has confirmed."""
    channels: int
    ranges: Mapping[str, Range]
    """By name; the first is what is meant when nothing else is said."""

    def range(self, name: str | None = None) -> Range:
        """Range of that name, or the first."""
        return self.ranges[name] if name else next(iter(self.ranges.values()))

    @property
    @abstractmethod
    def dialects(self) -> tuple[ModuleDialect, ...]:
        """What it can be asked in."""

    @property
    def doubts(self) -> tuple[str, ...]:
        """What to warn of when the module is used."""
        lines = [f"{self.name}: not confirmed: {said}" for said in self.unverified]
        if self.evidence is Evidence.UNVERIFIED:
            lines.insert(0, f"{self.name}: nobody has verified this description")
        return tuple(lines)


@dataclass(frozen=True, slots=True, kw_only=True)
class OutputModule(Module):
    """A module that drives 4-20 mA loops, or a regulator that needs none."""

    power_on: str
    """What its outputs do after power has come, for a person."""
    power_on_current: float | None = None
    """The same as a number, where it is known. [A]"""
    modbus: OutputMap | None = None
    phrases: Mapping[ModuleDialect, OutputPhrases] = field(default_factory=dict)
    itv: bool = False
    """Whether it is an SMC regulator on a serial line; counts are 0 to 1023."""

    @property
    def dialects(self) -> tuple[ModuleDialect, ...]:
        """What it can be asked in."""
        modbus = (ModuleDialect.MODBUS,) if self.modbus else ()
        itv = (ModuleDialect.ITV,) if self.itv else ()
        return (*modbus, *self.phrases, *itv)

    def asked_in(self, dialect: ModuleDialect) -> OutputMap | OutputPhrases | None:
        """What is said to it in a dialect; None where no description is needed."""
        if dialect is ModuleDialect.MODBUS:
            return self.modbus
        return self.phrases.get(dialect)


@dataclass(frozen=True, slots=True, kw_only=True)
class InputModule(Module):
    """A module that measures 4-20 mA loops."""

    modbus: RegisterMap | None = None
    phrases: Mapping[ModuleDialect, InputPhrases] = field(default_factory=dict)

    @property
    def dialects(self) -> tuple[ModuleDialect, ...]:
        """What it can be asked in."""
        modbus = (ModuleDialect.MODBUS,) if self.modbus else ()
        return (*modbus, *self.phrases)
