"""One case before all methods, ours among them."""

import time
import traceback
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

from gripperd.diagnose.diagnosis import Diagnosis
from tests.exam.answer import Entry, Hidden, diagnosed, hidden, posed
from tests.exam.peers.baseline import baseline
from tests.exam.peers.classes import families
from tests.exam.peers.exhibit import Exhibit, Guess, Method, shown
from tests.exam.peers.regressors import (
    forest,
    gaussian_process,
    polynomials,
    symbolic,
)
from tests.exam.peers.selectors import pursuit, sparse
from tests.exam.question import Question

OURS = "gripperd"
METHODS: Mapping[str, Method] = {
    "scipy fits + BIC": baseline,
    "OMP on our columns": pursuit,
    "PySINDy STLSQ on our columns": sparse,
    "PySINDy polynomials": polynomials,
    "Operon": symbolic,
    "random forest": forest,
    "Gaussian process": gaussian_process,
}
SEEDS = 2**32
"""Seeds that scikit-learn knows: from a larger one it refuses to draw."""


@dataclass(frozen=True, slots=True)
class Turn:
    """What one method said of one case."""

    guess: Guess | None
    seconds: float
    """After the front end, which is ours; for ours the whole diagnosis."""
    error: str = ""


@dataclass(frozen=True, slots=True)
class Outcome:
    """One case, and the turn of every method."""

    question: Question
    hidden: tuple[Hidden, ...]
    recalibrated: Mapping[str, float]
    """Root mean square on the test by signal, with better constants alone. SI."""
    floors: Mapping[str, float]
    """Noise by signal, as our diagnosis states it. SI."""
    turns: Mapping[str, Turn]


def contested(question: Question, directory: Path) -> Outcome:
    """Make a case and show it to every method."""
    case = posed(question, directory)
    start = time.perf_counter()
    found = diagnosed(case, question.seed)
    turns = {OURS: Turn(_ours(found), time.perf_counter() - start)}
    exhibit = shown(found, question.seed % SEEDS)
    for name, method in METHODS.items():
        turns[name] = _turn(method, exhibit)
    gaps = {str(signal): gap for signal, gap in found.gaps.items()}
    return Outcome(
        question,
        hidden(case),
        {signal: gap.recalibrated for signal, gap in gaps.items()},
        {signal: gap.noise_floor for signal, gap in gaps.items()},
        turns,
    )


def _turn(method: Method, exhibit: Exhibit) -> Turn:
    start = time.perf_counter()
    try:
        guess = method(exhibit)
    except ImportError as missing:
        return Turn(None, 0.0, f"not installed: {missing.name}")
    except Exception:  # noqa: BLE001
        return Turn(None, time.perf_counter() - start, traceback.format_exc(limit=-3))
    return Turn(guess, time.perf_counter() - start)


def _ours(found: Diagnosis) -> Guess:
    entries = [Entry(n.name, n.stage, n.equivalents) for n in found.named]
    says = str(found.verdict) in ("named", "ambiguous")
    names = tuple(entry.name for entry in entries if entry.physical) if says else ()
    after = {str(signal): gap.after for signal, gap in found.gaps.items()}
    return Guess(names, families(names[0]) if names else frozenset(), after)
