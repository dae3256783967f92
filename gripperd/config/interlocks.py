"""Section of the settings file about the contacts that allow a gripper to move.

A contact is wired to a channel of the gripper's analog-input module, so that the loop
current is above 12 mA while it is closed: 24 V through 1.2 kilo-ohms, for example. Any
other current, and none, is an open contact. Another channel of 4-20 mA is needed where
the module has discrete inputs only.
"""

from collections.abc import Mapping
from dataclasses import replace
from typing import Annotated

from pydantic import Field, field_validator

from gripperd.bench.contacts import Contact
from gripperd.config.section import Section
from gripperd.config.wiring import Channel, InputSection
from gripperd.control.monitors.policy import (
    OPENING,
    POLICIES,
    Cause,
    Policy,
    Reaction,
)
from gripperd.drivers.analog import InputWiring, SensorWiring
from gripperd.protocol.live_zero import LoopScale

CONTACT = LoopScale(value_low=0.0, value_high=1.0)
"""A contact as a loop: 20 mA is 1, closed."""


class ContactSection(Section):
    """One contact, and what the jaws do when it opens."""

    channel: Channel
    reaction: Annotated[Reaction, Field(strict=False)] = Reaction.FREEZE

    @field_validator("reaction")
    @classmethod
    def _needs_no_part(cls, reaction: Reaction) -> Reaction:
        if reaction is Reaction.REDUCE:
            possible = ", ".join(each for each in Reaction if each is not reaction)
            message = f"an open contact says nothing of a force: {possible}"
            raise ValueError(message)
        return reaction


class InterlocksSection(Section):
    """Both contacts; one that is not given is not fitted and forbids nothing."""

    enable: ContactSection | None = None
    estop: ContactSection | None = None

    @property
    def channels(self) -> Mapping[Contact, int]:
        """Channels of the contacts that are fitted."""
        fitted = {Contact.ENABLE: self.enable, Contact.ESTOP: self.estop}
        return {name: each.channel for name, each in fitted.items() if each}

    @property
    def policies(self) -> Mapping[Cause, Policy]:
        """What follows when each of them opens."""
        enable, estop = POLICIES[Cause.NOT_ENABLED], POLICIES[Cause.ESTOPPED]
        if self.enable is not None:
            # Who lets go by itself has to be looked after before it goes on.
            latched = self.enable.reaction in OPENING
            enable = replace(enable, reaction=self.enable.reaction, latched=latched)
        if self.estop is not None:
            estop = replace(estop, reaction=self.estop.reaction)
        return {Cause.NOT_ENABLED: enable, Cause.ESTOPPED: estop}

    def with_contacts(self, wiring: InputWiring | None) -> InputWiring | None:
        """The same inputs, and the contacts beside the sensors."""
        if wiring is None:
            return None
        contacts = {
            name.value: SensorWiring(channel=channel, scale=CONTACT)
            for name, channel in self.channels.items()
        }
        sensors = {**wiring.sensors, **contacts}
        return replace(wiring, sensors=sensors)


def check_contacts(interlocks: InterlocksSection, inputs: InputSection | None) -> None:
    """Refuse contacts where there is no channel for them."""
    if not interlocks.channels:
        return
    if inputs is None:
        message = "no input is given whose channels the contacts could be on"
        raise ValueError(message)
    taken = {sensor.channel: name for name, sensor in inputs.sensors.items()}
    for name, channel in interlocks.channels.items():
        if channel >= inputs.module.channels:
            last = inputs.module.channels - 1
            message = (
                f"{name}: channel {channel} is not one of {inputs.module.name}:"
                f" 0 to {last}"
            )
            raise ValueError(message)
        if channel in taken:
            message = f"{name}: channel {channel} is already that of {taken[channel]}"
            raise ValueError(message)
        taken[channel] = name


def check_bench_contacts(interlocks: InterlocksSection) -> None:
    """Refuse contacts where the simulated rig has others."""
    for name, place in interlocks.channels.items():
        if place != name.channel:
            message = (
                f"{name} on channel {place}: the bench has it on channel {name.channel}"
            )
            raise ValueError(message)
