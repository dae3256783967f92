"""What the machine grants: priority, groups, a clock that is right."""

import ctypes
import grp
import os
import resource
from collections.abc import Iterator, Set
from dataclasses import dataclass
from pathlib import Path

from gripperd.doctor.finding import Finding, Result

SUBJECT = "machine"
SYS_NICE = 23
"""Bit of the capability to take any priority (capabilities(7))."""
DIALOUT = "dialout"
UNSYNCHRONISED = 5
"""TIME_ERROR, what adjtimex(2) returns of a clock that nobody keeps right."""
TIMEX_OCTETS = 512
"""More than ``struct timex`` has; all zero asks, and sets nothing."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Machine:
    """What this process may do, and how the clock is."""

    priority_limit: int
    """Highest real-time priority that it may take."""
    sys_nice: bool
    """Whether it may take any."""
    user: int
    groups: Set[int]
    dialout: int | None
    """The group that owns serial ports; None where there is none of that name."""
    synchronised: bool

    def findings(self, priority: int) -> Iterator[Finding]:
        """Compare it with what a control process wants.

        Parameters
        ----------
        priority
            The real-time priority that control asks for.
        """
        yield Finding(SUBJECT, "real-time priority", self._priority(priority))
        yield Finding(SUBJECT, "serial group", self._group())
        yield Finding(SUBJECT, "clock", self._clock())

    def _priority(self, wanted: int) -> Result:
        if self.sys_nice or self.priority_limit >= wanted:
            return Result.ok(f"priority {wanted} is granted")
        said = f"priority {wanted} is not granted, {self.priority_limit} is the limit"
        remedy = f"give the unit LimitRTPRIO={wanted}, or the user an rtprio limit"
        return Result.warning(said, remedy)

    def _group(self) -> Result:
        if self.user == 0:
            return Result.ok("this is root")
        if self.dialout is None:
            said = f"there is no group {DIALOUT}"
            remedy = "see which group owns the port, with ls -l"
            return Result.not_possible(said, remedy)
        if self.dialout in self.groups:
            return Result.ok(f"this user is in {DIALOUT}")
        remedy = f"sudo usermod -a -G {DIALOUT} USER, and log in again"
        return Result.warning(f"this user is not in {DIALOUT}", remedy)

    def _clock(self) -> Result:
        if self.synchronised:
            return Result.ok("it is synchronised")
        remedy = "run a time service such as systemd-timesyncd or chrony"
        said = "it is not synchronised: control is not affected, records are"
        return Result.warning(said, remedy)


def this_machine() -> Machine:
    """As it is for this process."""
    limit, _ = resource.getrlimit(resource.RLIMIT_RTPRIO)
    return Machine(
        priority_limit=99 if limit == resource.RLIM_INFINITY else limit,
        sys_nice=bool(_capabilities() >> SYS_NICE & 1),
        user=os.geteuid(),
        groups={os.getegid(), *os.getgroups()},
        dialout=_group_id(DIALOUT),
        synchronised=_clock_state() not in {-1, UNSYNCHRONISED},
    )


def _capabilities() -> int:
    """Effective capabilities as bits (proc(5)); none where they are not told."""
    for line in Path("/proc/self/status").read_text().splitlines():
        if line.startswith("CapEff:"):
            return int(line.split()[1], 16)
    return 0


def _group_id(name: str) -> int | None:
    try:
        return grp.getgrnam(name).gr_gid
    except KeyError:
        return None


def _clock_state() -> int:
    timex = ctypes.create_string_buffer(TIMEX_OCTETS)
    state: int = ctypes.CDLL(None).adjtimex(timex)
    return state
