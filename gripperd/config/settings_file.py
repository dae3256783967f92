"""The settings file, with the models and profiles it names."""

import os
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Annotated

from pydantic import Field, PlainValidator, ValidationInfo, field_validator

from gripperd.config.bus_section import BENCH, Address, HostPort
from gripperd.config.bus_sharing import check_one_way
from gripperd.config.directories import runtime_dir, state_dir
from gripperd.config.document import Document, read_document
from gripperd.config.gripper_section import GripperSection
from gripperd.config.location import shipped
from gripperd.config.module_library import ModuleLibrary
from gripperd.config.profile import load_profiles
from gripperd.config.section import Name, Section
from gripperd.config.settings import (
    KEYLESS,
    BenchSettings,
    Http,
    Settings,
    is_loopback,
)
from gripperd.config.surroundings import Surroundings, library, path_of
from gripperd.config.validation import validated
from gripperd.config.wording import shown
from gripperd.control.profile import Profile


def _profiles(name: object, asked: ValidationInfo) -> Mapping[str, Profile]:
    return load_profiles(path_of(name, asked))


def _modules(name: object, asked: ValidationInfo) -> Path:
    if not (found := path_of(name, asked)).is_dir():
        message = f"{shown(name)} is not a folder"
        raise ValueError(message)
    library(asked).check_own()
    return found


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
            for thing, use in gripper.uses(name):
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
        known: dict[str, GripperSection] = {}
        for gripper in grippers.values():
            model = gripper.model
            first = known.setdefault(model.name, gripper).model
            if first != model:
                message = (
                    f"{first.source} and {model.source} differ, both named {model.name}"
                )
                raise ValueError(message)
        return grippers


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
    assert isinstance(document.value, dict)
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
        content=document.value,
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
