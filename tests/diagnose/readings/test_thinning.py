import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from gripperd.diagnose.readings.recording import Kind, Recording
from gripperd.diagnose.readings.thinning import thinned
from gripperd.errors import InputError
from tests.diagnose.sweep import run


def _recording(*sizes: int) -> Recording:
    runs = [
        run(
            str(size),
            Kind.HOLD,
            force=np.arange(float(size)),
            time=np.arange(float(size)),
        )
        for size in sizes
    ]
    return Recording("rig", "abc", tuple(runs), remarks=("dusty",))


def test_neighbours_are_averaged_inside_runs() -> None:
    thin = thinned(_recording(6, 4), 5)
    assert [values.columns["force"].tolist() for values in thin.runs] == [
        [0.5, 2.5, 4.5],
        [0.5, 2.5],
    ]
    assert thin.runs[0].kind is Kind.HOLD
    assert thin.remarks[0] == "dusty"
    assert thin.remarks[1].startswith("10 rows were averaged to 5, 2 neighbours")


def test_a_rest_at_the_end_of_a_run_is_averaged_too() -> None:
    (only,) = thinned(_recording(7), 3).runs
    assert only.columns["force"].tolist() == [1.0, 4.0, 6.0]


def test_a_reading_that_is_not_believed_has_no_part_in_a_mean() -> None:
    recording = _recording(6)
    recording.runs[0].columns["force"][[1, 4, 5]] = np.nan
    (only,) = thinned(recording, 3).runs
    np.testing.assert_array_equal(only.columns["force"], [0.0, 2.5, np.nan])


def test_a_short_recording_stays_as_it_is() -> None:
    recording = _recording(6, 4)
    assert thinned(recording, 10) is recording


def test_runs_are_never_averaged_away() -> None:
    with pytest.raises(InputError, match="3 runs need as many rows; 2 are to remain"):
        thinned(_recording(5, 5, 5), 2)


@given(
    sizes=st.lists(st.integers(1, 60), min_size=1, max_size=8), most=st.integers(8, 90)
)
@settings(deadline=None, derandomize=True)
def test_no_more_rows_remain_than_asked_for_and_no_run_is_lost(
    sizes: list[int], most: int
) -> None:
    thin = thinned(_recording(*sizes), most)
    assert sum(len(values) for values in thin.runs) <= max(most, 0)
    assert all(len(values) >= 1 for values in thin.runs)
    whole = sum(np.arange(size).sum() for size in sizes)
    if sum(sizes) <= most:
        assert sum(values.columns["force"].sum() for values in thin.runs) == whole
