"""What was answered, beside what is true: one line of the results."""

import resource
import time
import traceback
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import cast

from gripperd.config import load_model
from gripperd.diagnose.diagnosis import Diagnosis, diagnose
from gripperd.effects import EFFECTS
from gripperd.recordings import read_recording
from tests.exam.floor import sensor_floors
from tests.exam.question import Question
from tests.hidden_rig import Case, make_case

SIGNALS = {
    "force_N": "force",
    "pressure_kPa": "pressure",
    "opening_mm": "opening",
    "grip_N": "grip",
    "contraction": "contraction",
}
"""Signal of each column."""


@dataclass(frozen=True, slots=True)
class Hidden:
    """One effect that the rig has and the model lacks."""

    name: str
    stage: str
    signal: str
    peak: float
    """Of full scale. [-]"""


@dataclass(frozen=True, slots=True)
class Entry:
    """One thing that the diagnosis names."""

    name: str
    stage: str
    equivalents: tuple[str, ...]

    @property
    def physical(self) -> bool:
        """Whether it is an effect, not a wrong constant."""
        return not self.name.startswith("parameter:")

    @property
    def members(self) -> frozenset[str]:
        """Names it stands for."""
        return frozenset({self.name, *self.equivalents})


@dataclass(frozen=True, slots=True)
class Residue:
    """Root mean square on held-out sweeps, and two floors for it. SI."""

    before: float
    recalibrated: float
    after: float
    stated_floor: float
    """Noise as the diagnosis has it."""
    sensor_floor: float
    """Noise that the rig put on the readings."""


@dataclass(frozen=True, slots=True)
class Answer:
    """One question, its truth, and what came out."""

    question: Question
    hidden: tuple[Hidden, ...] = ()
    verdict: str = "error"
    entries: tuple[Entry, ...] = ()
    main: str = ""
    """Signal the diagnosis is about."""
    gaps: Mapping[str, Residue] = field(default_factory=dict)
    seconds: float = 0.0
    """Reading and diagnosis."""
    peak_MB: float = 0.0  # noqa: N815
    """Largest memory of the process so far, the rig included."""
    error: str = ""

    @property
    def physical(self) -> tuple[Entry, ...]:
        """Effects that are named, if the verdict names any."""
        if self.verdict not in ("named", "ambiguous"):
            return ()
        return tuple(entry for entry in self.entries if entry.physical)


def answered(question: Question, directory: Path) -> Answer:
    """Make a case, diagnose it, and put truth and verdict side by side.

    Whatever goes wrong is an answer too: it counts as an error of the case.
    """
    try:
        case = posed(question, directory)
        start = time.perf_counter()
        found = diagnosed(case, question.seed)
        return _beside_truth(question, case, found, time.perf_counter() - start)
    except Exception:  # noqa: BLE001
        return Answer(question, error=traceback.format_exc(limit=-3))


def posed(question: Question, directory: Path) -> Case:
    """Simulate the case of a question."""
    return make_case(
        directory,
        seed=question.seed,
        family=question.family,
        kind=question.kind,
        names=question.names,
    )


def diagnosed(case: Case, seed: int) -> Diagnosis:
    """Diagnose a case as a person would: from its files."""
    model = load_model(case.model)
    recording = read_recording(case.recording)
    return diagnose(recording, model.explanation(), model.tolerances, EFFECTS, seed)


def hidden(case: Case) -> tuple[Hidden, ...]:
    """What the rig of a case hides."""
    effects = cast("list[dict[str, object]]", case.truth["effects"])
    return tuple(
        Hidden(
            str(effect["name"]),
            str(effect["stage"]),
            SIGNALS[str(effect["signal"])],
            float(cast("float", effect["peak_of_full_scale"])),
        )
        for effect in effects
    )


def _beside_truth(
    question: Question, case: Case, found: Diagnosis, seconds: float
) -> Answer:
    floors = sensor_floors(case.truth)
    return Answer(
        question=question,
        hidden=hidden(case),
        verdict=str(found.verdict),
        entries=tuple(Entry(n.name, n.stage, n.equivalents) for n in found.named),
        main=str(found.main or ""),
        gaps={
            str(signal): Residue(
                gap.before,
                gap.recalibrated,
                gap.after,
                gap.noise_floor,
                floors[str(signal)],
            )
            for signal, gap in found.gaps.items()
        },
        seconds=seconds,
        peak_MB=resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024,
    )
