import numpy as np
import pytest

from gripperd.diagnose.noise.model import Noise
from gripperd.diagnose.noise.whitening import clock_of, law_of, whitened
from gripperd.model.track import Array
from tests.diagnose.small import STEP, covariance
from tests.diagnose.sweep import noise

EVEN = STEP * np.arange(70)
GAPPED = np.delete(EVEN, slice(30, 41))
LAWS = [
    pytest.param(Noise(2.0, 0.6, drift=1.5, memory=4.0), id="both"),
    pytest.param(Noise(2.0, 0.0, drift=1.5, memory=40.0), id="white and drift"),
    pytest.param(Noise(2.0, 0.6), id="autoregressive alone"),
    pytest.param(Noise(2.0, 0.4, drift=1.5, memory=9.0, white=0.5), id="all three"),
    pytest.param(Noise(0.5, 0.2, drift=30.0, memory=200.0), id="mostly drift"),
]
TIMES = [pytest.param(EVEN, id="even"), pytest.param(GAPPED, id="gapped")]


@pytest.mark.parametrize("law", LAWS)
@pytest.mark.parametrize("time", TIMES)
def test_innovations_of_the_noise_are_independent(time: Array, law: Noise) -> None:
    root = whitened(np.eye(time.size), time, law)
    white = root @ covariance(time, law) @ root.T
    np.testing.assert_allclose(white, np.eye(time.size), atol=1e-6)


@pytest.mark.parametrize("law", LAWS)
@pytest.mark.parametrize("time", TIMES)
def test_their_sum_of_squares_is_the_chi_square(time: Array, law: Noise) -> None:
    columns = np.column_stack([noise(time.size, 3.0, 1), time])
    white = whitened(columns, time, law)
    dense = columns.T @ np.linalg.solve(covariance(time, law), columns)
    np.testing.assert_allclose(white.T @ white, dense, rtol=1e-5)


@pytest.mark.parametrize("law", LAWS)
@pytest.mark.parametrize("time", TIMES)
def test_the_volume_is_half_the_log_determinant(time: Array, law: Noise) -> None:
    _, determinant = np.linalg.slogdet(covariance(time, law))
    volume = law_of(clock_of(time), law).log_scale
    assert volume == pytest.approx(0.5 * determinant, abs=1e-6)


def test_a_single_sample_is_scaled_by_the_floor() -> None:
    law = Noise(3.0, 0.5, drift=4.0)
    assert whitened(np.array([[10.0]]), np.zeros(1), law).item() == pytest.approx(2.0)
