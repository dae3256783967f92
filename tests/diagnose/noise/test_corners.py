import numpy as np

from gripperd.diagnose.noise.smoothing import STIFFNESSES, smooth
from tests.diagnose.sweep import noise

STEP = 0.1
TIME = np.arange(0.0, 40.0, STEP)


def test_a_trend_that_may_break_goes_straight_from_corner_to_corner() -> None:
    true = np.interp(TIME % 8.0, [0.0, 2.0, 6.0, 8.0], [0.0, 50.0, 50.0, 0.0])
    column = true + noise(TIME.size, 1.0)
    plain, broken = smooth(TIME, column, 1.0), smooth(TIME, column, 1.0, breaks=True)
    assert broken.likelihood > plain.likelihood
    rms = [np.sqrt(np.mean((one.value - true) ** 2)) for one in (plain, broken)]
    assert rms[1] < 0.7 * rms[0]


def test_a_line_has_no_corner() -> None:
    column = 3.0 * TIME + noise(TIME.size, 1.0)
    plain, broken = smooth(TIME, column, 1.0), smooth(TIME, column, 1.0, breaks=True)
    assert broken.likelihood <= plain.likelihood + 1e-9
    np.testing.assert_allclose(broken.value, plain.value, atol=1e-9)


def test_a_curve_that_is_quieter_than_told_is_no_row_of_legs() -> None:
    # Pressure of a vessel, up and down again, read to within a hundredth.
    since = TIME % 5.0
    settling = 500.0 * (1 - np.exp(-since / 0.8)) * np.cos(since)
    column = settling + noise(TIME.size, 0.01)
    assert smooth(TIME, column, 1e-4, breaks=True).likelihood == -np.inf


def test_corners_lie_where_the_slope_changes() -> None:
    true = np.interp(TIME, [0.0, 15.0, 25.0, 40.0], [0.0, 150.0, 150.0, 0.0])
    found = smooth(
        TIME, true + noise(TIME.size, 1.0), 1.0, breaks=True, tried=STIFFNESSES
    )
    slopes = np.interp(TIME, [14.0, 16.0, 24.0, 26.0], [10.0, 0.0, 0.0, -10.0])
    apart = (np.abs(TIME - 15.0) > 1.0) & (np.abs(TIME - 25.0) > 1.0)
    np.testing.assert_allclose(found.rate[apart], slopes[apart], atol=1.0)
