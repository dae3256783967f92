"""Who alone may give commands to a gripper, and until when.

Safety does not depend on it: whoever wants may stop. When a lease runs out, what moves
is frozen and what is held stays held.
"""

from dataclasses import dataclass, replace
from hmac import compare_digest

from gripperd.control.snapshot import Instant
from gripperd.errors import Refused

HELD = "leased"
LOST = "lease-lost"
"""Codes of the two refusals."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Lease:
    """One client's right to give commands."""

    owner: str
    """In the client's own words, for the others."""
    token: str
    """What proves it; known to the owner alone."""
    ttl: float
    """Time until it has to be renewed. [s]"""
    due: float
    """Its end on the monotonic clock. [s]"""
    expires_at: float
    """The same in seconds since the epoch, for people."""


class Tenancy:
    """The lease of one gripper, or none."""

    def __init__(self) -> None:
        self._lease: Lease | None = None

    def lease(self, now: Instant) -> Lease | None:
        """The lease that counts now; for people, its end by the clock as it is now."""
        lease = self._lease
        if lease is None or now.monotonic >= lease.due:
            return None
        return replace(lease, expires_at=now.wall + lease.due - now.monotonic)

    def check(self, token: str | None, now: Instant) -> None:
        """Let the owner of the lease pass, and everybody while there is none.

        Raises
        ------
        Refused
            Somebody else has the lease; or there is none, and the token is of one that
            is over, so that its owner learns of it.
        """
        lease = self.lease(now)
        if lease is None:
            if token is not None:
                message = "your lease is over: nothing was done"
                hints = ("take it again, and look at the state first",)
                raise Refused(message, code=LOST, hints=hints)
        elif token is None or not _same(token, lease.token):
            left = lease.due - now.monotonic
            message = f"{lease.owner} has the lease for another {left:.1f} s"
            hints = ("wait for its end; a stop needs no lease",)
            raise Refused(message, code=HELD, hints=hints)

    def take(self, owner: str, token: str, ttl: float, now: Instant) -> Lease:
        """Begin a lease; the owner of the present one renews it with its token.

        Parameters
        ----------
        owner, token, ttl
            As in :class:`Lease`.

        Raises
        ------
        Refused
            Somebody else has it.
        """
        if self.lease(now) is not None:
            self.check(token, now)
        until, expires_at = now.monotonic + ttl, now.wall + ttl
        self._lease = Lease(
            owner=owner, token=token, ttl=ttl, due=until, expires_at=expires_at
        )
        return self._lease

    def give_up(self, token: str | None, now: Instant) -> Lease | None:
        """End the lease; None when there was none.

        Raises
        ------
        Refused
            It is not the caller's.
        """
        lease = self.lease(now)
        if lease is not None:
            self.check(token, now)
            self._lease = None
        return lease

    def run_out(self, now: Instant) -> Lease | None:
        """The lease whose time is up; each is given once."""
        lease = self._lease
        if lease is None or now.monotonic < lease.due:
            return None
        self._lease = None
        return lease


def _same(given: str, known: str) -> bool:
    # Not ==: its time would tell how many characters are right.
    return compare_digest(given.encode(), known.encode())
