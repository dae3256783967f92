"""Where the next version of a model is kept."""

from dataclasses import dataclass
from pathlib import Path

from gripperd.config import ModelFile, Settings, load_settings, shipped
from gripperd.errors import Refused
from gripperd.store import Version, Versions, folder_of, versions_of


@dataclass(frozen=True, slots=True)
class Parent:
    """A model among the versions it is one of."""

    versions: Versions
    number: int
    """Of the version it is."""
    settings: Settings
    is_configured: bool
    """Whether it is the model of a gripper, so that a child can be activated."""

    def way_to(self, child: Version) -> str:
        """Say how to go by a child."""
        if self.is_configured:
            return f"to go by it: gripperd model activate {child.number}"
        parts = {"valve": child.model.regulator, "gripper": child.model.linkage}
        if lacking := [f"no {key}" for key, part in parts.items() if part is None]:
            return f"no gripper can go by it: it has {' and '.join(lacking)}"
        keys = " or ".join(f"grippers.{name}.model" for name in self.settings.grippers)
        file = self.settings.source
        place = "a configuration of your own" if file == shipped(file.name) else file
        return f"to go by it: set {keys} to {child.model.source} in {place}"


def parent_of(model: ModelFile, config: Path | None) -> Parent:
    """Find a model among the versions of those that are configured.

    A model of no gripper becomes version 0 of versions of its own.

    Raises
    ------
    Refused
        Another model of that name is configured.
    ConfigError
        The configuration is unusable.
    """
    settings = load_settings(config)
    for gripper in settings.grippers.values():
        versions = versions_of(settings, gripper)
        for version in versions.all().versions:
            if version.model == model:
                return Parent(versions, version.number, settings, is_configured=True)
            if version.name == model.name:
                message = (
                    f"{model.source}: another model is configured as {model.name}"
                    f" ({version.model.source}); nothing was kept"
                )
                hints = ("give the model another name",)
                raise Refused(message, code="name-taken", hints=hints)
    versions = Versions(folder_of(settings.state_dir, model), model)
    return Parent(versions, 0, settings, is_configured=False)
