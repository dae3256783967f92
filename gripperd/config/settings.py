"""What a daemon is told to do: the settings of every layer, put together. SI values."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from ipaddress import ip_address
from pathlib import Path

from gripperd.config.model import ModelFile
from gripperd.control.budget import FailMode
from gripperd.control.monitors.policy import Cause, Monitoring, Policy
from gripperd.control.profile import Profile
from gripperd.drivers.analog import InputWiring, OutputWiring
from gripperd.drivers.bus import Address
from gripperd.model import Chain

KEYLESS = (
    "access keys are not there yet: put a reverse proxy with authentication in front"
)
"""Why the service is for this machine alone."""


def is_loopback(host: str) -> bool:
    """Whether only this machine can reach what listens there.

    >>> is_loopback("::1"), is_loopback("0.0.0.0")
    (True, False)
    """
    if host.lower() == "localhost":
        return True
    try:
        return ip_address(host).is_loopback
    except ValueError:
        return False


@dataclass(frozen=True, slots=True, kw_only=True)
class Http:
    """Where the service listens."""

    host: str
    """Of this machine alone: see :data:`KEYLESS`."""
    port: int
    """0: any free port."""


@dataclass(frozen=True, slots=True, kw_only=True)
class BenchSettings:
    """The simulated rig, for the grippers on it."""

    host: str
    port: int
    """0: any free port."""
    seed: int
    noise: float
    """One sigma of every sensor, relative to its span. [-]"""


@dataclass(frozen=True, slots=True)
class BenchBus:
    """The bus of the simulated rig, wherever it listens."""


@dataclass(frozen=True, slots=True, kw_only=True)
class GripperSettings:
    """One gripper: its wiring, its model, its habits."""

    name: str
    bus: BenchBus | Address
    output: OutputWiring
    input: InputWiring | None
    """None: no sensors are fitted; all is left to the model."""
    model: ModelFile
    chain: Chain
    """The same, from valve current to grip force."""
    fail_mode: FailMode
    worst_leak: float
    """Of a muscle whose air is trapped, where its model has no leak. [1/s]"""
    policies: Mapping[Cause, Policy]
    """What is watched, and what is done about it."""
    auto_enable: bool
    """Enable after a start without being asked."""
    rate: float
    """Samples per second of the control loop. [Hz]"""

    @property
    def monitoring(self) -> Monitoring:
        """How it is watched."""
        sensors = self.input.sensors if self.input else {}
        spans = {
            name: abs(wiring.scale.value_high - wiring.scale.value_low)
            for name, wiring in sensors.items()
        }
        return Monitoring(policies=self.policies, spans=spans)


@dataclass(frozen=True, slots=True, kw_only=True)
class Settings:
    """Everything a daemon needs to start."""

    http: Http
    runtime_dir: Path
    """Where the sockets between the processes live."""
    state_dir: Path
    """Where what users saved lives."""
    grippers: Mapping[str, GripperSettings]
    profiles: Mapping[str, Profile]
    bench: BenchSettings
    source: Path
    """The file all this was read from."""
    content: Mapping[str, object] = field(default_factory=dict)
    """The file itself, as plain values."""
    warnings: tuple[str, ...] = ()
    """What is allowed, and doubtful, about the settings themselves."""
