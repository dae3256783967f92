"""What went wrong with one gripper: what is still so, and what was before."""

from collections import Counter, OrderedDict
from collections.abc import Callable, Iterable
from dataclasses import replace
from itertools import islice
from math import inf

from gripperd.control.fault import Fault
from gripperd.control.journal import Happening, Journal
from gripperd.control.monitors.policy import Cause, Policy
from gripperd.control.monitors.sight import Symptom
from gripperd.control.snapshot import Instant
from gripperd.errors import NotFound, Refused

HISTORY = 500
"""Faults that are remembered."""
CLEARED_AFTER = 1.0
"""A symptom has to be away for so long until its cause counts as gone. [s]"""


class Faults:
    """Every fault from its first symptom to long after its end.

    Parameters
    ----------
    gripper
        Whose faults they are.
    identify
        Gives a new fault its id.
    journal
        Where it is told.
    """

    def __init__(
        self, gripper: str, identify: Callable[[], str], journal: Journal
    ) -> None:
        self._gripper = gripper
        self._journal = journal
        self._identify = identify
        self._faults: OrderedDict[str, Fault] = OrderedDict()
        self._away: dict[str, float] = {}
        """Active faults, and for how long their symptom has been away. [s]"""
        self.raised: Counter[Cause] = Counter()
        """How many there have been of each cause."""

    @property
    def active(self) -> tuple[Fault, ...]:
        """Faults that still matter, oldest first."""
        return tuple(self._faults[fault_id] for fault_id in self._away)

    @property
    def latched(self) -> tuple[Fault, ...]:
        """Faults that stop the gripper."""
        return tuple(fault for fault in self.active if fault.latched)

    def adopt(self, latched: Iterable[Fault]) -> None:
        """Go on with what an earlier life latched and nobody has reset."""
        for fault in latched:
            self._faults[fault.id] = fault
            # What was gone is not back until it is seen.
            self._away[fault.id] = 0.0 if fault.cleared_at is None else inf

    def newest(self, count: int) -> list[Fault]:
        """The last faults, newest first; those that are active are among them."""
        return list(islice(reversed(self._faults.values()), count))

    def update(
        self,
        symptoms: Iterable[tuple[Symptom, Policy]],
        dt: float,
        now: Instant,
    ) -> list[Fault]:
        """Take in what is wrong now, and give the faults that are new.

        Parameters
        ----------
        symptoms
            Each with what is to be done about it.
        dt
            Time since the last call. [s]
        now
            The present.
        """
        present = {(s.cause, s.subject): (s, policy) for s, policy in symptoms}
        for fault in self.active:
            known = present.pop((fault.cause, fault.subject), None)
            self._away[fault.id] = 0.0 if known else self._away[fault.id] + dt
            self._follow(fault, now)
        return [self._raise(*each, now) for each in present.values()]

    def acknowledge(self, fault_id: str, who: str, now: Instant) -> Fault:
        """Note that somebody has seen it; done twice, the first one counts.

        Raises
        ------
        NotFound
            Unknown, or forgotten.
        """
        if fault_id not in self._faults:
            message = f"there is no fault {fault_id!r}"
            raise NotFound(message, key="id")
        fault = self._faults[fault_id]
        if fault.acknowledged_at is None:
            fault = replace(fault, acknowledged_at=now.wall, acknowledged_by=who)
            self._faults[fault_id] = fault
            self._tell(f"{fault.cause} acknowledged by {who}", now)
        return fault

    def reset(self, now: Instant) -> None:
        """Let go of what is latched.

        Raises
        ------
        Refused
            Something was not acknowledged yet, or is still wrong.
        """
        if (objection := self._objection()) is not None:
            raise objection
        self._let_go(self.latched, now)

    def reset_estop(self, now: Instant) -> None:
        """Let go of an emergency stop that is closed again; the rest stays."""
        estops = (each for each in self.latched if each.cause is Cause.ESTOPPED)
        self._let_go(tuple(estops), now)

    def check(self) -> None:
        """Refuse to go on while something is latched.

        Raises
        ------
        Refused
            With the way out.
        """
        if not self.latched:
            return
        present = any(fault.cleared_at is None for fault in self.latched)
        mend = ("mend the cause",) if present else ()
        hints = (*self._unseen, *mend, "POST .../reset", "POST .../enable")
        message = f"not possible before a reset: {_listed(self.latched)}"
        raise Refused(message, code="wrong-state", hints=hints)

    @property
    def _unseen(self) -> tuple[str, ...]:
        """What is still to be done by those who have not seen it."""
        return tuple(
            f"POST .../faults/{fault.id}/acknowledge"
            for fault in self.latched
            if fault.unseen
        )

    def _let_go(self, faults: Iterable[Fault], now: Instant) -> None:
        for fault in faults:
            self._faults[fault.id] = replace(fault, reset_at=now.wall)
            del self._away[fault.id]
            self._tell(f"{fault.cause} reset", now)

    def _follow(self, fault: Fault, now: Instant) -> None:
        """Note whether the cause is gone, or back."""
        gone = self._away[fault.id] > CLEARED_AFTER
        if gone == (fault.cleared_at is not None):
            return
        cleared = replace(fault, cleared_at=now.wall if gone else None)
        self._faults[fault.id] = cleared
        self._tell(f"{fault.cause} {'cleared' if gone else 'is back'}", now)
        if not cleared.active:
            del self._away[fault.id]

    def _raise(self, symptom: Symptom, policy: Policy, now: Instant) -> Fault:
        fault = Fault(
            id=self._identify(),
            gripper=self._gripper,
            cause=symptom.cause,
            subject=symptom.subject,
            message=symptom.text,
            reaction=policy.reaction,
            latched=policy.latched,
            raised_at=now.wall,
        )
        self._faults[fault.id] = fault
        self._away[fault.id] = 0.0
        self.raised[fault.cause] += 1
        self._tell(f"{fault.cause}: {fault.message}", now)
        over = (name for name in tuple(self._faults) if name not in self._away)
        for name in islice(over, max(len(self._faults) - HISTORY, 0)):
            del self._faults[name]
        return fault

    def _tell(self, text: str, now: Instant) -> None:
        self._journal.note(Happening.FAULT, text, now.wall)

    def _objection(self) -> Refused | None:
        if self._unseen:
            unseen = [each for each in self.latched if each.unseen]
            message = f"not acknowledged yet: {_listed(unseen)}"
            return Refused(message, code="not-acknowledged", hints=self._unseen)
        present = [each for each in self.latched if each.cleared_at is None]
        if present:
            message = f"still so: {_listed(present)}"
            return Refused(message, code="cause-present", hints=("mend it first",))
        return None


def _listed(faults: Iterable[Fault]) -> str:
    return "; ".join(map(_shown, faults))


def _shown(fault: Fault) -> str:
    """What was wrong, and whether it still is."""
    return fault.message if fault.cleared_at is None else f"{fault.message} (gone)"
