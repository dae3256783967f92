"""A model with what a diagnosis named, and the proof that it is the better one.

The effects were fitted together with the constants of the model, so both are written:
an effect beside constants of another fit would be off by what the two share. What
belongs to the rig of the recording (small zeros and delays of its sensors) stays out,
and the gap is judged again without it: the numbers of a version are its own.
"""

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, TypeVar

import numpy as np

from gripperd.config import ModelFile, Provenance
from gripperd.config.lineage import Gap
from gripperd.diagnose.diagnosis import Diagnosis
from gripperd.diagnose.readings.columns import BY_QUANTITY
from gripperd.diagnose.residuals.point import Point
from gripperd.diagnose.statement import summary
from gripperd.diagnose.verdict.conclude import Verdict
from gripperd.diagnose.verdict.extrapolation import apart
from gripperd.diagnose.verdict.gap import Gap as Judged
from gripperd.diagnose.verdict.gap import gaps
from gripperd.diagnose.verdict.initial_state import with_fitted_state
from gripperd.diagnose.verdict.key import (
    CONSTANTS,
    Key,
    keys_of,
    known_key,
    rounded,
)
from gripperd.diagnose.verdict.named import Estimate
from gripperd.errors import Refused
from gripperd.model import StaticMuscle
from gripperd.model.effect import Effect, acts_in_muscle
from gripperd.model.parameter import parameters
from gripperd.store.fitted import constants, fitted, kept
from gripperd.store.origin import origin

if TYPE_CHECKING:
    from _typeshed import DataclassInstance

Part = TypeVar("Part", bound="DataclassInstance")


@dataclass(frozen=True, slots=True)
class Improvement:
    """A better model, and where it comes from."""

    model: ModelFile
    provenance: Provenance


def improvement(model: ModelFile, diagnosis: Diagnosis, program: str) -> Improvement:
    """Give the model with everything a diagnosis named.

    Parameters
    ----------
    model
        The model that was diagnosed.
    diagnosis
        What was found.
    program
        Version of the program.

    Raises
    ------
    Refused
        Nothing was named, or data that took no part in the fit do not confirm it.
    """
    _check_named(diagnosis)
    point = kept(diagnosis)
    gap = _confirmed(diagnosis, point)
    found = diagnosis.found.problem.explanation(point)
    effects = _tidy_effects(found.effects, diagnosis)
    better = replace(
        model,
        static=StaticMuscle(
            _tidy(found.muscle, _keys("muscle")), tuple(filter(acts_in_muscle, effects))
        ),
        regulator=found.regulator and _tidy(found.regulator, _keys("valve")),
        linkage=found.linkage and _tidy(found.linkage, _keys("gripper")),
        effects=tuple(each for each in effects if not acts_in_muscle(each)),
        tolerances=_known(model.tolerances, dict(_tolerances(diagnosis))),
        lineage=None,
    )
    return Improvement(better, origin(diagnosis, gap, program))


def _keys(owner: str) -> dict[str, Key]:
    """Keys of the constants of one part of a model file, by their names inside."""
    paths = (path.partition(".") for path in CONSTANTS)
    return {
        name: CONSTANTS[f"{part}.{name}"] for part, _, name in paths if part == owner
    }


def _tidy(part: Part, keys: Mapping[str, Key]) -> Part:
    """Round the numbers of a part."""
    tidy = {name: key.tidy(getattr(part, name)) for name, key in keys.items()}
    return replace(part, **tidy)


def _tidy_effects(
    effects: Iterable[Effect], diagnosis: Diagnosis
) -> tuple[Effect, ...]:
    """Round the numbers of what was added, and of what the model had."""
    keys = {entry.name: keys_of(entry) for entry in diagnosis.named}
    for one, _ in constants(diagnosis):
        if one.effect is not None:
            name = one.stated_as.rpartition(".")[2]
            keys.setdefault(one.effect.name, {})[name] = known_key(one.path)
    return tuple(_tidy(each, keys.get(each.name, {})) for each in effects)


def _check_named(diagnosis: Diagnosis) -> None:
    if diagnosis.verdict is not Verdict.NAMED:
        said = summary(diagnosis)
        message = f"nothing to apply, the verdict is {diagnosis.verdict}: {said}"
        raise Refused(message, code="not-named")


def _confirmed(diagnosis: Diagnosis, point: Point) -> Gap:
    """Gap of a point on data that took no part in fitting it."""
    split, signal = diagnosis.split, diagnosis.main
    start, base, kept = (
        with_fitted_state(split, one)
        for one in (diagnosis.nominal, diagnosis.recalibrated, point)
    )
    draws = np.random.default_rng(diagnosis.seed)
    judged = gaps(apart(split)[0], (start, base, kept), draws)
    if signal is None or signal not in judged:
        message = "nothing to apply: no data were left out to confirm it on"
        raise Refused(message, code="not-confirmed")
    gap, column = judged[signal], BY_QUANTITY[signal.value]
    if not _shrinks(gap):
        sizes = (gap.before, gap.recalibrated, gap.after)
        before, recalibrated, after = (f"{one / column.scale:.3g}" for one in sizes)
        message = (
            f"not applied: on data that took no part the {signal.value} would be off by"
            f" {after} {column.unit}; by {before} {column.unit} as it is, by"
            f" {recalibrated} {column.unit} with better constants alone"
        )
        raise Refused(message, code="not-confirmed")
    return Gap(
        signal=column.name,
        unit=column.unit,
        rmse_before=rounded(gap.before / column.scale),
        rmse_recalibrated=rounded(gap.recalibrated / column.scale),
        rmse_after=rounded(gap.after / column.scale),
        noise_floor=rounded(gap.noise_floor / column.scale),
    )


def _shrinks(gap: Judged) -> bool:
    """Whether it shrinks, and not by recalibration alone that would do better."""
    return gap.after < gap.before and gap.ci95_after[0] <= gap.recalibrated


def _tolerances(diagnosis: Diagnosis) -> Iterator[tuple[str, float]]:
    """One sigma of what was fitted; of constants no more than is possible either way.

    Of effects only where one sigma to either side is possible.
    """
    fit = fitted(diagnosis)
    for constant, value in constants(diagnosis):
        low, high = constant.limits
        possible = min(fit.std(constant.stated_as), value - low, high - value)
        # A value at its limit cannot be off both ways: it is told without.
        yield constant.stated_as, known_key(constant.path).tidy(possible)
    for entry in diagnosis.named:
        known = parameters(entry.effect) if entry.effect else {}
        keys = keys_of(entry)
        for name in known.keys() & entry.parameters.keys():
            size = entry.parameters[name]
            if size.std > 0 and _is_inside(size, known[name].low, known[name].high):
                yield f"effects.{entry.name}.{name}", keys[name].tidy(size.std)


def _known(
    before: Mapping[str, float], fitted: Mapping[str, float]
) -> dict[str, float]:
    """Tolerances after a fit: a number that ended at its limit has none."""
    known = {**before, **fitted}
    return {path: size for path, size in known.items() if size or path not in fitted}


def _is_inside(one: Estimate, low: float, high: float) -> bool:
    return low <= one.value - one.std and one.value + one.std <= high
