"""What a diagnosis says, in sentences a person can act on."""

from collections.abc import Sequence

from gripperd.diagnose.correction.offer import Offer
from gripperd.diagnose.diagnosis import Diagnosis
from gripperd.diagnose.objection import contradicted
from gripperd.diagnose.readings.columns import BY_QUANTITY
from gripperd.diagnose.search.dead_band import DEAD_BAND
from gripperd.diagnose.search.stiction import DRY
from gripperd.diagnose.verdict.conclude import Verdict
from gripperd.diagnose.verdict.figures import fixed, listed
from gripperd.diagnose.verdict.gap import REACHED
from gripperd.diagnose.verdict.key import keys_of, known_key, plain, public
from gripperd.diagnose.verdict.named import Named
from gripperd.diagnose.verdict.recalibrated import recalibrated
from gripperd.model.effect import Signal

LITTLE = 0.8
"""Share of a gap that better constants leave, above which they need no mention. [-]"""

UNJUDGED = ("force", "opening", "grip")
"""What is told of when it was measured and no prediction of it could be compared."""


def summary(diagnosis: Diagnosis) -> str:
    """Say the verdict in one sentence."""
    gap = _closed(diagnosis)
    match diagnosis.verdict:
        case Verdict.NAMED:
            return f"The model {_told(diagnosis.named)}{_tight(diagnosis)}{gap}."
        case Verdict.AMBIGUOUS:
            # Tolerances too tight are one finding: no constant of it stands alone.
            sure = () if diagnosis.explained.looser else diagnosis.named
            firm = [one for one in sure if not one.equivalents]
            model = f"{_told(firm) or 'is off'}{_tight(diagnosis)}"
            return (
                f"The model {model}, and this recording cannot tell"
                f" {_open(diagnosis)}{gap}."
            )
        case Verdict.UNEXPLAINED:
            explains = "is sure to explain" if diagnosis.named else "explains"
            return (
                f"The model is off, and no effect of the library {explains}"
                f" it{_still_open(diagnosis)}."
            )
        case Verdict.NONE:
            return _nothing(diagnosis)
        case Verdict.UNUSABLE:
            said = "; ".join(map(contradicted, diagnosis.recording.contradictions))
            return (
                f"The recording contradicts itself, no verdict can rest on it: {said}."
            )


def statement(diagnosis: Diagnosis, entry: Named) -> str:
    """Say what one effect or constant does and what to do about it, in one sentence."""
    what = _corrected(diagnosis, entry) if entry.effect is None else _effect(entry)
    if diagnosis.verdict is Verdict.UNEXPLAINED:
        return f"Nearest, and not sure to be what is seen: {what}."
    if entry.equivalents:
        others = listed(list(map(plain, entry.equivalents)), "or")
        said = f"Perhaps {what}{_shown(diagnosis, entry)}"
        return f"{said}; this recording cannot tell it from {others}."
    if diagnosis.explained.looser and any(one.equivalents for one in diagnosis.named):
        return f"Perhaps {what}, with the others."
    if entry.effect is None:
        whose = "the model and its tolerance" if _tight(diagnosis) else "the model"
        return f"{what[0].upper()}{what[1:]}; correct {whose}."
    shown = _shown(diagnosis, entry)
    return f"The model lacks {what}{shown}; so {entry.effect.remedy}."


def _effect(entry: Named) -> str:
    worth = _size(entry.signal, entry.size)
    return f"{plain(entry.name)}, worth {worth} of {entry.signal.value} (rms)"


def _shown(diagnosis: Diagnosis, entry: Named) -> str:
    if entry.effect is None:
        return ""
    beside = f"{_held(diagnosis, entry)}{_in_band(diagnosis, entry)}"
    return f": {entry.effect.shows}{beside}"


def _held(diagnosis: Diagnosis, entry: Named) -> str:
    """Say that friction holds what rests better, which no model file keeps."""
    more = diagnosis.explained.stiction
    if not more or entry.name not in DRY:
        return ""
    return f"; what rests it holds up to {1 + more:.1f} times as much here"


def _in_band(diagnosis: Diagnosis, entry: Named) -> str:
    """Say that a band is all that is known of where a regulator sleeps."""
    if entry.name != DEAD_BAND or not diagnosis.found.problem.band:
        return ""
    return (
        "; it sleeps inside that band, moves in stairs, and nothing foretells where"
        " inside the pressure rests"
    )


def _corrected(diagnosis: Diagnosis, entry: Named) -> str:
    """Say what a constant is instead.

    Written as "the diameter is 18.61 ± 0.12 mm, not 20 mm".
    """
    assert entry.path is not None
    (estimate,) = entry.parameters.values()
    key = known_key(entry.path)
    nominal = next(
        one.nominal
        for one in diagnosis.found.problem.constants
        if one.path == entry.path
    )
    value, doubt = (
        fixed(one / key.factor, estimate.std / key.factor)
        for one in (estimate.value, estimate.std)
    )
    size = f"{value} ± {doubt} {key.spelt}".rstrip()
    return f"the {key.title} is {size}, not {key.shown(nominal)}"


def _told(entries: Sequence[Named]) -> str:
    effects = [one.name.replace("_", " ") for one in entries if one.effect]
    wrong = [
        f"{key.title} ({key.shown(estimate.value)})"
        for one in entries
        if not one.effect
        for key, estimate in zip(
            keys_of(one).values(), one.parameters.values(), strict=True
        )
    ]
    said = []
    if effects:
        said.append(f"lacks {listed(effects)}")
    if wrong:
        said.append(f"has a wrong {listed(wrong)}")
    return " and ".join(said)


def _tight(diagnosis: Diagnosis) -> str:
    tight = diagnosis.explained.looser
    return ", and tolerances tighter than its parts keep" if tight else ""


def _nothing(diagnosis: Diagnosis) -> str:
    gap, within = _closed(diagnosis), _within(diagnosis)
    unseen = [
        f"the {name}"
        for name in UNJUDGED
        if Signal(name) not in diagnosis.gaps
        and _was_there(diagnosis, name)
        and not (name == "opening" and diagnosis.split.train.model.told_by)
    ]
    if unseen:
        gap = f"{gap}; {listed(unseen)} could not be judged"
    if any(one.after > REACHED * one.reachable for one in diagnosis.gaps.values()):
        unsure = "Nothing is seen to be missing, but too little was left out to be sure"
        return f"{unsure}{gap}."
    return f"Nothing is missing: {within}what is left is noise{gap}."


def _was_there(diagnosis: Diagnosis, name: str) -> bool:
    """Whether there was a column of a quantity, be it that no reading of it is good."""
    told = diagnosis.recording
    column = BY_QUANTITY[name].name
    return any(run.has(name) for run in told.runs) or any(
        one.column == column for one in told.rejected
    )


def _within(diagnosis: Diagnosis) -> str:
    """Say that constants had to move for it, and which went furthest."""
    gap = diagnosis.gaps.get(diagnosis.main) if diagnosis.main else None
    if gap is None or gap.recalibrated > LITTLE * gap.before:
        return ""
    told = [
        one
        for one in recalibrated(diagnosis.found.problem, diagnosis.told)
        if gap.signal in diagnosis.found.problem.shown(one.constant.moves)
    ]
    if not told:
        return ""
    first = max(told, key=lambda one: abs(one.moved))
    return (
        f"once constants move ({first.key.title}"
        f" {first.key.shown(first.fit * first.key.factor)} instead of"
        f" {first.key.shown(first.model * first.key.factor)} first of all), "
    )


def _closed(diagnosis: Diagnosis) -> str:
    if diagnosis.main is None:
        return ""
    gap = diagnosis.gaps[diagnosis.main]
    before, better, after, floor = (
        _size(gap.signal, size)
        for size in (gap.before, gap.recalibrated, gap.after, gap.noise_floor)
    )
    # What better constants close is no merit of an effect.
    beside = f" ({better} with better constants alone)" if better != after else ""
    alone = len(diagnosis.recording.runs) == 1
    unseen = "the rest of its only run" if alone else "data it never saw"
    return (
        f"; on {unseen} the {diagnosis.main.value} is off by"
        f" {after} instead of {before}{beside}, and repeats by {floor}"
    )


def _still_open(diagnosis: Diagnosis) -> str:
    if diagnosis.main is None:
        return ""
    gap = diagnosis.gaps[diagnosis.main]
    if gap.left_open <= 1:
        return f"; the {gap.signal.value} of sweeps it never saw does not show it"
    left, floor = (
        _size(gap.signal, size) for size in (gap.recalibrated, gap.noise_floor)
    )
    return (
        f"; with better constants the {gap.signal.value} is still off by {left} on"
        f" data it never saw, and repeats by {floor}"
    )


def _open(diagnosis: Diagnosis) -> str:
    rivals = [
        f"{plain(one.name)} from {listed(list(map(plain, one.equivalents)), 'or')}"
        for one in diagnosis.named
        if one.equivalents
    ]
    return ", nor ".join(rivals)


def _size(signal: Signal, size: float) -> str:
    column = BY_QUANTITY[signal.value]
    return f"{size / column.scale:.3g} {column.unit}".rstrip()


def offered(offer: Offer) -> str:
    """Say what a correction is worth, and what it is not."""
    found, worth = offer.correction, offer.worth
    on = [
        one.quantity
        for one, length in zip(found.regressors, found.lengths, strict=True)
        if length is not None
    ]
    without, corrected = (
        _size(found.signal, size) for size in (worth.without, worth.corrected)
    )
    return (
        f"A smooth correction of the {found.signal.value} by {listed(on) or 'nothing'}"
        f" leaves {corrected} of {without} on data it never saw, of which"
        f" {worth.inside:.0%} lie inside its fence; it is no physics, and no part of"
        " the model"
    )


def reasons(diagnosis: Diagnosis) -> dict[str, list[str]]:
    """Give the effects that were not tested, by the reason why."""
    found: dict[str, list[str]] = {}
    for name, reason in diagnosis.untested.items():
        found.setdefault(reason, []).append(public(name))
    return found
