"""The settings file, with the models and profiles it names."""

# ruff: noqa: N815  (names carry units, and units have capitals)

import os
from collections.abc import Iterator, Mapping
from contextlib import suppress
from pathlib import Path
from typing import Annotated

from pydantic import Field, PlainValidator, ValidationInfo, field_validator

from gripperd.config.bus_section import (
    BENCH,
    Address,
    BusName,
    HostPort,
    dialect_on,
)
from gripperd.config.bus_sharing import check_one_way
from gripperd.config.directories import runtime_dir, state_dir
from gripperd.config.document import Document, read_document
from gripperd.config.interlocks import (
    InterlocksSection,
    check_bench_contacts,
    check_contacts,
)
from gripperd.config.location import shipped
from gripperd.config.model import ModelFile, load_model
from gripperd.config.module_library import ModuleLibrary
from gripperd.config.monitors import MonitorsSection
from gripperd.config.profile import load_profiles
from gripperd.config.range_check import check_driven, check_set_range
from gripperd.config.section import Name, Section
from gripperd.config.settings import (
    KEYLESS,
    BenchBus,
    BenchSettings,
    GripperSettings,
    Http,
    Settings,
    is_loopback,
)
from gripperd.config.surroundings import Surroundings, folder_of, library
from gripperd.config.validation import validated
from gripperd.config.watchdog_check import check_kept, check_watchdog
from gripperd.config.wiring import (
    InputSection,
    OutputSection,
    check_bench_input,
    check_bench_output,
)
from gripperd.config.wording import shown
from gripperd.control.budget import WORST_LEAK, FailMode
from gripperd.control.profile import Profile


def _model(name: object, asked: ValidationInfo) -> ModelFile:
    model = load_model(_named(name, asked))
    model.chain()
    return model


def _profiles(name: object, asked: ValidationInfo) -> Mapping[str, Profile]:
    return load_profiles(_named(name, asked))


def _modules(name: object, asked: ValidationInfo) -> Path:
    if not (found := _named(name, asked)).is_dir():
        message = f"{shown(name)} is not a folder"
        raise ValueError(message)
    library(asked).check_own()
    return found


def _named(name: object, asked: ValidationInfo) -> Path:
    """Path of a file or folder that the settings name, relative to their own."""
    here = folder_of(asked)
    # The name may be too long, or lead where this user may not look.
    with suppress(OSError):
        if isinstance(name, str) and (here / name).exists():
            return here / name
    message = f"{shown(name)} cannot be found from {here}"
    raise ValueError(message)


class HttpSection(Section):
    """Where the service listens."""

    host: str = Field(default="127.0.0.1", min_length=1, max_length=253)
    port: int = Field(default=8765, ge=0, le=65535)

    @field_validator("host")
    @classmethod
    def _reaches_nobody_else(cls, host: str) -> str:
        if not is_loopback(host):
            message = f"{shown(host)} is not a loopback address; {KEYLESS}"
            raise ValueError(message)
        return host


class BenchSection(Section):
    """The simulated rig."""

    tcp: HostPort = Address("127.0.0.1", 15020)
    seed: int = Field(default=1, ge=0, le=2**32 - 1)
    noise_percent: float = Field(default=0.05, ge=0, le=10)


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
            policies=self.monitors.policies,
            auto_enable=self.auto_enable,
            rate=self.rate_Hz,
        )


class SettingsSection(Section):
    """The whole file."""

    http: HttpSection = HttpSection()
    runtime_dir: str | None = Field(default=None, min_length=1)
    state_dir: str | None = Field(default=None, min_length=1)
    modules: Annotated[Path | None, PlainValidator(_modules)] = None
    grippers: dict[Name, GripperSection] = Field(min_length=1)
    profiles: Annotated[Mapping[str, Profile], PlainValidator(_profiles)]
    bench: BenchSection = BenchSection()

    @field_validator("grippers")
    @classmethod
    def _share_nothing(
        cls, grippers: dict[str, GripperSection]
    ) -> dict[str, GripperSection]:
        check_one_way({name: gripper.bus for name, gripper in grippers.items()})
        owner: dict[str, str] = {}
        for name, gripper in grippers.items():
            for thing, use in _uses(name, gripper):
                if owner.setdefault(thing, use) != use:
                    message = f"{thing} is both {owner[thing]} and {use}"
                    raise ValueError(message)
        return grippers

    @field_validator("grippers")
    @classmethod
    def _tell_models_apart(
        cls, grippers: dict[str, GripperSection]
    ) -> dict[str, GripperSection]:
        """Versions are kept by the name of their model."""
        known: dict[str, ModelFile] = {}
        for gripper in grippers.values():
            model = gripper.model
            if known.setdefault(model.name, model) != model:
                first = known[model.name].source
                message = f"{first} and {model.source} differ, both named {model.name}"
                raise ValueError(message)
        return grippers


def _uses(name: str, gripper: GripperSection) -> Iterator[tuple[str, str]]:
    """What a gripper claims on its bus, and what for."""
    bus, output = gripper.bus, gripper.output
    if bus == BENCH:
        where: str = bus
        yield "the bench", f"the rig of {name}"
    else:
        where = str(bus.address)
    # A device without an address has its line for itself.
    unit = f"unit {output.unit} on {where}" if output.unit else f"the device on {where}"
    yield unit, output.module.name
    yield f"channel {output.channel or 0} of {unit}", f"the valve of {name}"
    if gripper.input:
        yield f"unit {gripper.input.unit} on {where}", gripper.input.module.name


def load_settings(
    path: Path | None = None, environ: Mapping[str, str] = os.environ
) -> Settings:
    """Read the settings, and every model and profile they name.

    Parameters
    ----------
    path
        The file; None takes what ``GRIPPERD_CONFIG`` names, or else the shipped bench.
    environ
        The environment: ``GRIPPERD_CONFIG``; ``RUNTIME_DIRECTORY`` and
        ``STATE_DIRECTORY`` as systemd sets them; ``XDG_STATE_HOME``.

    Raises
    ------
    ConfigError
        With everything that is wrong with any of the files.
    """
    named = environ.get("GRIPPERD_CONFIG")
    source = path or (Path(named) if named else shipped("gripperd.yaml"))
    folder = source.parent
    document = read_document(source)
    around = Surroundings(folder, ModuleLibrary(_own_modules(document, folder)))
    section = validated(SettingsSection, document, around)
    bench = section.bench
    return Settings(
        http=Http(host=section.http.host, port=section.http.port),
        runtime_dir=runtime_dir(section.runtime_dir, folder, environ),
        state_dir=state_dir(section.state_dir, folder, environ),
        grippers={
            name: gripper.settings(name) for name, gripper in section.grippers.items()
        },
        profiles=section.profiles,
        bench=BenchSettings(
            host=bench.tcp.host,
            port=bench.tcp.port,
            seed=bench.seed,
            noise=bench.noise_percent / 100,
        ),
        source=source,
        warnings=tuple(_doubts(section)),
    )


def _own_modules(document: Document, folder: Path) -> Path | None:
    """Folder of descriptions that the file names, known before its sections are read.

    What is wrong with it is said where the key is validated.
    """
    named = document.value.get("modules") if isinstance(document.value, dict) else None
    return folder / named if isinstance(named, str) else None


def _doubts(section: SettingsSection) -> Iterator[str]:
    for name, gripper in section.grippers.items():
        if gripper.bus != BENCH:
            yield from (f"{name}: {said}" for said in gripper.bus.warnings)
