"""Sequentially thresholded least squares, as PySINDy does it.

S. L. Brunton, J. L. Proctor, J. N. Kutz, "Discovering governing equations from data by
sparse identification of nonlinear dynamical systems", PNAS 113(15), 3932-3937, 2016.
"""

import warnings

import numpy as np

from gripperd.model.track import Array


def stlsq(columns: Array, target: Array, threshold: float) -> Array:
    """Fit unit columns to a target in sigma; 0 for what falls below the threshold.

    The ridge is the default of PySINDy.

    Parameters
    ----------
    columns
        Shape ``(n, k)``.
    target
        Shape ``(n,)``.
    threshold
        Least coefficient that stays. [sigma]
    """
    from pysindy import STLSQ

    fit = STLSQ(threshold=threshold)
    with warnings.catch_warnings():
        # It warns when no term is left, which is an answer.
        warnings.simplefilter("ignore", UserWarning)
        fit.fit(columns, target[:, np.newaxis])
    return np.asarray(fit.coef_, np.float64).ravel()
