"""The settings file, with the models and profiles it names."""

# ruff: noqa: N815  (names carry units, and units have capitals)

import os
import tempfile
from collections.abc import Iterator, Mapping
from contextlib import suppress
from pathlib import Path
from typing import Annotated

from pydantic import Field, PlainValidator, ValidationInfo, field_validator

from gripperd.config.document import read_document
from gripperd.config.interlocks import (
    InterlocksSection,
    check_bench_contacts,
    check_contacts,
)
from gripperd.config.location import shipped
from gripperd.config.model import ModelFile, load_model
from gripperd.config.monitors import MonitorsSection
from gripperd.config.profile import load_profiles
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
from gripperd.config.validation import validated
from gripperd.config.wiring import (
    BENCH,
    Address,
    BusName,
    HostPort,
    InputSection,
    OutputSection,
    TcpSection,
    check_bench_input,
    check_bench_output,
    check_driven,
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


def _named(name: object, asked: ValidationInfo) -> Path:
    """Path of a file or folder that the settings name, relative to their own."""
    folder = Path(asked.context or "")
    # The name may be too long, or lead where this user may not look.
    with suppress(OSError):
        if isinstance(name, str) and (folder / name).exists():
            return folder / name
    message = f"{shown(name)} cannot be found from {folder}"
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
    rate_Hz: float = Field(default=100.0, ge=1, le=500)

    @field_validator("output")
    @classmethod
    def _is_the_benchs(
        cls, output: OutputSection, read: ValidationInfo
    ) -> OutputSection:
        if read.data.get("bus") == BENCH:
            check_bench_output(output)
        return output

    @field_validator("input")
    @classmethod
    def _are_the_benchs(
        cls, inputs: InputSection | None, read: ValidationInfo
    ) -> InputSection | None:
        if read.data.get("bus") == BENCH:
            check_bench_input(inputs)
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
            check_driven(model.chain().regulator, output.module)
        return model

    def settings(self, name: str) -> GripperSettings:
        """The same in SI."""
        tcp = self.bus.address if isinstance(self.bus, TcpSection) else None
        return GripperSettings(
            name=name,
            bus=tcp or BenchBus(),
            output=self.output.wiring,
            input=self.interlocks.with_contacts(
                self.input.wiring if self.input else None
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
    grippers: dict[Name, GripperSection] = Field(min_length=1)
    profiles: Annotated[Mapping[str, Profile], PlainValidator(_profiles)]
    bench: BenchSection = BenchSection()

    @field_validator("grippers")
    @classmethod
    def _share_nothing(
        cls, grippers: dict[str, GripperSection]
    ) -> dict[str, GripperSection]:
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
    if isinstance(bus, TcpSection):
        where = str(bus.address)
        yield f"the bus at {where}", f"asked with timeout_ms {bus.timeout_ms:g}"
    else:
        where = bus
        yield "the bench", f"the rig of {name}"
    unit = f"unit {output.unit} on {where}"
    yield unit, output.module.name
    yield f"channel {output.channel} of {unit}", f"the valve of {name}"
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
    section = validated(SettingsSection, read_document(source), folder)
    bench = section.bench
    return Settings(
        http=Http(host=section.http.host, port=section.http.port),
        runtime_dir=_runtime_dir(section.runtime_dir, folder, environ),
        state_dir=_state_dir(section.state_dir, folder, environ),
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
    )


def _runtime_dir(named: str | None, folder: Path, environ: Mapping[str, str]) -> Path:
    if named is not None:
        return folder / named
    given = _first(environ, "RUNTIME_DIRECTORY")
    return Path(given or Path(tempfile.gettempdir(), f"gripperd-{os.getuid()}"))


def _state_dir(named: str | None, folder: Path, environ: Mapping[str, str]) -> Path:
    if named is not None:
        return folder / named
    home = environ.get("XDG_STATE_HOME") or Path("~/.local/state").expanduser()
    return Path(_first(environ, "STATE_DIRECTORY") or Path(home, "gripperd"))


def _first(environ: Mapping[str, str], variable: str) -> str:
    """The unit's own directory: systemd lists several with colons."""
    return environ.get(variable, "").partition(":")[0]
