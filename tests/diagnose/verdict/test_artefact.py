from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest

from gripperd.diagnose.fit.candidates import Candidate
from gripperd.diagnose.fit.rival import larger
from gripperd.diagnose.readings.recording import Recording, Run
from gripperd.diagnose.residuals.problem import Problem
from gripperd.diagnose.search.found import Found
from gripperd.diagnose.search.rivalry import Contest, contest
from gripperd.diagnose.search.stepwise import search
from gripperd.diagnose.setup import problem_of
from gripperd.diagnose.verdict.artefact import (
    Artefact,
    Jump,
    SetPoint,
    Snap,
    WarmCell,
    artefact,
)
from gripperd.effects.fatigue import Fatigue
from gripperd.effects.force_sensor_bias import ForceSensorBias
from gripperd.effects.force_sensor_drift import ForceSensorDrift
from gripperd.effects.supply_saturation import SupplySaturation
from gripperd.effects.temperature_stiffness import TemperatureStiffness
from gripperd.model.effect import Effect
from gripperd.model.track import Array
from tests.diagnose.small import (
    MODEL,
    REGULATOR,
    Hidden,
    Moment,
    altered,
    moments,
    pinned,
    recording,
)

OPEN = ("muscle.diameter", "zero.force")
DRIFT = ForceSensorDrift(rate=0.05)
SLIPPED_AT = 300.0


def _slipped(moment: Moment) -> Array:
    return np.where(moment.time > SLIPPED_AT, -40.0, 0.0)


def _drifted(moment: Moment) -> Array:
    return -0.08 * moment.time


def _found(
    told: Recording, named: Effect = DRIFT, *also_open: str
) -> tuple[Found, Contest]:
    problem = pinned(problem_of(told, MODEL, {}), *OPEN, *also_open)
    listed = (Candidate(named.name, named),)
    found = search(problem, listed, np.random.default_rng(0))
    return found, contest(found, listed)


def _seen(
    told: Recording, named: Effect = DRIFT, *also_open: str
) -> tuple[Problem, Artefact | None]:
    found, best = _found(told, named, *also_open)
    return found.problem, artefact(found, best)


def test_a_mount_that_slipped_once_is_no_drift() -> None:
    problem, seen = _seen(recording(_slipped))
    assert isinstance(seen, Jump)
    assert seen.size == pytest.approx(-40.0, abs=4.0)
    before, after = (
        [bool((course.time > t).all()) for course in problem.courses]
        for t in (SLIPPED_AT, seen.at)
    )
    assert before == after


def test_it_may_slip_amid_a_sweep() -> None:
    amid = moments()["c"].time[40]

    def slipped(moment: Moment) -> Array:
        return np.where(moment.time > amid, -40.0, 0.0)

    _, seen = _seen(recording(slipped))
    assert isinstance(seen, Jump)
    assert seen.size == pytest.approx(-40.0, abs=4.0)
    assert seen.at == pytest.approx(amid, abs=1.0)


def test_it_slipped_as_well_where_the_clock_began_long_ago() -> None:
    late = altered(recording(_slipped), moments(), "time", lambda time: time + 1.7e9)
    seen, known = (_seen(told)[1] for told in (late, recording(_slipped)))
    assert isinstance(seen, Jump)
    assert isinstance(known, Jump)
    assert seen.at == pytest.approx(known.at)
    assert seen.size == pytest.approx(known.size, rel=1e-3)


def test_a_drift_is_no_jump() -> None:
    assert _seen(recording(_drifted))[1] is None


def test_where_nothing_is_named_nothing_is_foiled() -> None:
    assert _seen(recording())[1] is None


def test_the_truth_behind_a_jump_is_the_reading_without_it() -> None:
    problem, seen = _seen(recording(_slipped))
    assert isinstance(seen, Jump)
    track = problem.tracks(problem.model)[0]
    pull = np.full(track.time.size, 100.0)
    read = seen.along(pull, track, seen.rest())
    assert seen.truth(read, track) == pytest.approx(pull)


def test_what_sensors_drift_is_no_jump(monkeypatch: pytest.MonkeyPatch) -> None:
    # Were it usual that sensors drift by 60 of the 1200 N.
    monkeypatch.setattr("gripperd.diagnose.verdict.artefact.SEEN", 0.05)
    assert _seen(recording(_slipped))[1] is None


def _snapped(moment: Moment) -> Array:
    return -0.04 * moment.pressure * moment.pull_area * (moment.time > SLIPPED_AT)


def _tired(moment: Moment) -> Array:
    """A loss of the pull that goes on, in proportion to the clock."""
    return -0.06 * moment.pressure * moment.pull_area * moment.time / 690.0


def test_strands_that_broke_once_are_no_fatigue() -> None:
    _, seen = _seen(recording(_snapped), Fatigue(loss=0.002))
    assert isinstance(seen, Snap)
    assert seen.loss == pytest.approx(0.04, abs=0.004)
    assert seen.told(10.0) == "weaker by 4.1% of the ideal pull from 309 s on"
    assert replace(seen, loss=-0.02).told(10.0).startswith("stronger by 2.0%")


def test_fatigue_is_no_snap() -> None:
    assert _seen(recording(_tired), Fatigue(loss=0.002))[1] is None


def _run_in(moment: Moment) -> Array:
    """A muscle that pulls more in its first inflation."""
    more = 0.04 * moment.pressure * moment.pull_area
    return np.where(moment.time > moments()["a"].time[-1], 0.0, more)


@pytest.mark.parametrize("second", ["b", "vented"])
def test_a_muscle_that_is_run_in_has_not_snapped(second: str) -> None:
    others = [name for name in moments() if name not in ("a", second)]
    told = recording(_run_in, order=["a", second, *others])
    assert _seen(told, Fatigue(loss=0.002))[1] is None


def _warmed(told: Recording, extra: Hidden) -> Recording:
    """The same with sweeps at 5 °C and 35 °C, and a force that is there only then."""
    warmth = {"d": 278.15, "e": 308.15, "b2": 308.15}
    happened = moments()
    runs = []
    for run in told.runs:
        warm = warmth.get(run.name, 293.15)
        force = run.columns["force"] + (warm - 293.15) * extra(happened[run.name])
        level = np.full(len(run), warm)
        columns = {**run.columns, "force": force, "temperature": level}
        runs.append(Run(run.name, columns, run.kind))
    return Recording(told.name, told.digest, tuple(runs))


def test_a_zero_that_goes_with_the_temperature_is_no_stiffness() -> None:
    told = _warmed(recording(), lambda moment: np.full(moment.time.size, 1.5))
    _, seen = _seen(told, TemperatureStiffness(modulus=0.005), "zero.contraction")
    assert isinstance(seen, WarmCell)
    assert seen.rate == pytest.approx(1.5, abs=0.15)


@pytest.mark.parametrize("seed", range(4))
def test_in_a_room_that_keeps_its_warmth_a_zero_does_not_go_with_it(seed: int) -> None:
    """At 22 °C it is off by 25 N throughout, not by 12 N for each kelvin above 20."""
    random = np.random.default_rng(seed)
    told = recording(lambda moment: np.full(moment.time.size, -25.0))
    runs = [
        replace(run, columns={**run.columns, "temperature": np.full(len(run), warm)})
        for run, warm in zip(
            told.runs, random.uniform(295.1, 295.2, len(told.runs)), strict=True
        )
    ]
    found, best = _found(replace(told, runs=tuple(runs)), ForceSensorBias(bias=-5.0))
    assert best.best.names == ("force_sensor_bias",)
    assert artefact(found, best) is None


def _behind(found: Found, best: Contest, seen: Artefact, nats: float) -> Contest:
    """Give names that are behind an artefact by so much."""
    (told,) = larger(found.problem, found.null, [Candidate(seen.name, seen)])
    here = best.best
    cost = here.fit.cost + 2 * (here.evidence - told.evidence + nats)
    return replace(best, best=replace(here, fit=replace(here.fit, cost=cost)))


def test_a_moment_is_one_of_many_and_a_zero_that_warms_is_one() -> None:
    """Six moments cost 1.8 nat, and 3 nat is all that either is ahead."""
    warm = _warmed(recording(), lambda moment: np.full(moment.time.size, 1.5))
    stiff = TemperatureStiffness(modulus=0.005)
    found, best = _found(warm, stiff, "zero.contraction")
    seen = artefact(found, best)
    assert isinstance(seen, WarmCell)
    assert artefact(found, _behind(found, best, seen, 3.0)) is not None
    found, best = _found(recording(_slipped))
    seen = artefact(found, best)
    assert isinstance(seen, Jump)
    assert artefact(found, _behind(found, best, seen, 3.0)) is None


def test_what_is_as_likely_as_a_name_does_not_refute_it() -> None:
    """A cell that warms with the session drifts with the clock as well."""
    warm = _warmed(recording(), lambda moment: np.full(moment.time.size, 1.5))
    found, best = _found(warm, TemperatureStiffness(modulus=0.005), "zero.contraction")
    seen = artefact(found, best)
    assert seen is not None
    assert artefact(found, _behind(found, best, seen, 1.0)) is None


def test_a_stiffness_that_goes_with_the_temperature_is_no_zero() -> None:
    told = _warmed(recording(), lambda moment: -20.0 * moment.contraction)
    named = TemperatureStiffness(modulus=0.005)
    assert _seen(told, named, "zero.contraction")[1] is None


def _supplied(told: Recording, share: Callable[[Array], Array]) -> Recording:
    """The same with a supply that comes and goes by 80 kPa.

    The more of it is lost the more current is asked for, so that the regulator keeps
    the pressure: for each pascal as many as are told at a pressure.
    """
    runs = []
    for place, run in enumerate(told.runs):
        drop = 40e3 * (1 + np.sin(run.columns["time"] / 9.0 + place))
        asked = moments()[run.name].pressure
        current = np.asarray(REGULATOR.current(asked + share(asked) * drop))
        columns = {**run.columns, "current": current, "supply": 700e3 - drop}
        runs.append(Run(run.name, columns, run.kind))
    return Recording(told.name, told.digest, tuple(runs))


def _alike(asked: Array) -> Array:
    return np.where(asked > 5e3, 0.3, 0.0)


def _at_the_top(asked: Array) -> Array:
    return np.asarray(0.3 * asked / 500e3)


SAGS = SupplySaturation(sag=0.1)


def test_a_set_point_that_goes_with_the_supply_is_no_ceiling() -> None:
    told = _supplied(recording(), _alike)
    _, seen = _seen(told, SAGS, "valve.pressure_high", "valve.pressure_low")
    assert isinstance(seen, SetPoint)
    assert seen.rate == pytest.approx(0.3, abs=0.03)
    told_as = replace(seen, rate=0.31).told(0.0)
    assert told_as == (
        "goes with the supply by +0.31 kPa for each kPa, alike at any current"
    )


def test_a_top_that_sags_with_the_supply_is_no_set_point() -> None:
    told = _supplied(recording(), _at_the_top)
    assert _seen(told, SAGS, "valve.pressure_high", "valve.pressure_low")[1] is None
