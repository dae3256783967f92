"""Section of the settings file about one gripper."""

# ruff: noqa: N815  (names carry units, and units have capitals)

from collections.abc import Iterator
from typing import Annotated

from pydantic import Field, PlainValidator, ValidationInfo, field_validator

from gripperd.config.bus_section import BENCH, BusName, dialect_on
from gripperd.config.interlocks import (
    InterlocksSection,
    check_bench_contacts,
    check_contacts,
)
from gripperd.config.model import ModelFile, load_model
from gripperd.config.monitors import MonitorsSection
from gripperd.config.range_check import check_driven, check_set_range
from gripperd.config.section import Section
from gripperd.config.settings import BenchBus, GripperSettings
from gripperd.config.surroundings import path_of
from gripperd.config.watchdog_check import check_kept, check_watchdog
from gripperd.config.wiring import (
    InputSection,
    OutputSection,
    check_bench_input,
    check_bench_output,
)
from gripperd.control.budget import WORST_LEAK, FailMode


def _model(name: object, asked: ValidationInfo) -> ModelFile:
    model = load_model(path_of(name, asked))
    model.chain()
    return model


class GripperSection(Section):
    """One gripper."""

    bus: BusName
    output: OutputSection
    input: InputSection | None = Field(default=None, validate_default=True)
    model: Annotated[ModelFile, PlainValidator(_model)]
    fail_mode: Annotated[FailMode, Field(strict=False)]
    worst_leak_per_s: float = Field(default=WORST_LEAK, ge=0, le=100)
    interlocks: InterlocksSection = InterlocksSection()
    monitors: MonitorsSection = MonitorsSection()
    auto_enable: bool = False
    rate_Hz: float = Field(default=100.0, ge=1, le=500, validate_default=True)

    @field_validator("output")
    @classmethod
    def _fits_the_bus(
        cls, output: OutputSection, read: ValidationInfo
    ) -> OutputSection:
        bus = read.data.get("bus")
        if bus is not None:
            wiring = output.wiring(dialect_on(bus, output.module))
            check_watchdog(wiring)
            check_set_range(wiring)
        if bus == BENCH:
            check_bench_output(output)
        return output

    @field_validator("input")
    @classmethod
    def _are_on_the_bus(
        cls, inputs: InputSection | None, read: ValidationInfo
    ) -> InputSection | None:
        bus = read.data.get("bus")
        if bus == BENCH:
            check_bench_input(inputs)
        if bus is not None and inputs is not None:
            check_set_range(inputs.wiring(dialect_on(bus, inputs.module)))
        return inputs

    @field_validator("interlocks")
    @classmethod
    def _have_channels(
        cls, interlocks: InterlocksSection, read: ValidationInfo
    ) -> InterlocksSection:
        if "input" in read.data:
            check_contacts(interlocks, read.data["input"])
        if read.data.get("bus") == BENCH:
            check_bench_contacts(interlocks)
        return interlocks

    @field_validator("model")
    @classmethod
    def _can_be_driven(cls, model: ModelFile, read: ValidationInfo) -> ModelFile:
        output = read.data.get("output")
        if output is not None:
            module = output.module
            check_driven(model.chain().regulator, module, module.range(output.range))
        return model

    @field_validator("rate_Hz")
    @classmethod
    def _keeps_the_watchdog(cls, rate: float, read: ValidationInfo) -> float:
        output = read.data.get("output")
        if output is not None and output.watchdog is not None:
            check_kept(output.watchdog.settings, rate)
        return rate

    def settings(self, name: str) -> GripperSettings:
        """The same in SI."""
        bus, inputs = self.bus, self.input
        return GripperSettings(
            name=name,
            bus=BenchBus() if bus == BENCH else bus.address,
            output=self.output.wiring(dialect_on(bus, self.output.module)),
            input=self.interlocks.with_contacts(
                inputs.wiring(dialect_on(bus, inputs.module)) if inputs else None
            ),
            model=self.model,
            chain=self.model.chain(),
            fail_mode=self.fail_mode,
            worst_leak=self.worst_leak_per_s,
            policies={**self.monitors.policies, **self.interlocks.policies},
            auto_enable=self.auto_enable,
            rate=self.rate_Hz,
        )

    def uses(self, name: str) -> Iterator[tuple[str, str]]:
        """What a gripper of that name claims on its bus, and what for."""
        bus, output = self.bus, self.output
        if bus == BENCH:
            where: str = bus
            yield "the bench", f"the rig of {name}"
        else:
            where = str(bus.address)
        # A device without an address has its line for itself.
        device = f"unit {output.unit}" if output.unit else "the device"
        unit = f"{device} on {where}"
        yield unit, output.module.name
        yield f"channel {output.channel or 0} of {unit}", f"the valve of {name}"
        if self.input:
            yield f"unit {self.input.unit} on {where}", self.input.module.name
