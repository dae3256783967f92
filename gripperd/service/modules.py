"""The modules of a gripper as a document."""

from typing import Self

from pydantic import Field

from gripperd.drivers.facts import ModuleFacts, OutputFacts, RigFacts, WatchdogState
from gripperd.protocol.modules import Evidence, ModuleDialect
from gripperd.service.rendering import Document, known


class ModuleDocument(Document):
    """What is known of a module."""

    module: str
    title: str = Field(description="Maker and type.")
    dialect: ModuleDialect
    evidence: Evidence = Field(description="Where its description was taken from.")
    unverified: tuple[str, ...] = Field(description="What nobody has confirmed.")
    range: str
    range_verified: bool = Field(description="The module itself has confirmed it.")

    @classmethod
    def of(cls, facts: ModuleFacts) -> Self:
        """Describe a module for the outside."""
        return cls(
            module=facts.module,
            title=facts.title,
            dialect=facts.dialect,
            evidence=facts.evidence,
            unverified=facts.unverified,
            range=facts.range,
            range_verified=facts.range_verified,
        )


class OutputDocument(ModuleDocument):
    """What is known of the module that drives the valve."""

    watchdog: WatchdogState = Field(
        description="`none`: it has none; `unarmed`: nobody asked; `arming`: it is"
        " armed once the module is reached; `armed`."
    )
    watchdog_timeout_s: float | None
    watchdog_acts: str | None = Field(description="What happens on time-out.")
    safe_mA: float | None = Field(  # noqa: N815  (a unit has capitals)
        description="Output on time-out; null where it is not known."
    )
    when_silent: str = Field(
        description="What becomes of the current when the daemon falls silent."
    )
    power_on: str = Field(description="What the outputs do after power has come.")
    read_back_measured: bool = Field(
        description="False where the set-point alone comes back."
    )

    @classmethod
    def of_output(cls, facts: OutputFacts) -> Self:
        """Describe an output module for the outside."""
        return cls(
            **dict(ModuleDocument.of(facts)),
            watchdog=facts.watchdog,
            watchdog_timeout_s=known("s", facts.watchdog_timeout),
            watchdog_acts=facts.watchdog_acts,
            safe_mA=known("mA", facts.safe_current),
            when_silent=facts.when_silent,
            power_on=facts.power_on,
            read_back_measured=facts.read_back_measured,
        )


class RigDocument(Document):
    """Both modules of one gripper."""

    output: OutputDocument
    input: ModuleDocument | None = Field(description="Null where no sensor is fitted.")


def rig_document(facts: RigFacts) -> RigDocument:
    """Describe the modules of a gripper for the outside."""
    return RigDocument(
        output=OutputDocument.of_output(facts.output),
        input=ModuleDocument.of(facts.input) if facts.input else None,
    )
