from collections.abc import Callable, Sequence

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from gripperd.diagnose.fit.candidates import Candidate, forms
from gripperd.diagnose.readings.recording import Recording, Run
from gripperd.diagnose.search.rivalry import contest
from gripperd.diagnose.search.stepwise import search
from gripperd.diagnose.setup import problem_of
from gripperd.diagnose.verdict.ageing import Ageing
from gripperd.diagnose.verdict.artefact import Artefact, artefact
from gripperd.effects.coulomb_friction import CoulombFriction
from gripperd.effects.presliding_hysteresis import PreslidingHysteresis
from gripperd.model.effect import Effect
from gripperd.model.track import Array
from tests.diagnose.small import (
    CONTRACTION_NOISE,
    FORCE_NOISE,
    MODEL,
    MUSCLE,
    PRESSURE_NOISE,
    STEP,
    Moment,
    pinned,
    textbook,
)
from tests.effects.tracks import track_of

RATE = 0.005
HIDDEN = 40.0
"""[N]"""


def _stairs(rests: Sequence[float], pressure: float, start: float) -> Moment:
    """From one length to the next and back at a constant rate, resting at each."""
    rates = [RATE] * len(rests) + [-RATE] * len(rests)
    speed = np.concatenate([
        np.repeat((0.0, rate), (round(rest / STEP), 24))
        for rate, rest in zip(rates, [*rests, *rests], strict=True)
    ])  # fmt: skip
    contraction = np.cumsum(speed) * STEP
    size = contraction.size
    direction = np.where(np.arange(size) > contraction.argmax(), -1.0, 1.0)
    level = np.full(size, pressure)
    return Moment(start + np.arange(float(size)) * STEP, level, contraction, direction)


def _recorded(hidden: Callable[[Moment], Array]) -> Recording:
    runs, start = [], 0.0
    plans = ((1.0, 6.0, 2.0, 9.0), (0.5, 3.0, 12.0, 1.0), (6.0, 1.0, 3.0, 2.0))
    for place, rests in enumerate(plans):
        for pressure in (200e3, 400e3):
            moment = _stairs(rests, pressure, start)
            start = float(moment.time[-1]) + 60.0
            random = np.random.default_rng([place, round(pressure)])
            true = {
                "pressure": (moment.pressure, PRESSURE_NOISE),
                "contraction": (moment.contraction, CONTRACTION_NOISE),
                "force": (textbook(moment) + hidden(moment), FORCE_NOISE),
            }
            read = {
                name: value + random.normal(0.0, noise, value.size)
                for name, (value, noise) in true.items()
            }
            runs.append(Run(f"{place} {pressure:.0f}", {"time": moment.time, **read}))
    return Recording("stairs", "0" * 64, tuple(runs))


def _sticking(moment: Moment) -> Array:
    """By the logarithm of the rest, and gone within 0.8 % of the way."""
    held, rested, found = np.log1p(10.0), 0.0, []
    gone = np.diff(moment.contraction, prepend=moment.contraction[0])
    for way in gone:
        if abs(way) < 1e-9:
            rested += STEP
            found.append(0.0)
            continue
        if rested > 0:
            held, rested = np.log1p(rested), 0.0
        held *= np.exp(-abs(way) / 0.008)
        found.append(-np.sign(way) * held)
    return np.asarray(HIDDEN / np.log1p(10.0) * np.array(found))


def _sliding(moment: Moment) -> Array:
    return np.asarray(-HIDDEN / 2 * moment.direction)


def _springy(moment: Moment) -> Array:
    """Two strands that bend, by 1 and 3 %, before they slip."""
    load, found = np.zeros(2), []
    for way in np.diff(moment.contraction, prepend=0.0):
        load = np.clip(load + way / np.array([0.01, 0.03]), -1.0, 1.0)
        found.append(-HIDDEN / 2 * load.sum())
    return np.array(found)


def _seen(hidden: Callable[[Moment], Array], named: type[Effect]) -> Artefact | None:
    problem = pinned(problem_of(_recorded(hidden), MODEL, {}), "zero.force")
    listed = tuple(Candidate(named.name, one) for one in forms(named))
    found = search(problem, listed, np.random.default_rng(0))
    best = contest(found, listed)
    assert best.best.names == (named.name,)
    return artefact(found, best)


def test_what_sticks_after_a_rest_is_no_hysteresis() -> None:
    seen = _seen(_sticking, PreslidingHysteresis)
    assert isinstance(seen, Ageing)
    # After the longest rests, of nine and of twelve seconds.
    assert seen.size == pytest.approx(HIDDEN, rel=0.2)
    said = Ageing(size=41.3, distance=0.008, time=2.6).told(0.0)
    assert said == (
        "sticks by 41 N after a long rest, most of it after 2.6 s,"
        " torn off within 0.8% of contraction"
    )


def test_dry_friction_does_not_age() -> None:
    assert _seen(_sliding, CoulombFriction) is None


def test_springs_that_slip_do_not_age() -> None:
    assert _seen(_springy, PreslidingHysteresis) is None


def test_bonds_form_in_time_and_break_along_the_way() -> None:
    time = np.arange(0.0, 12.0, 0.5)
    rate = np.repeat((0.02, 0.0, -0.01), 8)

    def slope(now: float, held: Array) -> Array:
        fast = abs(rate[min(int(now / 0.5 + 1), rate.size - 1)])
        return np.asarray((1 - held) / 3.0 - held * fast / 0.01)

    solved = solve_ivp(slope, (0.0, 11.5), [1.0], t_eval=time, max_step=0.01)
    track = track_of(
        MUSCLE,
        time=time,
        step=np.diff(time, prepend=0.0),
        rate=rate,
        direction=np.sign(rate),
    )
    ageing = Ageing(size=10.0, distance=0.01, time=3.0)
    state = ageing.rest()
    lost = -ageing.along(np.zeros_like(time), track, state)
    felt = 10.0 * solved.y[0] * np.sign(rate)
    moves = rate != 0
    assert lost[moves] == pytest.approx(felt[moves], abs=0.02)
    assert not lost[~moves].any()
