"""What has to be there for a motion: closed interlocks, and a lease that lasts."""

from collections.abc import Iterator, Mapping
from dataclasses import replace

from gripperd.control.command import Failure
from gripperd.control.dispatch import Dispatch
from gripperd.control.interlocks import Interlocks
from gripperd.control.journal import Happening, Journal
from gripperd.control.lease import Tenancy
from gripperd.control.lifecycle import Lifecycle
from gripperd.control.monitors.policy import Cause, Policy, Reaction
from gripperd.control.monitors.sight import Symptom
from gripperd.control.snapshot import Instant
from gripperd.control.states import Event, Machine
from gripperd.errors import Refused
from gripperd.signals import Measurement

ESTOPPED = Failure(
    category="fault",
    code="estopped",
    message="the emergency stop is pressed, or its wire is cut",
)
NOT_ENABLED = Failure(
    category="precondition",
    code="not-enabled",
    message="the external enable is open, or its wire is cut",
)
LEASE_RAN_OUT = Failure(
    category="cancelled",
    code="lease-lost",
    message="the lease it was given under ran out",
)

HINTS = {
    ESTOPPED.code: "release it, then reset",
    NOT_ENABLED.code: "close the contact that `interlocks` names in the settings",
}
"""What a person can do about an interlock."""

MESSAGES = {
    Cause.ESTOPPED: ESTOPPED.message,
    Cause.NOT_ENABLED: NOT_ENABLED.message,
}
FOUND_OPEN = "found open"
"""Tells a contact that was open at the start from one that opened later."""


class Permission:
    """Lets motions begin, and freezes them when what allowed them is gone.

    It never moves anything itself; what the settings want done about an open contact is
    a reaction like that to any other fault.

    Parameters
    ----------
    life, dispatch, journal
        Of the gripper.
    policies
        What a contact that opens makes the jaws do.
    """

    def __init__(
        self,
        life: Lifecycle,
        dispatch: Dispatch,
        journal: Journal,
        policies: Mapping[Cause, Policy],
    ) -> None:
        self.tenancy = Tenancy()
        self._interlocks = Interlocks()
        self._life = life
        self._dispatch = dispatch
        self._journal = journal
        self._policies = policies
        self._found: frozenset[Cause] = frozenset()
        """Contacts that were open already when the hardware was attached."""

    def begin(self) -> None:
        """From now on a contact that opens may move the jaws; none that is open."""
        self._found = frozenset(self._open)

    @property
    def symptoms(self) -> tuple[tuple[Symptom, Policy], ...]:
        """Contacts that are open, and what is to be done about each."""
        return tuple(map(self._symptom, self._open))

    def update(self, measured: Measurement) -> None:
        """Take in the newest measurement."""
        self._interlocks.update(measured)
        self._found &= frozenset(self._open)

    def check(self) -> None:
        """Refuse a motion that may not begin.

        Raises
        ------
        Refused
            An interlock is open.
        """
        forbidden = self._forbidden
        if forbidden is not None:
            hints = (HINTS[forbidden.code],)
            raise Refused(forbidden.message, code=forbidden.code, hints=hints)

    def check_reset(self) -> None:
        """Refuse to leave an emergency stop that is still pressed.

        Raises
        ------
        Refused
            It is.
        """
        if self._interlocks.estopped:
            hints = (HINTS[ESTOPPED.code],)
            raise Refused(ESTOPPED.message, code=ESTOPPED.code, hints=hints)

    def expire(self, now: Instant) -> None:
        """End a lease whose time is up, and what was given under it.

        Also between two periods, before anything new is allowed: else that would end
        with it.
        """
        lease = self.tenancy.run_out(now)
        if lease is not None:
            text = f"the lease of {lease.owner} ran out"
            self._journal.note(Happening.LEASE, text, now.wall)
            self._end(LEASE_RAN_OUT, now)

    def enforce(self, now: Instant) -> None:
        """End what may not go on."""
        self.expire(now)
        if self._interlocks.estopped and self._life.state is not Machine.ESTOPPED:
            self._dispatch.rest()
            self._life.on(Event.ESTOP)
            self._dispatch.end_all(ESTOPPED, now)
        elif not self._interlocks.enabled:
            self._end(NOT_ENABLED, now)

    @property
    def _open(self) -> Iterator[Cause]:
        if not self._interlocks.enabled:
            yield Cause.NOT_ENABLED
        if self._interlocks.estopped:
            yield Cause.ESTOPPED

    def _symptom(self, cause: Cause) -> tuple[Symptom, Policy]:
        policy, message = self._policies[cause], MESSAGES[cause]
        if cause not in self._found:
            return Symptom(cause, message), policy
        # Nobody opened it under these eyes, so nothing that is adopted moves for it.
        still = replace(policy, reaction=Reaction.FREEZE)
        if cause is Cause.NOT_ENABLED:
            still = replace(still, latched=False)
        return Symptom(cause, message, FOUND_OPEN), still

    @property
    def _forbidden(self) -> Failure | None:
        if self._interlocks.estopped:
            return ESTOPPED
        return None if self._interlocks.enabled else NOT_ENABLED

    def _end(self, failure: Failure, now: Instant) -> None:
        if self._dispatch.running is not None:
            self._dispatch.freeze()
        self._dispatch.end_all(failure, now)
