"""A gripper on the simulated rig, wired together in virtual time."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from itertools import count, pairwise

from gripperd.bench.faults import HEALTHY, BenchFaults
from gripperd.bench.object import BenchObject
from gripperd.bench.rig import Rig
from gripperd.control.command import (
    Command,
    Failure,
    GraspOrder,
    GraspResult,
    Order,
)
from gripperd.control.grasp import Grasp
from gripperd.control.gripper import Gripper
from gripperd.control.ledger import Key
from gripperd.control.monitors.policy import AS_SHIPPED, Monitoring
from gripperd.control.profile import Mode, Profile
from gripperd.control.senses import Senses
from gripperd.control.snapshot import GripperState, Instant
from gripperd.model import Chain
from gripperd.protocol.live_zero import LoopScale
from gripperd.signals import Measurement, Reading

PERIOD = 0.01
"""Of the control loop. [s]"""
MICRO = 1e-6


@dataclass(frozen=True, slots=True)
class Truth:
    """The rig at one millisecond, which no sensor blurs."""

    time: float
    opening: float
    grip: float


def real(profile: Profile) -> BenchObject:
    """An object exactly as its profile says."""
    return BenchObject(
        diameter=profile.diameter,
        stiffness=profile.stiffness,
        mass=profile.mass,
        friction=profile.pad_friction,
        damage_force=profile.damage_force,
    )


def ordered(profile: Profile, mode: Mode, target: float | None = None) -> GraspOrder:
    """A grasp as the profile wants it, unless told otherwise."""
    if target is None:
        target = profile.current if mode is Mode.CURRENT else profile.force
    return GraspOrder(profile=profile, mode=mode, target=target, model="reference")


class Stage:
    """Steps rig and control together, a period at a time, and sees everything."""

    def __init__(
        self,
        chain: Chain,
        rig: Rig,
        spans: Mapping[str, float],
        monitoring: Monitoring = AS_SHIPPED,
    ) -> None:
        self.chain = chain
        self.rig = rig
        self.now = 0.0
        self.truth: list[Truth] = []
        self.raw: Measurement | None = None
        """What the modules said last."""
        self.writes: list[tuple[float, float]] = []
        """Every current that was written, and when. [s, A]"""
        ids = count(1)
        self.gripper = Gripper(
            "g0",
            chain,
            auto_enable=True,
            identify=lambda: f"c{next(ids)}",
            monitoring=monitoring,
        )
        self._scales = [
            LoopScale(
                current_low=0.004, current_high=0.020, value_low=0.0, value_high=span
            )
            for span in spans.values()
        ]

    @property
    def instant(self) -> Instant:
        """The present on both clocks; people's is far ahead."""
        return Instant(self.now, self.now + 1e9)

    @property
    def state(self) -> GripperState:
        """What the gripper says of itself."""
        return self.gripper.state(self.instant)

    def measure(self) -> Measurement:
        """Read valve current and sensors as the modules would."""
        pressure, opening, grip = (
            scale.reading(current)
            for scale, current in zip(self._scales, self.rig.read_inputs(), strict=True)
        )
        current = round(self.rig.plant.current / MICRO) * MICRO
        return Measurement(
            time=self.now,
            current=Reading(current),
            pressure=pressure,
            opening=opening,
            grip=grip,
        )

    def write(self, current: float | None) -> None:
        """Drive the valve as the module would, in whole microamperes."""
        if current is not None:
            self.rig.write_current(round(current / MICRO) * MICRO)
            self.writes.append((self.now, current))

    def pass_time(self, seconds: float = PERIOD) -> None:
        """Let the rig live, watched every millisecond."""
        plant = self.rig.plant
        end = self.now + seconds
        while self.now < end - 1e-9:
            self.now += 1e-3
            self.rig.advance(self.now)
            self.truth.append(Truth(self.now, plant.opening, plant.grip))

    def tick(self, dt: float = PERIOD) -> None:
        """One period of control."""
        self.pass_time(dt)
        self.raw = self.measure()
        self.write(self.gripper.period(self.raw, dt, self.instant))

    def run(self, seconds: float) -> None:
        """So many seconds of control."""
        for _ in range(round(seconds / PERIOD)):
            self.tick()

    def until(self, happened: Callable[[], bool], seconds: float = 30.0) -> None:
        """Control until something has happened."""
        end = self.now + seconds
        while not happened():
            assert self.now < end, f"did not happen within {seconds:g} s"
            self.tick()

    def submit(
        self, order: Order, deadline: float = 30.0, key: Key | None = None
    ) -> Command:
        """Give a command."""
        return self.gripper.submit(order, deadline, key, self.instant)[0]

    def command(self, command: Command) -> Command:
        """A command as it stands now."""
        return self.gripper.ledger.get(command.id)

    def failure(self, command: Command) -> Failure:
        """Why a command did not do what was asked."""
        error = self.command(command).error
        assert error is not None
        return error

    def stop(self) -> None:
        """Freeze, as the loop does it: the write goes out at once."""
        self.write(self.gripper.stop(self.instant))

    def complete(self, order: Order) -> Command:
        """Give a command and control until it is over."""
        command = self.submit(order)
        self.until(lambda: self.command(command).final)
        return self.command(command)

    def grasp(self, order: GraspOrder, seconds: float = 30.0) -> GraspResult:
        """One grasp without a gripper around it."""
        motion = Grasp(order, self.chain, self.rig.plant.current)
        senses = Senses(self.chain)
        end = self.now + seconds
        while True:
            assert self.now < end, f"no outcome within {seconds:g} s"
            self.pass_time()
            measured = senses.judge(self.measure(), PERIOD)
            outcome = motion.step(measured, PERIOD)
            self.write(motion.ramp.current)
            if outcome is not None:
                return motion.result(outcome, measured)

    def peak(self) -> float:
        """Hardest grip so far. [N]."""
        return max(truth.grip for truth in self.truth)

    def speed(self, since: float) -> float:
        """Fastest motion of the jaws from a time on. [m/s]."""
        later = [truth for truth in self.truth if truth.time >= since]
        return max(
            abs(b.opening - a.opening) / (b.time - a.time) for a, b in pairwise(later)
        )


def grasped(
    stage: Stage,
    profile: Profile,
    mode: Mode,
    faults: BenchFaults = HEALTHY,
    **different: float,
) -> GraspResult:
    """Grasp what the profile promises, or something that differs from it."""
    stage.rig.plant.faults = faults
    stage.rig.plant.place(replace(real(profile), **different))
    return stage.grasp(ordered(profile, mode))
