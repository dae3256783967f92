"""Settings, profiles and models: the only reader of files and environment."""

from gripperd.config.complaint import Complaint
from gripperd.config.lineage import Lineage, Provenance
from gripperd.config.location import shipped
from gripperd.config.model import ModelFile, load_chain, load_model, reference_chain
from gripperd.config.model_text import model_document, model_text
from gripperd.config.profile import (
    load_profile,
    load_profiles,
    parse_profile,
    profile_document,
)
from gripperd.config.saved import (
    SavedProfiles,
    delete_profile,
    saved_profiles,
    write_profile,
)
from gripperd.config.settings import (
    KEYLESS,
    BenchBus,
    BenchSettings,
    GripperSettings,
    Http,
    Settings,
    is_loopback,
)
from gripperd.config.settings_file import load_settings
from gripperd.control.budget import FailMode

__all__ = [
    "KEYLESS",
    "BenchBus",
    "BenchSettings",
    "Complaint",
    "FailMode",
    "GripperSettings",
    "Http",
    "Lineage",
    "ModelFile",
    "Provenance",
    "SavedProfiles",
    "Settings",
    "delete_profile",
    "is_loopback",
    "load_chain",
    "load_model",
    "load_profile",
    "load_profiles",
    "load_settings",
    "model_document",
    "model_text",
    "parse_profile",
    "profile_document",
    "reference_chain",
    "saved_profiles",
    "shipped",
    "write_profile",
]
