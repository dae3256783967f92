"""Parts of a model file: their constants, within what could be made."""

# ruff: noqa: N815  (names carry units, and units have capitals)

from collections.abc import Mapping
from types import MappingProxyType

from pydantic import Field, ValidationInfo, field_validator

from gripperd.config.section import Kilopascals, Milliamperes, Rising, Section

LEAST_SPAN = 1.0
"""Between the ends of a regulator's line: a sixteenth of the usual 4 to 20 mA. [mA]"""


class MuscleSection(Section):
    """Constants of the muscle, within what could be made."""

    rest_length_mm: float = Field(ge=10, le=10_000)
    diameter_mm: float = Field(ge=1, le=200)
    # From 54.7 deg on the ideal muscle pushes.
    braid_angle_deg: float = Field(ge=5, le=54)
    wall_thickness_mm: float = Field(gt=0, le=50)
    elastic_modulus_MPa: float = Field(gt=0, le=1000)
    friction_coefficient: float = Field(ge=0, le=2)

    @field_validator("wall_thickness_mm")
    @classmethod
    def _leave_a_bore(cls, wall: float, read: ValidationInfo) -> float:
        diameter = read.data.get("diameter_mm")
        if diameter is not None and 2 * wall >= diameter:
            message = f"two walls of {wall:g} mm leave no bore in {diameter:g} mm"
            raise ValueError(message)
        return wall


class ValveSection(Section):
    """Two points of the regulator's line."""

    current_mA: Rising[Milliamperes]
    pressure_kPa: Rising[Kilopascals]

    @field_validator("current_mA")
    @classmethod
    def _tell_apart(cls, ends: tuple[float, float]) -> tuple[float, float]:
        low, high = ends
        if high - low < LEAST_SPAN:
            message = (
                f"from {low:g} to {high:g} mA it is less than {LEAST_SPAN:g} mA, which"
                " no output could divide; is it in A?"
            )
            raise ValueError(message)
        return ends


class GripperSection(Section):
    """Linkage and return spring."""

    open_width_mm: float = Field(gt=0, le=1000)
    ratio: float = Field(ge=0.01, le=100, alias="width_per_contraction")
    spring_preload_N: float = Field(ge=0, le=100_000)
    spring_rate_N_per_mm: float = Field(ge=0, le=10_000)


PARTS: Mapping[str, type[Section]] = MappingProxyType(
    {"muscle": MuscleSection, "valve": ValveSection, "gripper": GripperSection}
)
"""By their keys in the file."""
