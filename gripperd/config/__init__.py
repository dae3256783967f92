"""Settings, profiles and models: the only reader of files and environment."""

from gripperd.config.complaint import Complaint
from gripperd.config.location import shipped
from gripperd.config.model import ModelFile, load_chain, load_model, reference_chain
from gripperd.config.profile import (
    load_profile,
    load_profiles,
    parse_profile,
    profile_document,
)
from gripperd.config.saved import delete_profile, saved_profiles, write_profile
from gripperd.config.settings import (
    BenchBus,
    BenchSettings,
    FailMode,
    GripperSettings,
    Http,
    Settings,
)
from gripperd.config.settings_file import load_settings

__all__ = [
    "BenchBus",
    "BenchSettings",
    "Complaint",
    "FailMode",
    "GripperSettings",
    "Http",
    "ModelFile",
    "Settings",
    "delete_profile",
    "load_chain",
    "load_model",
    "load_profile",
    "load_profiles",
    "load_settings",
    "parse_profile",
    "profile_document",
    "reference_chain",
    "saved_profiles",
    "shipped",
    "write_profile",
]
