from collections.abc import Sequence
from dataclasses import replace

import numpy as np
import pytest

from gripperd.diagnose.fit.candidates import Candidate, forms
from gripperd.diagnose.fit.polish import polished
from gripperd.diagnose.fit.rival import Rival
from gripperd.diagnose.search import dwell, price
from gripperd.diagnose.search.found import Found
from gripperd.diagnose.search.rivalry import SURE, Contest, Place, contest
from gripperd.diagnose.search.stepwise import search
from gripperd.diagnose.search.transient import with_transients
from gripperd.diagnose.setup import problem_of
from gripperd.effects.creep import Creep
from gripperd.effects.force_sensor_bias import ForceSensorBias
from gripperd.effects.force_sensor_drift import ForceSensorDrift
from gripperd.effects.nonlinear_elasticity import NonlinearElasticity
from gripperd.effects.threshold_pressure import ThresholdPressure
from gripperd.model.effect import Signal
from gripperd.model.track import Array
from tests.diagnose import small, stepped
from tests.diagnose.small import Hidden, Moment, pinned, restless, threshold
from tests.diagnose.stepped import DWELL, OPEN, creeping, missed

LEVELS = (
    Candidate("threshold_pressure", ThresholdPressure(pressure=20e3)),
    Candidate("force_sensor_bias", ForceSensorBias(bias=5.0)),
)
CREEPS = [Candidate("creep", form) for form in forms(Creep)]
LATE = (
    # Where nothing travels the pressure creeps as the pull does.
    *(one for one in CREEPS if one.kind != ("creep", "pressure")),
    Candidate("force_sensor_drift", ForceSensorDrift(rate=0.01)),
)


def _ended(
    *hidden: Hidden, listed: Sequence[Candidate] = LEVELS
) -> tuple[Found, Contest]:
    """The search on the steps, as far above the noise as it ends."""
    problem = stepped.problem(missed, *hidden)
    found = search(problem, listed, np.random.default_rng(0))
    assert found.problem.is_inflated
    return found, contest(found, listed)


def _told(found: Found, best: Contest) -> tuple[Found, Contest]:
    noises = stepped.problem(missed).noises
    return with_transients(found, best, (*LEVELS, *LATE), noises)


def _drifting(moment: Moment) -> Array:
    """A sensor that gains 1.2 N a minute."""
    return 0.02 * moment.time


def test_what_creeps_far_below_the_misfit_is_told() -> None:
    found, best = _ended(threshold(60.0), creeping(0.02))
    assert best.best.names == ("threshold_pressure",)
    after, told = _told(found, best)
    assert told.best.names == ("threshold_pressure", "creep")
    assert after.best is told.best
    without = [place.without.names for place in told.places]
    assert without == [("creep",), ("threshold_pressure",)]


def test_beside_tolerances_that_are_too_tight_nothing_is_told() -> None:
    found, best = _ended(threshold(60.0), creeping(0.02))
    fit = best.best.fit
    point = replace(fit.point, looser=tuple(3.0 * np.ones(fit.point.shifts.size)))
    best = replace(best, best=replace(best.best, fit=replace(fit, point=point)))
    assert _told(found, best) == (found, best)


def test_creep_is_told_in_its_size() -> None:
    _, told = _told(*_ended(threshold(60.0), creeping(0.06)))
    (creep,) = (one for one in told.best.fit.point.effects if isinstance(one, Creep))
    times = creep.time * 6.0 ** np.arange(3)
    shares = np.array([creep.fast, creep.medium, creep.slow])
    late = shares @ (np.exp(-1 / times) - np.exp(-8 / times))
    # 6 % of each step per decade of 1 s and the time, from the first second to the 8th.
    assert late == pytest.approx(0.06 * np.log10(9 / 2), rel=0.25)


@pytest.mark.parametrize("hidden", [(), (_drifting,)])
def test_what_explains_but_levels_is_not_told(hidden: tuple[Hidden, ...]) -> None:
    found, best = _ended(threshold(60.0), *hidden)
    after, told = _told(found, best)
    assert told is best
    assert after is found


def _ageing(moment: Moment) -> Array:
    """A sensor that gains 0.3 N a second."""
    return 0.3 * moment.time


def _slipping(moment: Moment) -> Array:
    """After each command the force slips for seconds, either way, by 15 N or so."""
    random = np.random.default_rng(int(moment.time[0]))
    since = moment.time - moment.time[0]
    slips = random.normal(0.0, 15.0, 4)[(since // DWELL).astype(int)]
    return np.asarray(slips * np.log10(1 + since % DWELL))


def test_what_is_creep_in_part_is_not_told() -> None:
    found, best = _ended(threshold(60.0), creeping(0.02), _slipping)
    assert _told(found, best) == (found, best)


def test_creep_that_no_other_sweep_foretells_is_not_told(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    found, best = _ended(threshold(60.0), creeping(0.02))
    monkeypatch.setattr(dwell, "bears_out", lambda *_: False)
    assert _told(found, best) == (found, best)


def test_faint_creep_is_not_told() -> None:
    found, best = _ended(threshold(60.0), creeping(0.01), listed=LEVELS[1:])
    assert _told(found, best) == (found, best)


def test_what_takes_most_of_the_levels_is_told_with_it() -> None:
    found, best = _ended(threshold(60.0), creeping(0.02), listed=LEVELS[1:])
    assert best.best.names == ("force_sensor_bias",)
    _, told = _told(found, best)
    # The bias is idle beside what it stood for.
    assert told.best.names == ("threshold_pressure", "creep")
    assert len(told.places) == 2


def _with_rival(
    found: Found, best: Contest, candidate: Candidate, name: str = "threshold_pressure"
) -> Contest:
    """The same, had another fitted as well in the place of one."""
    place = best.best.names.index(name)
    own = best.best.candidates
    assert candidate.effect is not None
    point = best.places[place].without.fit.point.with_effect(candidate.effect)
    rival = Rival(
        (*own[:place], candidate, *own[place + 1 :]), polished(found.problem, point)
    )
    bare = (one.without for one in best.places)
    places = (Place(b, (rival,) if i == place else ()) for i, b in enumerate(bare))
    return replace(best, places=tuple(places))


def _stiff(moment: Moment) -> Array:
    """Rubber that pushes back by 150 N at a contraction of 12 %."""
    return -150.0 * (moment.contraction / 0.12) ** 2


def test_two_are_added_at_most() -> None:
    found, best = _ended(threshold(60.0), creeping(0.04), _stiff, listed=LEVELS[1:])
    rubber = [Candidate("nonlinear_elasticity", f) for f in forms(NonlinearElasticity)]
    noises = stepped.problem(missed).noises
    _, told = with_transients(found, best, (*LEVELS, *LATE, *rubber), noises)
    assert best.best.names == ("force_sensor_bias",)
    assert told.best.names == ("force_sensor_bias", "nonlinear_elasticity", "creep")


def test_what_creeps_is_not_told_if_it_is_idle_itself() -> None:
    found, best = _ended(threshold(60.0), creeping(0.02))
    doubtful = replace(found, threshold=1e4)
    assert _told(doubtful, best) == (doubtful, best)


def test_a_rival_that_falls_behind_is_one_no_more() -> None:
    found, best = _ended(threshold(60.0), creeping(0.02))
    _, told = _told(found, _with_rival(found, best, LEVELS[1]))
    assert told.best.names == ("threshold_pressure", "creep")
    assert told.places[0].rivals == ()


def test_a_rival_that_fits_as_well_beside_creep_stays_one() -> None:
    found, best = _ended(threshold(60.0), creeping(0.02))
    twin = Candidate("twin", ThresholdPressure(pressure=30e3))
    _, told = _told(found, _with_rival(found, best, twin))
    (rival,) = told.places[0].rivals
    assert rival.names == ("twin", "creep")
    # It has come from elsewhere to the same place, or as good as.
    assert rival.evidence == pytest.approx(told.best.evidence, abs=SURE)


def test_rivals_stay_beside_what_they_stand_for() -> None:
    found, best = _ended(threshold(60.0), _ageing)
    assert best.best.names == ("force_sensor_bias", "threshold_pressure")
    twin = Candidate("twin", ThresholdPressure(pressure=30e3))
    _, told = _told(found, _with_rival(found, best, twin))
    assert told.best.names == ("threshold_pressure", "force_sensor_drift")
    (rival,) = told.places[0].rivals
    assert rival.names == ("twin", "force_sensor_drift")


def test_no_rival_is_what_is_told_beside_it(monkeypatch: pytest.MonkeyPatch) -> None:
    found, best = _ended(threshold(60.0), creeping(0.02), listed=LEVELS[1:])
    # The bias is idle, so that creep twice would do as well as creep beside it.
    lenient = replace(found, threshold=-100.0)
    monkeypatch.setattr("gripperd.diagnose.search.needed.STRONG", 100.0)
    _, told = _told(lenient, _with_rival(found, best, LATE[0], "force_sensor_bias"))
    assert told.best.names == ("force_sensor_bias", "threshold_pressure", "creep")
    assert told.places[0].rivals == ()


def test_a_drift_is_told_if_it_is_a_fault(monkeypatch: pytest.MonkeyPatch) -> None:
    found, best = _ended(threshold(60.0), _ageing)
    _, told = _told(found, best)
    assert told.best.names == ("threshold_pressure", "force_sensor_drift")
    # Were it that of sound sensors.
    monkeypatch.setattr(price, "RAMP", 1.0)
    assert _told(found, best) == (found, best)


def test_near_the_noise_the_search_has_heard_it() -> None:
    found, best = _ended(threshold(60.0), creeping(0.02))
    calm = replace(found, problem=replace(found.problem, inflations={}))
    assert _told(calm, best) == (calm, best)


def test_without_dwells_nothing_is_told() -> None:
    ramps = small.recording(restless(threshold(60.0)))
    problem = pinned(problem_of(ramps, small.MODEL, {}), *OPEN)
    found = search(problem, LEVELS, np.random.default_rng(0))
    assert found.problem.inflation([Signal.FORCE]) > 1
    best = contest(found, LEVELS)
    assert with_transients(found, best, (*LEVELS, *LATE), problem.noises) == (
        found,
        best,
    )
