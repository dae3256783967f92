"""The whole story of one recording: where, which effect, how much better."""

from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np
from threadpoolctl import threadpool_limits

from gripperd.diagnose.correction.offer import Offer, offers
from gripperd.diagnose.fit.candidates import candidates
from gripperd.diagnose.fit.polish import polished
from gripperd.diagnose.fit.rival import Rival
from gripperd.diagnose.readings.agreement import beyond_use
from gripperd.diagnose.readings.believed import believed
from gripperd.diagnose.readings.clock import with_prompt_command
from gripperd.diagnose.readings.course import is_table
from gripperd.diagnose.readings.jaws import quantities, with_remarks
from gripperd.diagnose.readings.recording import Contradiction, Recording
from gripperd.diagnose.readings.stale import without_stale
from gripperd.diagnose.readings.thinning import thinned
from gripperd.diagnose.residuals.explanation import Explanation
from gripperd.diagnose.residuals.holdout import Split, split
from gripperd.diagnose.residuals.point import Point
from gripperd.diagnose.residuals.problem import Problem
from gripperd.diagnose.search.found import Found
from gripperd.diagnose.search.nearest import nearest_of
from gripperd.diagnose.search.rivalry import Contest
from gripperd.diagnose.search.selection import Progress, Selection, selected
from gripperd.diagnose.setup import problem_of
from gripperd.diagnose.verdict.artefact import artefact
from gripperd.diagnose.verdict.completion import completed, remarked
from gripperd.diagnose.verdict.conclude import (
    Verdict,
    conclude,
    not_closed,
    not_confirmed,
)
from gripperd.diagnose.verdict.convention import with_conventions
from gripperd.diagnose.verdict.extrapolation import (
    Extrapolation,
    apart,
    extrapolation,
    swept,
)
from gripperd.diagnose.verdict.gap import Gap, beside_drift, gaps
from gripperd.diagnose.verdict.initial_state import with_fitted_state
from gripperd.diagnose.verdict.judged import (
    bearing_signals,
    main_signal,
    open_signal,
)
from gripperd.diagnose.verdict.named import Named, named
from gripperd.diagnose.verdict.next_experiment import Proposal, proposal
from gripperd.diagnose.verdict.refuted import refuted, without_refuted
from gripperd.diagnose.verdict.signature import signature
from gripperd.diagnose.verdict.where import Finding, findings
from gripperd.model.effect import Effect, Signal

MOST_ROWS = 40_000
"""More are averaged, whole numbers of neighbours: they cost and tell nothing."""


@dataclass(frozen=True, kw_only=True)
class Diagnosis:
    """Everything a report says. SI values."""

    recording: Recording
    verdict: Verdict
    named: tuple[Named, ...]
    where: tuple[Finding, ...]
    gaps: Mapping[Signal, Gap]
    main: Signal | None
    """The signal the story is about."""
    held_out: tuple[str, ...]
    """Sweeps the gaps are judged on."""
    extrapolation: Extrapolation | None
    """The gaps beyond what was searched; none when nothing held out lies there."""
    proposal: Proposal | None
    """What to run next; none when nothing is open."""
    signature: tuple[str, ...]
    """What is left, in words; empty unless something is unexplained."""
    corrections: tuple[Offer, ...]
    """Of what is unexplained: no physics, and never part of a model."""
    untested: Mapping[str, str]
    """Effects this recording cannot show, and why."""
    seed: int
    split: Split
    found: Found
    contest: Contest

    @property
    def nominal(self) -> Point:
        """The model as it came."""
        return Point(np.zeros(len(self.split.train.constants)))

    @property
    def recalibrated(self) -> Point:
        """The model with the best constants alone."""
        return self.found.null.fit.point

    @property
    def told(self) -> Rival:
        """What the model is to be: with what was named, or better constants alone."""
        return self.contest.best if self.verdict.establishes else self.found.null

    @property
    def explained(self) -> Point:
        """The model with what was found."""
        return self.contest.best.fit.point


def diagnose(  # noqa: PLR0913  (what is asked, and how to go about it)
    recording: Recording,
    model: Explanation,
    tolerances: Mapping[str, float],
    library: Mapping[str, type[Effect]],
    seed: int = 0,
    progress: Progress = lambda _what, _share: None,
    processes: int = 1,
) -> Diagnosis:
    """Find out what a model lacks to explain a recording.

    Parameters
    ----------
    recording
        Screened; see :func:`gripperd.recordings.read_recording`.
    model
        At its nominal constants.
    tolerances
        One sigma by path, as the model file states them. [SI]
    library
        Effects by name.
    seed
        Of every random draw: the same seed gives the same diagnosis.
    progress
        Told how far it is.
    processes
        How many share the work; the diagnosis is the same.

    Raises
    ------
    InputError
        When no stage of the model can be compared with what was measured.
    """
    # Threads cost small matrices more than they save, and round otherwise.
    with threadpool_limits(limits=1, user_api="blas"):
        progress("noise and drift", 0.05)
        contradicted = beyond_use(recording)
        recording = recording if contradicted else believed(recording)
        recording = with_prompt_command(without_stale(recording))
        recording = with_remarks(thinned(recording, MOST_ROWS), model.linkage)
        problem = problem_of(recording, model, tolerances, processes)
        parts = split(problem)
        if contradicted:
            return _without_verdict(recording, contradicted, parts, seed)
        columns = quantities(recording, model.linkage)
        listed, untested = candidates(library, parts.train, columns)
        rng = np.random.default_rng(seed)
        selection = selected(parts, listed, tolerances, rng, progress)
        progress("verdict", 0.9)
        parts, found = selection.parts, selection.found
        inside, _ = apart(parts)
        told = without_refuted(parts, inside, found, selection.contest, listed)
        best = completed(parts, inside, found, told, listed)
        recording = remarked(recording, selection.contest, best)
        recording = with_conventions(recording, found.problem, best.best.fit.point)
        borne_out = replace(selection, contest=best)
        return _judged(recording, borne_out, untested, seed)


def _judged(
    recording: Recording, selection: Selection, untested: dict[str, str], seed: int
) -> Diagnosis:
    """Judge what was selected; where that is nothing and much is left, what is near."""
    told = _weighed(recording, selection, untested, seed)
    near = replace(selection, contest=nearest_of(selection.found))
    nothing = told.verdict is Verdict.UNEXPLAINED and not told.named
    if not (nothing and near.contest.best.candidates):
        return told
    return _weighed(recording, near, untested, seed, is_near=True)


def _weighed(
    recording: Recording,
    selection: Selection,
    untested: dict[str, str],
    seed: int,
    *,
    is_near: bool = False,
) -> Diagnosis:
    """Hold an explanation, which may be but near, against the sweeps left out."""
    parts, found, best = selection.parts, selection.found, selection.contest
    train = parts.train
    # The noise of a table is not known, so what is left cannot be held against it.
    judge = found.problem if is_table(train.courses) else train
    conclusion = conclude(judge, found, best, is_near=is_near)
    imitated = artefact(found, best)
    start, base, nearest = (
        with_fitted_state(parts, point)
        for point in (
            Point(np.zeros(len(train.constants))),
            found.null.fit.point,
            best.best.fit.point,
        )
    )
    points = (start, base, nearest)
    inside, outside = apart(parts)
    judged = gaps(inside, points, np.random.default_rng(seed))
    entries = named(found, best, _one_by_one(parts, inside, best, nearest))
    main = main_signal(best, judged)
    # That tolerances are too tight is one finding, however many constants it moves.
    effects = 1 if nearest.looser else len(entries)
    exact = not nearest.looser and not nearest.effects
    signals = bearing_signals(train, best, len(nearest.effects), main, judged)
    bearing = [judged[signal] for signal in signals]
    spoilt = any(one.is_spoilt for one in judged.values())
    against = imitated or spoilt or refuted(parts, inside, found, best)
    if against or not all(one.confirms(effects, exact=exact) for one in bearing):
        is_open = bool(imitated) or any(one.is_open for one in bearing)
        conclusion = not_confirmed(conclusion, is_open=is_open)
    conclusion = not_closed(train, conclusion, judged, beside_drift(inside, base))
    if not conclusion.verdict.establishes:
        # Nothing is added to the model, so better constants are all there is.
        points = (start, base, base)
        judged = gaps(inside, points, np.random.default_rng(seed))
    if nothing := conclusion.verdict is Verdict.NONE:
        entries = ()
    if unexplained := conclusion.verdict is Verdict.UNEXPLAINED:
        main = open_signal(conclusion.signals, main, judged)
    left = conclusion.signals or ((main,) if main else ())
    return Diagnosis(
        recording=recording,
        verdict=conclusion.verdict,
        named=entries,
        where=findings(*((part, part.residuals(base)) for part in (train, parts.test))),
        gaps=judged,
        main=main,
        held_out=swept(parts, inside),
        extrapolation=extrapolation(parts, outside, points, seed),
        proposal=None if nothing else _next(found.problem, best),
        signature=signature(train, best, conclusion, imitated) if unexplained else (),
        corrections=tuple(offers(parts, left, base, nearest)) if unexplained else (),
        untested=untested | dict.fromkeys(found.faint, "leaves no trace here"),
        seed=seed,
        split=parts,
        found=found,
        contest=best,
    )


def _one_by_one(
    parts: Split, inside: Problem, best: Contest, nearest: Point
) -> list[Mapping[Signal, Gap]]:
    """Give the gap that each candidate closes beside all others."""
    others = (
        with_fitted_state(parts, place.without.fit.point) for place in best.places
    )
    rng = np.random.default_rng(0)
    return [gaps(inside, (other, other, nearest), rng) for other in others]


def _without_verdict(
    recording: Recording,
    contradicted: tuple[Contradiction, ...],
    parts: Split,
    seed: int,
) -> Diagnosis:
    """Say what contradicts what, and nothing of the model."""
    start = Point(np.zeros(len(parts.train.constants)))
    null = Rival((), polished(parts.train, start))
    known = dict.fromkeys((*contradicted, *recording.contradictions))
    return Diagnosis(
        recording=replace(recording, contradictions=tuple(known)),
        verdict=Verdict.UNUSABLE,
        named=(),
        where=(),
        gaps={},
        main=None,
        held_out=(),
        extrapolation=None,
        proposal=None,
        signature=(),
        corrections=(),
        untested={},
        seed=seed,
        split=parts,
        found=Found(parts.train, null, null, (), 0.0, {}, (), np.empty(0)),
        contest=Contest(null),
    )


def _next(problem: Problem, best: Contest) -> Proposal | None:
    for place in best.places:
        if place.rivals:
            return proposal(problem, best.best, place.rivals[0], best.margin)
    return None
