"""Parts of a module description: lines of text, and watchdogs."""

# ruff: noqa: N815  (names carry units, and units have capitals)

from typing import Annotated, TypeAlias

from pydantic import (
    AfterValidator,
    Field,
    field_validator,
)

from gripperd.config.module_parts import Sentence, TableName, Word
from gripperd.config.section import Milliamperes, Section, numbers
from gripperd.config.wording import shown
from gripperd.protocol.modbus import Table
from gripperd.protocol.modules import RangePhrase
from gripperd.protocol.phrase import ASK, PLACES, REPLY, Phrase
from gripperd.protocol.watchdog import PhraseWatchdog, RegisterWatchdog, Setting


def _template(text: str) -> str:
    if not text.isascii() or not text.isprintable():
        message = f"{shown(text)} is not printable ASCII"
        raise ValueError(message)
    if text.count("{") != text.count("}") or not Phrase(text).places <= PLACES:
        places = ", ".join(f"{{{place}}}" for place in sorted(PLACES))
        message = f"{shown(text)} has a place that is not one of {places}"
        raise ValueError(message)
    return text


def _asks(text: str) -> str:
    if not ASK.fullmatch(text):
        message = f"{shown(text)} does not begin with one of # $ ~ % and {{unit}}"
        raise ValueError(message)
    return text


def _grants(text: str) -> str:
    if not REPLY.fullmatch(text):
        message = f'{shown(text)} begins neither with ">" nor with "!{{unit}}"'
        raise ValueError(message)
    return text


Template: TypeAlias = Annotated[
    str, Field(min_length=1, max_length=100), AfterValidator(_template)
]
Seconds: TypeAlias = Annotated[float, Field(gt=0, le=86_400)]


class SettingSection(Section):
    """A register and a value."""

    table: TableName = Table.HOLDING
    address: Word
    value: Word

    @field_validator("table")
    @classmethod
    def _holds_settings(cls, table: Table) -> Table:
        if table not in {Table.COILS, Table.HOLDING}:
            message = f'"{table.name.lower()}" cannot be written; use coils or holding'
            raise ValueError(message)
        return table

    @property
    def setting(self) -> Setting:
        """The same for the driver."""
        return Setting(self.table, self.address, self.value)


class WatchdogSection(Section):
    """What every communication watchdog has."""

    step_s: Seconds
    longest_s: Seconds
    acts: Sentence
    survives_power_cycle: bool = False
    safe_current_mA: Milliamperes | None = None


class RegisterWatchdogSection(WatchdogSection):
    """A watchdog set by registers."""

    time: Word
    arm: list[SettingSection]
    armed: SettingSection | None = None
    tripped: SettingSection | None = None
    clear: SettingSection | None = None
    keep: list[SettingSection] = Field(default_factory=list)

    @property
    def watchdog(self) -> RegisterWatchdog:
        """The same for the driver."""
        return RegisterWatchdog(
            time=self.time,
            arm=tuple(each.setting for each in self.arm),
            armed=self.armed.setting if self.armed else None,
            tripped=self.tripped.setting if self.tripped else None,
            keep=tuple(each.setting for each in self.keep),
            clear=self.clear.setting if self.clear else None,
            acts=self.acts,
            survives_power_cycle=self.survives_power_cycle,
            **numbers(self),
        )


class PhraseSection(Section):
    """A line of text and its reply."""

    ask: Annotated[Template, AfterValidator(_asks)]
    reply: Annotated[Template, AfterValidator(_grants)] | None = None

    @property
    def phrase(self) -> Phrase:
        """The same for the driver."""
        return Phrase(self.ask, self.reply)


class RangePhraseSection(PhraseSection):
    """A line that asks for the range; ``{value}`` begins with its code."""

    rest: str = Field(default="", max_length=20, pattern="^[0-9A-F]*$")

    @property
    def range_phrase(self) -> RangePhrase:
        """The same for the driver."""
        return RangePhrase(self.phrase, self.rest)


class PhraseWatchdogSection(WatchdogSection):
    """A watchdog set by lines of text."""

    arm: PhraseSection
    armed: PhraseSection | None = None
    status: PhraseSection | None = None
    tripped_bits: Word = 0
    clear: PhraseSection | None = None
    keep: PhraseSection | None = None
    digits: int = Field(default=2, ge=1, le=8)
    radix: int = Field(default=16)

    @field_validator("radix")
    @classmethod
    def _is_usual(cls, radix: int) -> int:
        if radix not in {10, 16}:
            message = f"{radix} is not 10 or 16"
            raise ValueError(message)
        return radix

    @property
    def watchdog(self) -> PhraseWatchdog:
        """The same for the driver."""
        return PhraseWatchdog(
            arm=self.arm.phrase,
            armed=self.armed.phrase if self.armed else None,
            status=self.status.phrase if self.status else None,
            tripped=self.tripped_bits,
            keep=self.keep.phrase if self.keep else None,
            digits=self.digits,
            radix=self.radix,
            clear=self.clear.phrase if self.clear else None,
            acts=self.acts,
            survives_power_cycle=self.survives_power_cycle,
            **numbers(self),
        )
