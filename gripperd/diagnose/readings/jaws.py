"""A gripper without sensors in its muscle: its jaws tell what the muscle does."""

from dataclasses import replace

import numpy as np

from gripperd.diagnose.readings.recording import Recording, Run
from gripperd.model.linkage import Linkage

LENGTH = (
    "Neither contraction nor length was measured: the contraction is the one at which"
    " the linkage of the model opens as far as opening_mm."
)
PULL = (
    "force_N was not measured: grip_N is held against the pull that the model makes of"
    " pressure and contraction."
)


def told_by_jaws(recording: Recording, linkage: Linkage | None) -> bool:
    """Tell whether only the opening of the jaws says how far the muscle contracted."""
    lengths = recording.has("contraction") or recording.has("length")
    return linkage is not None and recording.has("opening") and not lengths


def quantities(recording: Recording, linkage: Linkage | None) -> frozenset[str]:
    """Names of what was measured, or follows from it without any physics."""
    names = {name for run in recording.runs for name in run.columns if run.has(name)}
    told = "length" in names or told_by_jaws(recording, linkage)
    return frozenset(names | ({"contraction"} if told else set()))


def with_remarks(recording: Recording, linkage: Linkage | None) -> Recording:
    """Say what takes the place of a sensor that there is none of."""
    pulls, grips = recording.has("force"), recording.has("grip")
    told: list[str] = []
    if told_by_jaws(recording, linkage) and (pulls or grips):
        told.append(LENGTH)
    known = quantities(recording, linkage)
    if linkage and not pulls and known.issuperset(("pressure", "contraction", "grip")):
        told.append(PULL)
    return replace(recording, remarks=(*recording.remarks, *told))


def through_jaws(
    recording: Recording, linkage: Linkage, rest_length: float
) -> Recording:
    """Give a recording the contraction at which a linkage opens so far.

    Parameters
    ----------
    recording
        Screened, without contraction or length.
    linkage
        Of the model.
    rest_length
        L_N, to which the contraction refers. [m]
    """
    noise = dict(recording.noise)
    if "opening" in noise:
        noise["contraction"] = noise["opening"] / (linkage.ratio * rest_length)
    runs = tuple(_told(run, linkage, rest_length) for run in recording.runs)
    return replace(recording, runs=runs, noise=noise)


def _told(run: Run, linkage: Linkage, rest_length: float) -> Run:
    if not run.has("opening"):
        return run
    contraction = linkage.contraction(run.columns["opening"], rest_length)
    return replace(run, columns={**run.columns, "contraction": np.asarray(contraction)})
