"""Where the next version of a model is kept."""

from dataclasses import dataclass
from pathlib import Path

from gripperd.config import ModelFile, Settings, load_settings, shipped
from gripperd.errors import Refused
from gripperd.store import Version, Versions, difference, folder_of, versions_of


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

    A model of no gripper is version 0 of versions of its own, or one of these.

    Raises
    ------
    Refused
        Another model of that name is configured, or has versions.
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
                raise _taken(model, f"configured as {model.name}", version)
    versions, number = _of_its_own(model, settings.state_dir)
    return Parent(versions, number, settings, is_configured=False)


def _of_its_own(model: ModelFile, state_dir: Path) -> tuple[Versions, int]:
    """Versions of a model of no gripper, and which of them it is."""
    folder = folder_of(state_dir, model)
    if model.lineage is not None:
        name = model.name.removesuffix(f"-{model.lineage.version}")
        family = Versions.kept(folder.with_name(name))
        for version in family.all().versions if family else ():
            if family and version.model == model:
                return family, version.number
    kept = Versions.kept(folder)
    if kept is not None and difference(kept.get(0).model, model):
        raise _taken(model, f"version 0 of {model.name}", kept.get(0))
    return Versions(folder, model), 0


def _taken(model: ModelFile, what: str, version: Version) -> Refused:
    message = (
        f"{model.source}: another model is {what} ({version.model.source});"
        " nothing was kept"
    )
    hints = ("give the model another name",)
    return Refused(message, code="name-taken", hints=hints)
