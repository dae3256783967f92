"""One grasp from nothing to its end, with one mishap, and what must be true of it."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from random import Random

from gripperd.bench.object import BenchObject
from gripperd.bench.placed import ObjectState
from gripperd.config import Settings
from gripperd.control.profile import Mode, Profile
from gripperd.control.states import Grip, Machine
from tests.control.monitors import watched
from tests.control.stage import PERIOD, Stage, ordered, real
from tests.soak.mishap import HARMLESS, LOSING

GRASPING = 12.0
"""A mishap comes at any time until then; a grasp takes 3 to 9 s. [s]"""
AFTERWARDS = 4.0
"""How long it is watched after the mishap and the last command. [s]"""
DEADLINES = (4.0, 30.0)
"""The shorter one is too short for some. [s]"""
LONGEST = 2 * max(DEADLINES)
"""Two commands in a row are over by then. [s]"""
TOLD_WITHIN = 1.0
"""From the fall of an object to the state that says so. [s]"""


@dataclass(frozen=True, slots=True, kw_only=True)
class Verdict:
    """What came of one case."""

    seed: int
    profile: str
    mishap: str
    held: bool
    """Whether it was held at some time."""
    lost: bool
    told_after: float | None
    """From the fall to the first state that tells, None when there was none. [s]"""
    objections: tuple[str, ...]
    """What should not have been."""


def varied(profile: Profile, rng: Random) -> BenchObject:
    """An object that its profile covers; no two eggs are the same."""
    size = rng.uniform(-0.9 * profile.smaller, 0.9 * profile.larger)
    return replace(
        real(profile),
        diameter=profile.diameter + size,
        stiffness=profile.stiffness * rng.uniform(0.8, 1.25),
        mass=profile.mass * rng.uniform(0.8, 1.1),
        friction=profile.pad_friction * rng.uniform(0.9, 1.2),
        damage_force=profile.damage_force * rng.uniform(1.0, 1.3),
    )


class Watch:
    """Sees the object and what is said of it, every period."""

    def __init__(self, stage: Stage) -> None:
        self.stage = stage
        self.held = False
        self.fell_at: float | None = None
        self.told_at: float | None = None
        self.late: set[str] = set()

    def look(self) -> None:
        stage = self.stage
        placed = stage.rig.plant.placed
        if placed is not None and placed.state is ObjectState.HELD:
            self.held = True
        gone = placed is None or placed.state is ObjectState.LOST
        if self.held and gone and self.fell_at is None:
            self.fell_at = stage.now
        if self.fell_at is not None and self.told_at is None and self._told():
            self.told_at = stage.now
        for command in stage.gripper.ledger.newest(9):
            if not command.final and stage.now > command.due + 2 * PERIOD:
                self.late.add(command.id)

    def _told(self) -> bool:
        state = self.stage.state
        return state.grip not in {Grip.HOLDING, Grip.CLOSING} or state.machine in {
            Machine.FAULT,
            Machine.FAULT_REACTION,
        }

    @property
    def told_after(self) -> float | None:
        if self.fell_at is None or self.told_at is None:
            return None
        return self.told_at - self.fell_at

    def run(self, seconds: float) -> None:
        end = self.stage.now + seconds
        while self.stage.now < end:
            self.stage.tick()
            self.look()

    def finish(self) -> None:
        """Go on until every command is over, and a little longer."""
        end = self.stage.now + LONGEST
        while self.stage.now < end and self._busy():
            self.run(PERIOD)
        self.run(AFTERWARDS)

    def _busy(self) -> bool:
        return not all(each.final for each in self.stage.gripper.ledger.newest(9))

    def objections(self, mishap: str) -> Iterator[str]:
        placed = self.stage.rig.plant.placed
        if placed is not None and placed.cracked:
            yield "crushed"
        if self.fell_at is not None:
            if mishap in HARMLESS:
                yield "dropped"
            if self.told_after is None or self.told_after > TOLD_WITHIN:
                yield "lost in silence"
        if self.late:
            yield "a command outlived its deadline"
        if self._busy():
            yield "a command does not end"
        if mishap == "nothing" and not self.held and not self._hurried():
            yield "not held, though nothing happened"

    def _hurried(self) -> bool:
        """Whether there was no time for a grasp."""
        (newest,) = self.stage.gripper.ledger.newest(1)
        return newest.error is not None and newest.error.code == "deadline"


def case(settings: Settings, seed: int) -> Verdict:
    """Play one case; the same seed is the same case."""
    rng = Random(seed)
    profiles: Sequence[Profile] = list(settings.profiles.values())
    profile = rng.choice(profiles)
    (gripper,) = settings.grippers.values()
    stage = watched.stage(gripper.chain, seed)
    mishaps = {**HARMLESS, **LOSING}
    mishap = rng.choice(list(mishaps))
    stage.rig.plant.place(varied(profile, rng))
    mode = rng.choice(list(Mode))
    stage.submit(ordered(profile, mode), deadline=rng.choice(DEADLINES))
    watch = Watch(stage)
    watch.run(rng.uniform(0.1, GRASPING))
    mishaps[mishap](stage, rng)
    watch.look()
    watch.finish()
    return Verdict(
        seed=seed,
        profile=profile.name,
        mishap=mishap,
        held=watch.held,
        lost=watch.fell_at is not None,
        told_after=watch.told_after,
        objections=tuple(watch.objections(mishap)),
    )
