"""What a version that a diagnosis made says of its making."""

from collections.abc import Iterator, Sequence

import numpy as np

from gripperd.config import Provenance
from gripperd.config.lineage import Added, Covariance, Gap, Recorded
from gripperd.diagnose.diagnosis import Diagnosis
from gripperd.diagnose.fit.candidates import WRONG
from gripperd.diagnose.residuals.constants import Constant
from gripperd.diagnose.verdict.key import CONSTANTS, keys_of, public, rounded
from gripperd.diagnose.verdict.named import Named
from gripperd.diagnose.verdict.recalibrated import Recalibrated, recalibrated

OWNERS = frozenset({"muscle", "valve", "gripper"})
"""Parts of a model file that have constants."""


def is_owned(constant: Constant) -> bool:
    """Whether a constant of a fit has a place in a model file."""
    return constant.path.partition(".")[0] in OWNERS


def origin(diagnosis: Diagnosis, gap: Gap, program: str) -> Provenance:
    """Write down what a version is made of.

    Parameters
    ----------
    diagnosis
        That named what is added.
    gap
        Of the version, on data that took no part in fitting it.
    program
        Version of the program.
    """
    recording = diagnosis.recording
    return Provenance(
        program=program,
        recording=Recorded(name=recording.name, sha256=recording.digest),
        seed=diagnosis.seed,
        effects=tuple(map(_added, diagnosis.named)),
        refitted=tuple(_recalibrated(diagnosis)),
        covariance=_covariance(diagnosis),
        gap=gap,
        heldout_runs=diagnosis.held_out,
    )


def _added(entry: Named) -> Added:
    keys = keys_of(entry)
    return Added(
        name=public(entry.name),
        parameters={
            keys[name].text: rounded(one.value / keys[name].factor)
            for name, one in entry.parameters.items()
        },
        std={
            keys[name].text: rounded(one.std / keys[name].factor)
            for name, one in entry.parameters.items()
        },
    )


def _recalibrated(diagnosis: Diagnosis) -> Iterator[Added]:
    """Constants that moved by more than their tolerance without being called wrong."""
    freed = diagnosis.explained.freed
    wrong = {diagnosis.found.problem.constants[index].path for index in freed}
    for one in fitted_constants(diagnosis):
        if one.constant.path not in wrong and abs(one.moved) > 1:
            yield Added(
                name=public(f"{WRONG}{one.constant.path}"),
                parameters={one.key.text: rounded(one.fit)},
                std={one.key.text: rounded(one.std)},
            )


def fitted_constants(diagnosis: Diagnosis) -> Iterator[Recalibrated]:
    """Constants with a place in a model file, as they fit."""
    listed = recalibrated(diagnosis.found.problem, diagnosis.contest.best)
    return (one for one in listed if is_owned(one.constant))


def _covariance(diagnosis: Diagnosis) -> Covariance | None:
    """Covariance of everything named, in the units of its keys."""
    names, places, scales = _fitted(diagnosis)
    if not names:
        return None
    matrix = diagnosis.contest.best.fit.posterior[np.ix_(places, places)]
    scaled = matrix * np.outer(scales, scales)
    rows: Sequence[Sequence[float]] = scaled.tolist()
    return Covariance(
        parameters=tuple(names),
        matrix=tuple(tuple(map(rounded, row)) for row in rows),
    )


def _fitted(diagnosis: Diagnosis) -> tuple[list[str], list[int], list[float]]:
    """Names, rows in the covariance of the fit, and units of everything named."""
    fit, point = diagnosis.contest.best.fit, diagnosis.explained
    constants = diagnosis.found.problem.constants
    names, places, scales = [], [], []
    for index in sorted(point.freed):
        key = CONSTANTS[constants[index].path]
        names.append(public(f"{WRONG}{constants[index].path}"))
        places.append(index)
        width = float(point.widths[index]) * constants[index].sigma
        scales.append(width / key.factor)
    keys = {one.name: keys_of(one) for one in diagnosis.named if one.effect}
    for place, fitted in enumerate(fit.coordinates, start=point.shifts.size):
        key = keys[fitted.effect][fitted.parameter]
        names.append(f"{fitted.effect}.{key.text}")
        places.append(place)
        scales.append(fitted.unit / key.factor)
    return names, places, scales
