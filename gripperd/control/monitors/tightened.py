"""Policies as the profile of an object makes them stricter."""

from collections.abc import Mapping
from dataclasses import replace

from gripperd.control.monitors.policy import Cause, Policy
from gripperd.control.profile import Profile
from gripperd.errors import Refused


def tightened(
    policies: Mapping[Cause, Policy], profile: Profile | None
) -> Mapping[Cause, Policy]:
    """Policies with the limits of a profile, where it has any."""
    stricter = {
        cause: replace(policies[cause], limit=limit)
        for cause, limit in _limits(profile).items()
    }
    return {**policies, **stricter} if stricter else policies


def check_tightened(policies: Mapping[Cause, Policy], profile: Profile) -> None:
    """Refuse a profile that wants to be watched less closely than the gripper is.

    Raises
    ------
    Refused
        With both limits.
    """
    for cause, limit in _limits(profile).items():
        most = policies[cause].limit
        if most is not None and limit > most:
            message = (
                f"{profile.name} sets the limit of {cause} to {limit:g}, and the"
                f" gripper to {most:g} (SI): a profile may only be stricter"
            )
            raise Refused(message, code="infeasible")


def _limits(profile: Profile | None) -> Mapping[Cause, float]:
    if profile is None:
        return {}
    limits = {
        Cause.SLIP: profile.slip_closing,
        Cause.FORCE_DRIFT: profile.force_drift,
    }
    return {cause: limit for cause, limit in limits.items() if limit is not None}
