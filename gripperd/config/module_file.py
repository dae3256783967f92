"""Descriptions of analog modules as files: the schema."""

# ruff: noqa: N815  (names carry units, and units have capitals)

from typing import Annotated, Literal

from pydantic import Field

from gripperd.config.module_parts import (
    NameSection,
    RangeSection,
    ReadBackSection,
    RegistersSection,
    RequiredSection,
    Sentence,
    StatusSection,
    ValuesSection,
    VectorSection,
)
from gripperd.config.module_watchdogs import (
    PhraseSection,
    PhraseWatchdogSection,
    RangePhraseSection,
    RegisterWatchdogSection,
)
from gripperd.config.section import Milliamperes, Name, Section, numbers
from gripperd.protocol.encoding import Range
from gripperd.protocol.modules import (
    Beyond,
    Evidence,
    InputModule,
    InputPhrases,
    ModuleDialect,
    OutputMap,
    OutputModule,
    OutputPhrases,
    RegisterMap,
)


class ModbusInputSection(Section):
    """Inputs in registers."""

    values: ValuesSection
    range_code: RegistersSection | None = None
    required: RequiredSection | None = None
    status: StatusSection | None = None
    type_name: NameSection | None = None
    version: RegistersSection | None = None

    @property
    def map(self) -> RegisterMap:
        """The same for the driver."""
        return RegisterMap(
            values=self.values.registers,
            encoding=self.values.encoding,
            range_code=self.range_code.registers if self.range_code else None,
            required=self.required.required if self.required else None,
            status=self.status.status if self.status else None,
            type_name=self.type_name.type_name if self.type_name else None,
            version=self.version.registers if self.version else None,
        )


class ModbusOutputSection(ModbusInputSection):
    """Outputs in registers."""

    read_back: ReadBackSection | None = None
    """Without it, the registers that are written."""
    safe: RegistersSection | None = None
    watchdog: RegisterWatchdogSection | None = None
    beyond_range: Annotated[Beyond, Field(strict=False)] = Beyond.REFUSED

    @property
    def map(self) -> OutputMap:
        """The same for the driver."""
        plain = super().map
        back = self.read_back
        return OutputMap(
            values=plain.values,
            encoding=plain.encoding,
            range_code=plain.range_code,
            required=plain.required,
            status=plain.status,
            type_name=plain.type_name,
            version=plain.version,
            read_back=back.registers if back else plain.values,
            echo=back.echo if back else True,
            safe=self.safe.registers if self.safe else None,
            watchdog=self.watchdog.watchdog if self.watchdog else None,
            beyond_range=self.beyond_range,
        )


class AsciiReadBackSection(PhraseSection):
    """The line that reads a current back."""

    echo: bool = True


class AsciiSection(Section):
    """What every module that speaks lines of text has."""

    range_code: RangePhraseSection | None = None
    type_name: PhraseSection | None = None


class AsciiOutputSection(AsciiSection):
    """Outputs in lines of text."""

    write: PhraseSection
    read_back: AsciiReadBackSection
    safe: PhraseSection | None = None
    watchdog: PhraseWatchdogSection | None = None
    beyond_range: Annotated[Beyond, Field(strict=False)] = Beyond.CLAMPED_AND_TOLD

    @property
    def phrases(self) -> OutputPhrases:
        """The same for the driver."""
        return OutputPhrases(
            write=self.write.phrase,
            read_back=self.read_back.phrase,
            echo=self.read_back.echo,
            safe=self.safe.phrase if self.safe else None,
            watchdog=self.watchdog.watchdog if self.watchdog else None,
            beyond_range=self.beyond_range,
            range_code=self.range_code.range_phrase if self.range_code else None,
            type_name=self.type_name.phrase if self.type_name else None,
        )


class AsciiInputSection(AsciiSection):
    """Inputs in lines of text."""

    read: PhraseSection

    @property
    def phrases(self) -> InputPhrases:
        """The same for the driver."""
        return InputPhrases(
            read=self.read.phrase,
            range_code=self.range_code.range_phrase if self.range_code else None,
            type_name=self.type_name.phrase if self.type_name else None,
        )


class ModuleSection(Section):
    """What every description says."""

    name: Name
    title: Sentence
    evidence: Annotated[Evidence, Field(strict=False)]
    sources: list[Sentence] = Field(min_length=1)
    unverified: list[Sentence] = Field(default_factory=list)
    notes: list[Sentence] = Field(default_factory=list)
    channels: int = Field(ge=1, le=64)
    ranges: dict[Name, RangeSection] = Field(min_length=1)
    vectors: list[VectorSection] = Field(min_length=1)

    def named_ranges(self) -> dict[str, Range]:
        """The same for the driver."""
        return {name: section.range(name) for name, section in self.ranges.items()}


class OutputSchema(ModuleSection):
    """The file of an output module."""

    kind: Literal["output"]
    power_on: Sentence
    power_on_mA: Milliamperes | None = None
    modbus: ModbusOutputSection | None = None
    dcon: AsciiOutputSection | None = None
    adam_ascii: AsciiOutputSection | None = None
    itv: bool = False

    def module(self) -> OutputModule:
        """The same for the driver."""
        spoken = {
            ModuleDialect.DCON: self.dcon,
            ModuleDialect.ADAM_ASCII: self.adam_ascii,
        }
        return OutputModule(
            name=self.name,
            title=self.title,
            evidence=self.evidence,
            sources=tuple(self.sources),
            unverified=tuple(self.unverified),
            channels=self.channels,
            ranges=self.named_ranges(),
            power_on=self.power_on,
            power_on_current=numbers(self).get("power_on"),
            modbus=self.modbus.map if self.modbus else None,
            phrases={name: said.phrases for name, said in spoken.items() if said},
            itv=self.itv,
        )


class InputSchema(ModuleSection):
    """The file of an input module."""

    kind: Literal["input"]
    modbus: ModbusInputSection | None = None
    dcon: AsciiInputSection | None = None
    adam_ascii: AsciiInputSection | None = None

    def module(self) -> InputModule:
        """The same for the driver."""
        spoken = {
            ModuleDialect.DCON: self.dcon,
            ModuleDialect.ADAM_ASCII: self.adam_ascii,
        }
        return InputModule(
            name=self.name,
            title=self.title,
            evidence=self.evidence,
            sources=tuple(self.sources),
            unverified=tuple(self.unverified),
            channels=self.channels,
            ranges=self.named_ranges(),
            modbus=self.modbus.map if self.modbus else None,
            phrases={name: said.phrases for name, said in spoken.items() if said},
        )
