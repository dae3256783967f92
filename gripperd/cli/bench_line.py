"""What `gripperd bench` is told about its line: modules, place, pace and faults."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from enum import StrEnum
from pathlib import Path

from gripperd.bench.modbus_speaker import RtuSpeaker
from gripperd.bench.modules import Fitted, Modules
from gripperd.bench.object import BenchObject
from gripperd.bench.pace import Pace
from gripperd.bench.speaker import Speaker
from gripperd.bench.text_speaker import DconSpeaker, ItvSpeaker
from gripperd.bench.wire_faults import WireFault, WireFaultKind
from gripperd.config.complaint import did_you_mean
from gripperd.config.module_library import ModuleLibrary, load_module
from gripperd.config.wording import shown
from gripperd.control.profile import Profile
from gripperd.errors import InputError
from gripperd.protocol.modules import InputModule, OutputModule
from gripperd.protocol.rtu import silence
from gripperd.units import MILLI

KEYS = ("code", "delay_ms", "unit", "times")
"""Numbers that a fault can have."""


class Grammar(StrEnum):
    """What is spoken on a serial line."""

    RTU = "rtu"
    DCON = "dcon"
    ITV = "itv"


@dataclass(frozen=True, slots=True, kw_only=True)
class Port:
    """A serial line of the bench."""

    path: Path
    grammar: Grammar
    pace: Pace
    checksum: bool = False

    def speaker(self, modules: Modules) -> Speaker:
        """What answers there."""
        match self.grammar:
            case Grammar.RTU:
                return RtuSpeaker(modules)
            case Grammar.DCON:
                return DconSpeaker(modules, checksum=self.checksum)
            case Grammar.ITV:
                return ItvSpeaker(modules)


@dataclass(frozen=True, slots=True, kw_only=True)
class BenchLine:
    """One line of the bench."""

    fitted: Sequence[Fitted] = ()
    """Its modules; without any, those of the gripper in the settings."""
    tcp: tuple[str, int] | None = None
    """Without it, and without `port`, the address in the settings."""
    port: Port | None = None
    object: str | None = None
    """Profile of what lies between the jaws at the start."""
    faults: Sequence[WireFault] = ()
    chance: float = 0.0


def port(
    places: dict[Grammar, Path | None], baud: int, *, parity: bool, checksum: bool
) -> Port | None:
    """The serial line that is asked for, if one is.

    Raises
    ------
    InputError
        More than one, or an option that does not fit.
    """
    asked = [(grammar, path) for grammar, path in places.items() if path is not None]
    if len(asked) > 1:
        options = " and ".join(f"--{grammar}" for grammar, _ in asked)
        message = f"{options} are given; a bench has one line"
        raise InputError(message, key="--" + asked[1][0])
    if checksum and places[Grammar.DCON] is None:
        message = "--checksum is for --dcon"
        raise InputError(message, key="--checksum")
    if not asked:
        return None
    ((grammar, path),) = asked
    pace = Pace(baud=baud, parity=parity)
    if grammar is Grammar.RTU:
        pace = replace(pace, silence=silence(baud))
    return Port(path=path, grammar=grammar, pace=pace, checksum=checksum)


def fitted(texts: Sequence[str]) -> Sequence[Fitted]:
    """Modules, each as ``NAME[:UNIT[:RANGE]]``; units count from 1 unless given.

    Raises
    ------
    InputError
        There is no such module, or no such unit.
    ConfigError
        Its description is unusable.
    """
    return tuple(_fitted(text, place) for place, text in enumerate(texts, 1))


def _fitted(text: str, place: int) -> Fitted:
    name, *more = text.split(":", 2)
    unit = more[0] if more else str(place)
    if not unit.isdecimal() or not 0 < int(unit) <= 0xFF:
        message = f"--module {shown(text)}: {shown(unit)} is no unit, 1 to 255 is"
        raise InputError(message, key="--module")
    return Fitted(_module(name), int(unit), more[1] if len(more) > 1 else None)


def _module(name: str) -> OutputModule | InputModule:
    if name.endswith(".yaml"):
        return load_module(Path(name))
    known = {module.name: module for module in ModuleLibrary().all()}
    if name not in known:
        message = f"--module {shown(name)} is not described; "
        raise InputError(message + did_you_mean(name, known), key="--module")
    return known[name]


def wire_fault(text: str) -> WireFault:
    """A fault, as ``KIND[:KEY=VALUE[,KEY=VALUE]]``.

    >>> wire_fault("late:delay_ms=500,times=2").delay
    0.5

    Raises
    ------
    InputError
        It is none.
    """
    kind, _, values = text.partition(":")
    if kind not in set(WireFaultKind):
        meant = did_you_mean(kind, list(WireFaultKind))
        message = f"--fault {shown(kind)} is no fault; {meant}"
        raise InputError(message, key="--fault")
    numbers: dict[str, int] = {}
    for pair in filter(None, values.split(",")):
        key, _, value = pair.partition("=")
        if key not in KEYS or not value.isdecimal():
            message = f"--fault {shown(text)}: {shown(pair)} is not KEY=NUMBER;"
            raise InputError(f"{message} keys are {', '.join(KEYS)}", key="--fault")
        numbers[key] = int(value)
    delay = numbers.pop("delay_ms", 1000) * MILLI
    return WireFault(kind=WireFaultKind(kind), delay=delay, **numbers)


def lying(name: str, profiles: Mapping[str, Profile]) -> BenchObject:
    """Make the object that a profile describes.

    Raises
    ------
    InputError
        There is no profile of that name.
    """
    profile = profiles.get(name)
    if profile is None:
        message = f"--object {name!r} is not a profile; {did_you_mean(name, profiles)}"
        raise InputError(message, key="--object")
    return BenchObject(
        diameter=profile.diameter,
        stiffness=profile.stiffness,
        mass=profile.mass,
        friction=profile.pad_friction,
        damage_force=profile.damage_force,
    )
