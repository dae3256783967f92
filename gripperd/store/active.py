"""The versions of the model of each gripper, and settings with the active ones."""

from dataclasses import replace
from pathlib import Path

from gripperd.config import Complaint, GripperSettings, ModelFile, Settings
from gripperd.config.wiring import check_driven
from gripperd.errors import ConfigError
from gripperd.store.versions import ACTIVE, Versions


def folder_of(state_dir: Path, model: ModelFile) -> Path:
    """Where the versions of a model are kept: ``models/<name>`` of the state."""
    return state_dir / "models" / model.name


def versions_of(settings: Settings, gripper: GripperSettings) -> Versions:
    """Versions of the configured model of a gripper; settings as they were loaded."""
    folder = folder_of(settings.state_dir, gripper.model)
    return Versions(folder, gripper.model)


def with_active_models(settings: Settings) -> Settings:
    """Settings in which every gripper has the active version of its model.

    Raises
    ------
    ConfigError
        An active version is damaged, or its valve cannot be driven.
    """
    grippers = {
        name: _updated(gripper, versions_of(settings, gripper))
        for name, gripper in settings.grippers.items()
    }
    return replace(settings, grippers=grippers)


def _updated(gripper: GripperSettings, versions: Versions) -> GripperSettings:
    try:
        model = versions.get(ACTIVE).model
    except ConfigError as damaged:
        hint = f"{gripper.name}: 'gripperd model rollback' goes back to the one before"
        raise ConfigError(*damaged.complaints, hint) from None
    chain = model.chain()
    try:
        check_driven(chain.regulator, gripper.output.module, gripper.output.range)
    except ValueError as error:
        raise ConfigError(Complaint(str(error), source=model.source)) from error
    return replace(gripper, model=model, chain=chain)
