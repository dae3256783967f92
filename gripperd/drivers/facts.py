"""What is known of a gripper's modules, for a person and for `/info`."""

from collections.abc import Iterator
from dataclasses import dataclass
from enum import StrEnum

from gripperd.drivers.wiring import InputWiring, OutputWiring
from gripperd.protocol.live_zero import BROKEN_BELOW
from gripperd.protocol.modules import Evidence, ModuleDialect
from gripperd.protocol.watchdog import Watchdog
from gripperd.units import MILLI

KEEPS = "the module keeps the last current when this daemon stops"


class WatchdogState(StrEnum):
    """Whether a module acts when this daemon falls silent."""

    NONE = "none"
    """It cannot, or nothing is known of it."""
    UNARMED = "unarmed"
    """It could; nobody asked."""
    ARMING = "arming"
    """It will, once the module has been reached."""
    ARMED = "armed"


@dataclass(frozen=True, slots=True, kw_only=True)
class ModuleFacts:
    """What is known of any module."""

    module: str
    title: str
    dialect: ModuleDialect
    evidence: Evidence
    unverified: tuple[str, ...]
    range: str
    range_verified: bool
    """Whether the module itself has confirmed its range."""


@dataclass(frozen=True, slots=True, kw_only=True)
class OutputFacts(ModuleFacts):
    """What is known of the output module."""

    watchdog: WatchdogState
    watchdog_timeout: float | None
    """[s]"""
    watchdog_acts: str | None
    """What happens on time-out."""
    safe_current: float | None
    """Output on time-out; None where it is not known. [A]"""
    power_on: str
    when_silent: str
    """What becomes of the current when this daemon falls silent, for a person."""
    read_back_measured: bool
    """Whether the current that is read back is more than the set-point's echo."""


@dataclass(frozen=True, slots=True, kw_only=True)
class RigFacts:
    """Both modules of one gripper."""

    output: OutputFacts
    input: ModuleFacts | None


def output_facts(
    wiring: OutputWiring, *, range_verified: bool, armed: bool
) -> OutputFacts:
    """What is known of an output module."""
    watchdog, asked = watchdog_of(wiring), wiring.watchdog
    state = WatchdogState.NONE if watchdog is None else WatchdogState.UNARMED
    timeout = asked.timeout if asked else None
    if timeout is not None:
        state = WatchdogState.ARMED if armed else WatchdogState.ARMING
    safe = asked.safe_current if asked else None
    if safe is None and watchdog is not None:
        safe = watchdog.safe_current
    module = wiring.module
    acts = watchdog.acts if watchdog else None
    return OutputFacts(
        module=module.name,
        title=module.title,
        dialect=wiring.dialect,
        evidence=module.evidence,
        unverified=module.unverified,
        range=wiring.range.name,
        range_verified=range_verified,
        watchdog=state,
        watchdog_timeout=timeout,
        watchdog_acts=acts,
        safe_current=safe,
        power_on=module.power_on,
        when_silent=acts if acts and state is WatchdogState.ARMED else KEEPS,
        read_back_measured=_measured(wiring),
    )


def input_facts(wiring: InputWiring, *, range_verified: bool) -> ModuleFacts:
    """What is known of an input module."""
    module = wiring.module
    return ModuleFacts(
        module=module.name,
        title=module.title,
        dialect=wiring.dialect,
        evidence=module.evidence,
        unverified=module.unverified,
        range=wiring.range.name,
        range_verified=range_verified,
    )


def warnings(output: OutputWiring, inputs: InputWiring | None) -> tuple[str, ...]:
    """What a person should hear at every start."""
    lines = [*output.module.doubts]
    if output.watchdog is None or output.watchdog.timeout is None:
        lines.append(f"{output.module.name}: {KEEPS}")
    if inputs is not None:
        lines += (*inputs.module.doubts, *_blind(inputs))
    return tuple(lines)


def _blind(inputs: InputWiring) -> Iterator[str]:
    """A module whose least count is a current that a working loop carries."""
    map_ = inputs.module.modbus
    if inputs.dialect is not ModuleDialect.MODBUS or map_ is None:
        return
    least = inputs.range.current(map_.encoding.limits[0])
    if map_.status is None and least >= BROKEN_BELOW:
        yield (
            f"{inputs.module.name}: in {inputs.range.name} a cut wire reads as"
            f" {least / MILLI:g} mA, and is told from a value there by its stillness"
            " alone"
        )


def watchdog_of(wiring: OutputWiring) -> Watchdog | None:
    """Watchdog of a module, in the dialect that it is asked in."""
    asked = wiring.module.asked_in(wiring.dialect)
    return asked.watchdog if asked else None


def _measured(wiring: OutputWiring) -> bool:
    asked = wiring.module.asked_in(wiring.dialect)
    return asked is not None and not asked.echo
