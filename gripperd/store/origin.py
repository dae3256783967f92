"""What a version that a diagnosis made says of its making."""

from collections.abc import Iterator, Sequence

import numpy as np

from gripperd.config import Provenance
from gripperd.config.lineage import Added, Covariance, Gap, Recorded
from gripperd.diagnose.diagnosis import Diagnosis
from gripperd.diagnose.fit.candidates import WRONG
from gripperd.diagnose.verdict.key import keys_of, known_key, public, rounded
from gripperd.diagnose.verdict.named import Named
from gripperd.store.fitted import Fitted, constants, fitted


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
    recording, known = diagnosis.recording, fitted(diagnosis)
    return Provenance(
        program=program,
        recording=Recorded(name=recording.name, sha256=recording.digest),
        seed=diagnosis.seed,
        effects=tuple(map(_added, diagnosis.named)),
        refitted=tuple(_recalibrated(diagnosis, known)),
        covariance=_covariance(known),
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


def _recalibrated(diagnosis: Diagnosis, known: Fitted) -> Iterator[Added]:
    """Constants that moved by more than their tolerance without being called wrong."""
    wrong = {one.path for one in diagnosis.named}
    for constant, value in constants(diagnosis):
        path, key = constant.path, known_key(constant.path)
        if path not in wrong and abs(value - constant.nominal) > constant.sigma:
            yield Added(
                name=public(f"{WRONG}{path}"),
                parameters={key.text: rounded(value / key.factor)},
                std={key.text: rounded(known.std(constant.stated_as) / key.factor)},
            )


def _covariance(known: Fitted) -> Covariance | None:
    """Covariance of everything fitted, in the units of its keys."""
    if not known.numbers:
        return None
    units = np.array([number.key.factor for number in known.numbers])
    rows: Sequence[Sequence[float]] = (
        known.covariance / np.outer(units, units)
    ).tolist()
    return Covariance(
        parameters=tuple(number.name for number in known.numbers),
        matrix=tuple(tuple(map(rounded, row)) for row in rows),
    )
