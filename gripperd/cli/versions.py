"""The versions a command is about, and what a daemon that runs makes of a change."""

import asyncio
from dataclasses import dataclass
from pathlib import Path

from gripperd.config import GripperSettings, Settings, load_settings
from gripperd.config.complaint import did_you_mean
from gripperd.errors import LinkLost, NotFound
from gripperd.link.client import Client
from gripperd.store import Version, Versions, versions_of
from gripperd.store.activation import Activation, activation


@dataclass(frozen=True, slots=True)
class Choice:
    """One gripper, and the versions of its model."""

    settings: Settings
    gripper: GripperSettings
    versions: Versions

    def activate(self, which: int | str | None) -> tuple[Version, bool]:
        """Make another version the active one, also in a daemon that runs.

        Parameters
        ----------
        which
            Number or name; None for the one that was active before.

        Returns
        -------
        The version, and whether a daemon of these settings goes by it now.

        Raises
        ------
        NotFound
            There is no such version.
        Refused
            It cannot be used, or a gripper with this model moves or may hold something.
        LinkError
            A daemon runs and does not answer; nothing was changed.
        """
        found = activation(self.settings, self.gripper.name, which)
        return found.version, asyncio.run(self._take_up(found))

    async def _take_up(self, found: Activation) -> bool:
        # Imported here: a prediction needs none of what the processes are made of.
        from gripperd.cli.processes import control_socket

        control = Client(control_socket(self.settings), "the control process")
        try:
            await found.take_up(control)
        except LinkLost:
            found.keep()
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
        "refitted": [],
        "gap": None,
    }
    if lineage is None:
        return facts
    made = lineage.provenance
    facts |= {
        "parent": lineage.parent,
        "created_at": lineage.created_at.isoformat(timespec="seconds"),
        "added": [effect.name for effect in made.effects],
        "refitted": [constant.name for constant in made.refitted],
    }
    if (gap := made.gap) is not None:
        facts["gap"] = (
            f"{gap.signal}: {gap.rmse_before:.3g} -> {gap.rmse_after:.3g} {gap.unit},"
            f" noise {gap.noise_floor:.3g} {gap.unit}"
        )
    return facts
