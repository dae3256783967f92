import numpy as np

from gripperd.diagnose.readings.recording import Rejection
from gripperd.diagnose.readings.screening import screened
from tests.diagnose.sweep import noise, pulled, run


def test_a_healthy_recording_loses_nothing() -> None:
    runs = [pulled(f"h{seed}", seed=seed) for seed in range(8)]
    believed, rejected = screened(runs)
    assert rejected == ()
    for before, after in zip(runs, believed, strict=True):
        for quantity, values in before.columns.items():
            assert (after.columns[quantity] == values).all()


def test_what_is_not_believed_is_blanked_and_nothing_else() -> None:
    sweep = pulled()
    force = sweep.columns["force"]
    force[[7, 30]] += 500
    pressure = sweep.columns["pressure"].copy()
    (after,), rejected = screened([sweep])
    assert np.flatnonzero(np.isnan(after.columns["force"])).tolist() == [7, 30]
    assert (after.columns["pressure"] == pressure).all()
    assert rejected == (Rejection("a", "force_N", 2, "spike"),)


def test_the_readings_handed_in_stay_as_they_are() -> None:
    current = np.r_[np.full(30, 8e-3), 0.0]
    screened([run(current=current)])
    assert current[-1] == 0.0


def test_a_dropout_is_named_after_its_cause_and_not_called_a_spike() -> None:
    pressure = 300e3 + noise(60, 1e3)
    pressure[20] = -150e3
    _, rejected = screened([run(pressure=pressure)])
    assert rejected == (Rejection("a", "pressure_kPa", 1, "under -101.33 kPa"),)


def test_two_freezes_of_one_channel_are_one_entry() -> None:
    sweep = pulled()
    force = sweep.columns["force"]
    force[50:65], force[300:330] = force[50], force[300]
    _, rejected = screened([sweep])
    assert rejected == (Rejection("a", "force_N", 45, "frozen value"),)


def test_a_freeze_that_shows_in_two_ways_is_counted_once() -> None:
    """Its noise stops, and it stands while the pressure moves."""
    sweep = pulled()
    force = sweep.columns["force"]
    force[60:160] = force[60]
    (after,), rejected = screened([sweep])
    assert np.isnan(after.columns["force"]).sum() == 100
    assert rejected == (Rejection("a", "force_N", 100, "frozen value"),)
