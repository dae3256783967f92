from dataclasses import replace
from functools import partial
from pathlib import Path

import numpy as np
import pytest

from gripperd.config import load_model
from gripperd.diagnose.diagnosis import Diagnosis, diagnose
from gripperd.diagnose.document import document
from gripperd.diagnose.fit.candidates import Candidate, forms
from gripperd.diagnose.readings.recording import Recording
from gripperd.diagnose.residuals.explanation import AtRest
from gripperd.diagnose.residuals.holdout import split
from gripperd.diagnose.search.stepwise import search
from gripperd.diagnose.setup import problem_of
from gripperd.diagnose.statement import summary
from gripperd.diagnose.verdict.artefact import Jump
from gripperd.diagnose.verdict.conclude import Verdict, conclude
from gripperd.diagnose.verdict.gap import Gap
from gripperd.effects import EFFECTS
from gripperd.errors import InputError
from gripperd.model import Linkage
from gripperd.model.effect import Signal
from gripperd.model.memory import begin, play
from gripperd.model.track import Array
from gripperd.recordings import read_recording
from tests.diagnose.conftest import FEW
from tests.diagnose.small import (
    LINKAGE,
    MODEL,
    Moment,
    altered,
    moments,
    nothing,
    pinned,
    recording,
    restless,
    rubbing,
    threshold,
    with_jaws,
    without,
)
from tests.exam.floor import sensor_floors
from tests.hidden_rig import make_case

LIBRARY = {name: EFFECTS[name] for name in FEW}
JAWS = (
    "linkage_friction",
    "linkage_backlash",
    "jaw_compliance",
    "coulomb_friction",
    "force_sensor_bias",
)
SHARP = {"threshold_pressure": EFFECTS["threshold_pressure"]}


def _names(told: Diagnosis) -> list[str]:
    return [entry.name for entry in told.named]


def _share(told: Diagnosis) -> float:
    """Share of the structure that the best explanation takes away. [-]."""
    return conclude(told.split.train, told.found, told.contest).share


def _late(told: Recording) -> Diagnosis:
    return diagnose(told, MODEL, {}, SHARP)


def test_where_nothing_is_hidden_the_whole_library_finds_nothing() -> None:
    told = diagnose(recording(), MODEL, {}, EFFECTS)
    assert told.verdict is Verdict.NONE
    assert (told.named, told.where, told.signature) == ((), (), ())
    assert told.proposal is None


def test_a_hidden_threshold_is_named(told: Diagnosis) -> None:
    assert told.verdict is Verdict.NAMED
    assert _names(told) == ["threshold_pressure"]


def test_the_gap_closes_down_to_the_noise(told: Diagnosis) -> None:
    gap = told.gaps[Signal.FORCE]
    assert gap.before > gap.recalibrated > gap.after
    assert gap.after < 1.3 * gap.noise_floor
    assert told.main is Signal.FORCE


def test_it_tells_where(told: Diagnosis) -> None:
    assert told.where
    assert {finding.signal for finding in told.where} == {Signal.FORCE}
    # In sweeps that were searched, and in those held out.
    places, held_out = {finding.run for finding in told.where}, {*told.held_out}
    assert places & held_out
    assert places - held_out


def test_it_tells_what_could_not_be_seen(told: Diagnosis) -> None:
    listed = diagnose(without(recording(), "current"), MODEL, {}, EFFECTS).untested
    assert listed["valve_lag"] == "current not measured"
    assert "threshold_pressure" not in told.untested


def test_the_three_points_are_those_of_the_story(told: Diagnosis) -> None:
    assert not told.nominal.shifts.any()
    assert told.recalibrated.effects == ()
    assert told.recalibrated.shifts.any()
    assert [effect.name for effect in told.explained.effects] == _names(told)


def test_the_same_seed_gives_the_same_document(told: Diagnosis) -> None:
    again = diagnose(recording(threshold(25.0)), MODEL, {}, LIBRARY)
    first, second = (
        document(one, model="reference", program="gripperd") for one in (told, again)
    )
    assert first == second


def test_the_order_of_sweeps_in_time_does_not_matter_to_a_static_effect(
    told: Diagnosis,
) -> None:
    # The first sweep stays first: only it can show a first inflation.
    order = ("vented", "c", "b2", "d", "a", "e", "b", "f")
    other = _late(recording(threshold(25.0), order=order))
    assert _names(other) == ["threshold_pressure"]
    known, found = (one.named[0].parameters["pressure"] for one in (told, other))
    assert found.value == pytest.approx(known.value, abs=2 * known.std)


def test_a_recording_without_current_works() -> None:
    told = _late(without(recording(threshold(25.0)), "current"))
    assert _names(told) == ["threshold_pressure"]
    assert set(told.gaps) == {Signal.FORCE}


def test_a_recording_of_the_valve_alone_works() -> None:
    told = _late(without(recording(), "contraction", "force"))
    assert told.verdict is Verdict.NONE
    assert set(told.gaps) == {Signal.PRESSURE}
    assert told.main is Signal.PRESSURE


@pytest.mark.parametrize("linkage", [None, LINKAGE])
def test_a_gripper_may_be_there_or_not(linkage: Linkage | None) -> None:
    model = replace(MODEL, linkage=linkage)
    told = diagnose(with_jaws(recording()), model, {}, {})
    assert told.verdict is Verdict.NONE
    assert (Signal.OPENING in told.gaps) == (linkage is not None)


def test_what_is_left_out_takes_no_part_in_choosing_or_fitting() -> None:
    problem = pinned(
        problem_of(recording(threshold(25.0)), MODEL, {}), "muscle.diameter"
    )
    parts = split(problem)
    spoilt = tuple(
        replace(
            course, measured={**course.measured, "force": course.column("force") + 99}
        )
        if course.run in parts.runs
        else course
        for course in problem.courses
    )
    listed = [Candidate(e.name, e) for e in forms(SHARP["threshold_pressure"])]
    found, again = (
        search(split(one).train, listed, np.random.default_rng(0))
        for one in (problem, replace(problem, courses=spoilt))
    )
    assert again.best.names == found.best.names == ("threshold_pressure",)
    assert again.best.evidence == found.best.evidence
    assert again.best.fit.point.effects == found.best.fit.point.effects


def test_nor_in_the_noise_it_is_weighed_by() -> None:
    plain = recording()
    told = diagnose(plain, MODEL, {}, {})
    spoilt = diagnose(
        altered(plain, told.held_out, "force", lambda f: 1.3 * f + 40.0), MODEL, {}, {}
    )
    assert spoilt.held_out == told.held_out
    for signal, noise in told.split.train.noises.items():
        found = spoilt.split.train.noises[signal]
        assert found.std == pytest.approx(noise.std, rel=1e-6)
        assert found.drift == noise.drift
    shifts = told.recalibrated.shifts
    assert spoilt.recalibrated.shifts == pytest.approx(shifts, abs=1e-4)


def _bump(moment: Moment) -> Array:
    """Nothing that a library holds: 60 N at one length and pressure."""
    length = (moment.contraction - 0.1) / 0.05
    pressure = (moment.pressure - 250e3) / 100e3
    return np.asarray(60.0 * np.exp(-(length**2) - pressure**2))


def test_what_nothing_explains_gets_a_correction_and_the_model_nothing() -> None:
    told = diagnose(recording(_bump), MODEL, {}, {})
    assert told.verdict is Verdict.UNEXPLAINED
    (offer,) = told.corrections
    assert offer.correction.signal is Signal.FORCE
    gap = told.gaps[Signal.FORCE]
    assert offer.worth.without == pytest.approx(gap.recalibrated)
    assert gap.after == gap.recalibrated
    assert gap.ci95_after[0] < gap.after < gap.ci95_after[1]


def test_a_name_that_sweeps_left_out_do_not_bear_out_is_withdrawn() -> None:
    plain, late = (
        without(recording(hidden), "current") for hidden in (nothing, threshold(25.0))
    )
    spared = split(problem_of(late, MODEL, {})).runs
    runs = (
        bare if bare.name in spared else run
        for bare, run in zip(plain.runs, late.runs, strict=True)
    )
    told = _late(replace(late, runs=tuple(runs)))
    assert told.held_out == spared
    assert _names(told) == ["threshold_pressure"]
    assert _share(told) > 0.9
    assert told.verdict is Verdict.UNEXPLAINED
    assert told.gaps[Signal.FORCE].after == told.gaps[Signal.FORCE].recalibrated


def test_what_an_effect_does_not_touch_speaks_neither_for_nor_against_it(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """Play in a linkage, seen in two sweeps only, which cannot be spared."""
    monkeypatch.setattr(Gap, "confirms", lambda _gap, _effects, *, exact: exact)
    told = with_jaws(recording())
    seen = {"d", "f"}
    told = altered(told, moments().keys() - seen, "opening", lambda wide: wide * np.nan)
    told = altered(told, seen, "opening", lambda wide: play(wide, 2e-3, begin()))
    library = {"linkage_backlash": EFFECTS["linkage_backlash"]}
    found = diagnose(told, replace(MODEL, linkage=LINKAGE), {}, library)
    assert _names(found) == ["linkage_backlash"]
    assert Signal.OPENING not in found.gaps
    assert found.verdict is Verdict.NAMED


def test_a_name_that_spoils_another_signal_is_withdrawn(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    library = {"threshold_pressure": EFFECTS["threshold_pressure"]}
    whole = recording(threshold(25.0))
    assert diagnose(whole, MODEL, {}, library).verdict is Verdict.NAMED
    monkeypatch.setattr(
        Gap, "is_spoilt", property(lambda gap: gap.signal is Signal.PRESSURE)
    )
    assert diagnose(whole, MODEL, {}, library).verdict is Verdict.UNEXPLAINED


def test_a_constant_of_the_jaws_is_borne_out_by_the_jaws(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """Without an effect the story is about the force, which the jaws do not touch."""
    told = with_jaws(recording())
    wide = replace(LINKAGE, open_width=LINKAGE.open_width + 6e-3)
    model = replace(MODEL, linkage=wide)
    found = diagnose(told, model, {}, {})
    assert _names(found) == ["parameter:gripper.open_width"]
    assert found.main is Signal.FORCE
    monkeypatch.setattr(
        Gap,
        "confirms",
        lambda gap, _, *, exact: not exact or gap.signal is Signal.FORCE,
    )
    assert diagnose(told, model, {}, {}).verdict is not Verdict.NAMED


def _slipped(newtons: float, noise: float = 1.0) -> Diagnosis:
    """A force that jumps, with a drift as the only name for it."""
    order = ("b", "c", "b2", "d", "vented", "a", "e", "f")
    plain = without(recording(order=order, noise=noise), "current")
    slipped = altered(plain, order[4:], "force", lambda force: force - newtons)
    drift = {"force_sensor_drift": EFFECTS["force_sensor_drift"]}
    return diagnose(slipped, MODEL, {}, drift)


@pytest.mark.parametrize("newtons", [20.0, 40.0])
def test_a_small_jump_of_the_force_is_told_as_one(newtons: float) -> None:
    told = _slipped(newtons)
    assert told.verdict is Verdict.UNEXPLAINED
    assert any(word.startswith("force: jumps by -") for word in told.signature)


def test_a_force_that_jumps_once_is_not_named_a_drift() -> None:
    # Two sweeps where the line of a drift meets the step are left out and bear it out.
    told = _slipped(68.0, noise=0.8)
    assert _names(told) == ["force_sensor_drift"]
    assert _share(told) > 0.8
    assert told.named[0].heldout_gain > 0.8
    assert told.verdict is Verdict.UNEXPLAINED
    assert any(word.startswith("force: jumps by -") for word in told.signature)


def test_a_bore_that_its_tolerance_holds_back_is_told_beside_the_effect() -> None:
    built = replace(MODEL, muscle=replace(MODEL.muscle, diameter=0.0208))
    known = {"muscle.diameter": 1e-4, "muscle.braid_angle": 1.7e-3}
    loud = without(recording(restless(threshold(60.0))), "current")
    told = diagnose(loud, built, known, SHARP)
    assert _names(told) == ["threshold_pressure", "parameter:muscle.diameter"]
    diameter = told.named[1].parameters["diameter"]
    assert diameter.value == pytest.approx(0.02, abs=2e-4)


def test_what_is_named_needs_no_correction(told: Diagnosis) -> None:
    assert told.corrections == ()


def test_a_recording_in_two_units_gets_no_verdict() -> None:
    torn = altered(recording(), ("a", "c", "e", "b2"), "force", lambda f: 0.2248 * f)
    told = diagnose(torn, MODEL, {}, EFFECTS)
    assert told.verdict is Verdict.UNUSABLE
    (found,) = told.recording.contradictions
    assert {*found.runs, *found.others} <= {run.name for run in torn.runs}
    assert (told.named, told.where, told.gaps, told.main) == ((), (), {}, None)
    assert (told.proposal, told.signature, told.corrections) == (None, (), ())


def test_sweeps_beyond_the_search_are_judged_apart() -> None:
    # With four sweeps the last quarter of each is held out: d goes on beyond the rest.
    plain = without(recording(order=("vented", "a", "b", "d")), "current")
    up = replace(
        plain,
        runs=tuple(
            replace(
                run,
                columns={k: v[: len(run) // 2] for k, v in run.columns.items()},
            )
            if run.name == "d"
            else run
            for run in plain.runs
        ),
    )
    told = diagnose(up, MODEL, {}, {})
    assert told.extrapolation is not None
    assert "d (last quarter)" in told.extrapolation.runs
    assert not {*told.extrapolation.runs} & {*told.held_out}
    assert Signal.FORCE in told.extrapolation.gaps


def test_its_progress_rises() -> None:
    said: list[tuple[str, float]] = []
    diagnose(
        recording(),
        MODEL,
        {},
        {},
        progress=lambda what, share: said.append((what, share)),
    )
    shares = [share for _, share in said]
    assert shares == sorted(shares)
    assert shares[0] > 0.0
    assert shares[-1] < 1.0
    assert len({what for what, _ in said}) == len(said)


def test_nothing_to_compare_is_an_error_for_a_person() -> None:
    bare = without(recording(), "pressure", "contraction", "force")
    with pytest.raises(InputError):
        diagnose(bare, MODEL, {}, {})


def test_friction_of_the_linkage_is_found_from_the_files_on(tmp_path: Path) -> None:
    case = make_case(
        tmp_path,
        seed=3,
        family="A",
        kind="single",
        names=("linkage_friction",),
        strength=0.06,
    )
    file = load_model(case.model)
    library = {name: EFFECTS[name] for name in JAWS}
    told = diagnose(
        read_recording(case.recording), file.explanation(), file.tolerances, library
    )
    assert (told.verdict, _names(told)) == (Verdict.NAMED, ["linkage_friction"])
    assert told.main is Signal.GRIP
    gap = told.gaps[Signal.GRIP]
    assert gap.after < 1.2 * gap.noise_floor
    # As both cells are noisy, a tenth of what stood out is a third of its height.
    assert gap.closed > 0.91
    assert gap.noise_floor == pytest.approx(sensor_floors(case.truth)["grip"], rel=0.2)
    # The rig loses this share of the pull, of which a quarter reaches the jaws.
    effects = case.truth["effects"]
    assert isinstance(effects, list)
    lost = told.named[0].parameters["pull_loss"]
    assert lost.value == pytest.approx(effects[0]["amount"] / 4, abs=4 * lost.std)


def test_a_sensor_that_errs_is_judged_where_constants_leave_most() -> None:
    told = altered(recording(nothing), moments(), "pressure", lambda read: 1.06 * read)
    library = {name: EFFECTS[name] for name in ("pressure_sensor_gain",)}
    found = diagnose(told, MODEL, {}, library)
    assert [entry.name for entry in found.named] == ["pressure_sensor_gain"]
    assert found.verdict is Verdict.NAMED
    # Bore and angle take most of it from the force, and nothing from the pressure.
    assert found.main is Signal.PRESSURE


def test_where_nothing_is_missing_nothing_is_told_to_be_near_or_next(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """A name that sweeps left out do not bear out, and nothing else to be seen."""
    monkeypatch.setattr(Gap, "confirms", lambda _gap, _effects, *, exact: exact)
    monkeypatch.setattr(Gap, "is_open", False)
    weak = recording(threshold(6.0), noise=0.1)
    found = diagnose(weak, MODEL, {}, {name: EFFECTS[name] for name in FEW})
    assert found.verdict is Verdict.NONE
    assert found.contest.best.candidates
    text = document(found, model="m", program="p")
    assert (text["effects"], text["nearest"], text["next_experiment"]) == ([], [], None)


def test_where_something_slipped_it_is_never_nothing(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """Less is left than would be seen, but a jump explains it better than a name."""
    monkeypatch.setattr(Gap, "is_open", False)
    slip = Jump(size=-4.0, at=200.0)
    monkeypatch.setattr("gripperd.diagnose.diagnosis.artefact", lambda *_: slip)
    weak = recording(threshold(6.0), noise=0.1)
    found = diagnose(weak, MODEL, {}, {name: EFFECTS[name] for name in FEW})
    assert found.verdict is Verdict.UNEXPLAINED
    assert "force: jumps by -4.0 N at 200 s, and stays" in found.signature


@pytest.mark.parametrize(
    ("share", "verdict"), [(0.005, Verdict.NONE), (0.02, Verdict.UNEXPLAINED)]
)
def test_a_sensor_may_have_drifted_in_a_sweep_left_out(
    told: Diagnosis, share: float, verdict: Verdict
) -> None:
    """By 0.2 % of full scale (sd) common ones do, and nothing is missing for that."""
    off = share * told.split.train.full_scale[Signal.FORCE]
    drifted = altered(
        recording(nothing), told.held_out, "force", lambda force: force + off
    )
    found = diagnose(drifted, MODEL, {}, {})
    assert found.held_out == told.held_out
    assert found.gaps[Signal.FORCE].is_open
    assert found.verdict is verdict


def test_what_is_too_small_to_be_told_is_told_to_come_nearest(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """Of 1.3 kN friction of 5 N changes 0.8 %: were that what sensors drift."""
    for place in ("search.price", "verdict.signature"):
        monkeypatch.setattr(f"gripperd.diagnose.{place}.SEEN", 0.01)
    found = diagnose(recording(rubbing(5.0), noise=0.2), MODEL, {}, dict(EFFECTS))
    assert found.verdict is Verdict.UNEXPLAINED
    assert _names(found) == ["coulomb_friction"]
    assert found.told is found.found.null
    assert "they change no reading by 1.0% of full scale" in found.signature[2]
    assert "is sure to explain it" in summary(found)
    text = document(found, model="m", program="p")
    assert text["effects"] == []
    assert text["nearest"]


def test_what_is_unexplained_is_told_of_the_signal_in_which_it_shows() -> None:
    """A name for the force, whose gap it closes, and a pressure that no name has."""
    told = altered(
        recording(threshold(25.0)),
        moments(),
        "current",
        lambda current: current + 2e-4 * np.sin(1e4 * current),
    )
    found = _late(told)
    assert found.verdict is Verdict.UNEXPLAINED
    assert _names(found) == ["threshold_pressure"]
    assert found.main is Signal.PRESSURE


def test_a_late_cell_takes_its_loop_from_the_friction_at_rest() -> None:
    late = recording()
    for run in recording().runs:
        time = run.columns["time"]
        late = altered(late, [run.name], "force", partial(_later, time))
    library = LIBRARY | {"channel_delay": EFFECTS["channel_delay"]}
    found = diagnose(late, MODEL, {}, library)
    assert _names(found) == ["channel_delay"]
    parts = found.split.train, found.split.test
    assert {one.model.at_rest for one in parts} == {AtRest.CARRIED}


def _later(time: Array, force: Array) -> Array:
    return np.interp(time - 0.3, time, force)
