"""Section of the settings file about what is watched, and what is done about it."""

# ruff: noqa: N815  (names carry units, and units have capitals)

from collections.abc import Mapping
from dataclasses import replace
from typing import Annotated, Self, TypeAlias

from pydantic import Field, model_validator

from gripperd.config.section import Section, numbers
from gripperd.control.monitors.policy import POLICIES, Cause, Policy, Reaction

Share: TypeAlias = Annotated[float, Field(gt=0, le=100)]


class MonitorSection(Section):
    """What follows from one cause; what is left out stays as shipped."""

    reaction: Annotated[Reaction | None, Field(strict=False)] = None
    latch: bool | None = None

    def policy(self, shipped: Policy) -> Policy:
        """The policy as shipped, with what is given here."""
        given = numbers(self)
        after = given.pop("after", shipped.after)
        (limit,) = given.values() or (shipped.limit,)
        reaction = self.reaction or shipped.reaction
        latched = shipped.latched if self.latch is None else self.latch
        return replace(
            shipped,
            after=after,
            limit=limit,
            reaction=reaction,
            latched=latched or reaction is not Reaction.HOLD,
        )


class TimedSection(MonitorSection):
    """One that has to last."""

    after_s: float | None = Field(default=None, ge=0, le=60)


class SlipSection(TimedSection):
    """The jaws close unasked."""

    closing_mm: float | None = Field(default=None, gt=0, le=20)


class DriftSection(TimedSection):
    """The force goes away slowly."""

    drift_percent: Share | None = None


class OverForceSection(TimedSection):
    """The force comes close to the damage limit, of which this is a share."""

    damage_percent: float | None = Field(default=None, ge=10, le=100)


class ShortageSection(TimedSection):
    """The pressure is too low, by this share of what it should be."""

    shortage_percent: Share | None = None


class ValveSection(TimedSection):
    """The pressure is off, by this share of the span of the regulator."""

    error_percent: Share | None = None


class JawSection(TimedSection):
    """The jaws stand although a force ought to move them."""

    unmet_N: float | None = Field(default=None, gt=0, le=100_000)


class MonitorsSection(Section):
    """One section for each cause, named after it."""

    part_lost: MonitorSection = MonitorSection()
    slip: SlipSection = SlipSection()
    force_drift: DriftSection = DriftSection()
    over_force: OverForceSection = OverForceSection()
    supply_sag: ShortageSection = ShortageSection()
    leak: ShortageSection = ShortageSection()
    burst: ShortageSection = ShortageSection()
    valve_not_following: ValveSection = ValveSection()
    jaw_blocked: JawSection = JawSection()
    sensor_failed: TimedSection = TimedSection()
    output_changed: MonitorSection = MonitorSection()
    module_restarted: MonitorSection = MonitorSection()

    @model_validator(mode="after")
    def _stop_what_they_move(self) -> Self:
        """A reaction moves the jaws, so nothing else may move them until a reset."""
        for cause, policy in self.policies.items():
            if getattr(self, cause).latch is False and policy.latched:
                message = (
                    f"{cause}: latch: false goes with reaction: hold only, not"
                    f" {policy.reaction}"
                )
                raise ValueError(message)
        return self

    @property
    def policies(self) -> Mapping[Cause, Policy]:
        """What applies, cause by cause."""
        return {
            cause: getattr(self, cause).policy(POLICIES[cause])
            for cause in Cause
            if cause in type(self).model_fields
        }
