"""What is odd about a configuration that can be used all the same."""

from collections.abc import Iterator

from gripperd.config import GripperSettings, Settings, saved_profiles
from gripperd.control.command import GraspOrder
from gripperd.control.evaluation import evaluate
from gripperd.control.profile import Mode, Profile
from gripperd.errors import DomainError
from gripperd.units import MILLI


def doubts(settings: Settings) -> Iterator[str]:
    """Say what will be refused, or misread, once the daemon runs."""
    saved = saved_profiles(settings.state_dir / "profiles")
    yield from saved.complaints
    profiles = {**saved.profiles, **settings.profiles}
    for name, gripper in settings.grippers.items():
        yield from _unreadable(name, gripper)
        for profile in profiles.values():
            for reason in _refusals(profile, gripper):
                yield f"{profile.name} on {name}: {reason}"


def _refusals(profile: Profile, gripper: GripperSettings) -> tuple[str, ...]:
    target = profile.force if profile.mode is Mode.FORCE else profile.current
    model = gripper.chain.name
    order = GraspOrder(profile=profile, mode=profile.mode, target=target, model=model)
    try:
        return evaluate(order, gripper.chain).reasons
    except DomainError as error:
        return (str(error),)


def _unreadable(name: str, gripper: GripperSettings) -> Iterator[str]:
    sensors = {} if gripper.input is None else gripper.input.sensors
    wiring, width = sensors.get("opening"), gripper.chain.linkage.open_width
    if wiring is not None and wiring.scale.value_high < width:
        end = wiring.scale.value_high / MILLI
        yield (
            f"{name}: the opening sensor ends at {end:g} mm, the jaws open to"
            f" {width / MILLI:g} mm"
        )
