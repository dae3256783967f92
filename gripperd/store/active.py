"""The versions of the model of each gripper, and settings with the active ones."""

from dataclasses import replace
from math import isfinite
from pathlib import Path

from gripperd.config import Complaint, GripperSettings, ModelFile, Settings
from gripperd.config.range_check import check_driven
from gripperd.errors import ConfigError, DomainError
from gripperd.model import Chain
from gripperd.store.versions import ACTIVE, Versions
from gripperd.units import MILLI


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
        An active version is damaged, or a gripper cannot go by it.
    """
    grippers = {
        name: _updated(gripper, versions_of(settings, gripper))
        for name, gripper in settings.grippers.items()
    }
    return replace(settings, grippers=grippers)


def with_model(gripper: GripperSettings, model: ModelFile) -> GripperSettings:
    """Settings of a gripper with another model.

    Raises
    ------
    ConfigError
        The gripper cannot go by it: its valve cannot be driven, or more current does
        not make the jaws close harder.
    """
    chain = model.chain()
    try:
        check_driven(chain.regulator, gripper.output.module, gripper.output.range)
        _check_closes(chain)
    except ValueError as error:
        raise ConfigError(Complaint(str(error), source=model.source)) from error
    return replace(gripper, model=model, chain=chain)


def _updated(gripper: GripperSettings, versions: Versions) -> GripperSettings:
    try:
        model = versions.get(ACTIVE).model
    except ConfigError as damaged:
        hint = f"{gripper.name}: 'gripperd model rollback' goes back to the one before"
        raise ConfigError(*damaged.complaints, hint) from None
    return with_model(gripper, model)


def _check_closes(chain: Chain) -> None:
    """Refuse a model of which no current makes the open jaws close harder.

    Raises
    ------
    DomainError
        With the forces.
    """
    ends = (chain.regulator.current_low, chain.regulator.current_high)
    open_width = chain.linkage.open_width
    low, high = (float(chain.grip_force(end, open_width)) for end in ends)
    if not (isfinite(low) and low < high):
        currents = " and ".join(f"{end / MILLI:g} mA" for end in ends)
        message = (
            f"at open jaws {currents} give {low:g} N and {high:g} N: it does not close"
        )
        raise DomainError(message, key="effects")
