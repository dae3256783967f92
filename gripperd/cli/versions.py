"""The versions a command is about, and whether a daemon lets them be changed."""

import asyncio
from dataclasses import dataclass
from pathlib import Path

from gripperd.config import GripperSettings, Settings, load_settings
from gripperd.config.complaint import did_you_mean
from gripperd.control.snapshot import GripperState
from gripperd.control.states import Grip, Machine
from gripperd.errors import LinkLost, NotFound, Refused
from gripperd.link.client import Client
from gripperd.link.control import ReadState
from gripperd.store import Version, Versions, versions_of

WITHIN = 2.0
"""Longest wait for control; it answers in milliseconds. [s]"""
EMPTY = frozenset({Grip.RELEASED, Grip.NO_PART, Grip.PART_LOST})
AT_REST = frozenset({Machine.READY, Machine.DISABLED})


@dataclass(frozen=True, slots=True)
class Choice:
    """One gripper, and the versions of its model."""

    settings: Settings
    gripper: GripperSettings
    versions: Versions

    def check_free(self) -> bool:
        """Refuse to change the model of what may hold something.

        Returns
        -------
        Whether a daemon of these settings runs.

        Raises
        ------
        Refused
            A gripper with this model moves, holds, or may hold.
        LinkError
            A daemon runs and does not answer.
        """
        return asyncio.run(self._ask_all())

    async def _ask_all(self) -> bool:
        # Imported here: a prediction needs none of what the processes are made of.
        from gripperd.cli.processes import control_socket

        control = Client(control_socket(self.settings), "the control process")
        try:
            for name, gripper in self.settings.grippers.items():
                if gripper.model.name == self.gripper.model.name:
                    state = await control.ask(ReadState(name), GripperState, WITHIN)
                    _check(state, gripper)
        except LinkLost:
            return False
        finally:
            await control.close()
        return True


def chosen(config: Path | None, gripper: str | None) -> Choice:
    """Find the versions of the model of a gripper; of the first when none is named.

    Raises
    ------
    NotFound
        There is no such gripper.
    ConfigError
        The configuration is unusable.
    """
    settings = load_settings(config)
    grippers = settings.grippers
    if gripper is not None and gripper not in grippers:
        message = f"there is no gripper {gripper!r}; {did_you_mean(gripper, grippers)}"
        raise NotFound(message, key="--gripper")
    found = grippers[gripper] if gripper else next(iter(grippers.values()))
    return Choice(settings, found, versions_of(settings, found))


def _check(state: GripperState, gripper: GripperSettings) -> None:
    low = gripper.chain.regulator.current_low
    vented = state.current is not None and state.current <= low
    if state.machine in AT_REST and (
        state.grip in EMPTY or (state.grip is Grip.UNKNOWN and vented)
    ):
        return
    message = (
        f"{state.name} is {state.machine}, {state.grip}: its model stays as it is"
        " while it may hold something"
    )
    raise Refused(message, code="object-held", hints=("release first",))


def summary(version: Version, active: int) -> dict[str, object]:
    """Give what a list says of one version."""
    lineage = version.model.lineage
    facts: dict[str, object] = {
        "version": version.number,
        "name": version.name,
        "active": version.number == active,
        "parent": None,
        "created_at": None,
        "added": [],
        "gap": None,
    }
    if lineage is None:
        return facts
    made = lineage.provenance
    facts |= {
        "parent": lineage.parent,
        "created_at": lineage.created_at.isoformat(timespec="seconds"),
        "added": [effect.name for effect in made.effects],
    }
    if (gap := made.gap) is not None:
        facts["gap"] = (
            f"{gap.signal}: {gap.rmse_before:.3g} -> {gap.rmse_after:.3g} {gap.unit},"
            f" noise {gap.noise_floor:.3g} {gap.unit}"
        )
    return facts
