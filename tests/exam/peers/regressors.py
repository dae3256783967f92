"""The regressors that corrections are made of, each with its settings in one place."""

import warnings
from typing import Self

import numpy as np

from gripperd.model.track import Array
from tests.exam.peers.corrections import Regressor, corrected
from tests.exam.peers.exhibit import Exhibit, Guess
from tests.exam.peers.stlsq import stlsq

DEGREE = 3
SPARSE = 5.0
"""Coefficient of a unit column below which a term is dropped. [sigma]"""
TREES, LEAF = 100, 20
POINTS = 400
"""Samples of a Gaussian process, whose cost grows with their cube."""
SAMPLES = 2000
"""Samples of a symbolic regression."""
EVALUATIONS = 50_000
LONGEST = 25
"""Nodes of an expression."""


class Polynomial:
    """Sparse polynomial of PySINDy: STLSQ on all monomials of the regressors."""

    def __init__(self) -> None:
        from pysindy import PolynomialLibrary

        self._library = PolynomialLibrary(degree=DEGREE)
        self._coefficients: Array = np.empty(0)

    def fit(self, inputs: Array, outcome: Array) -> Self:
        """Choose terms."""
        self._library.fit(inputs)
        table = np.asarray(self._library.transform(inputs))
        lengths = np.linalg.norm(table, axis=0)
        noise = float(np.std(np.diff(outcome))) / 2**0.5
        chosen = stlsq(table / lengths, outcome / noise, SPARSE)
        self._coefficients = noise * chosen / lengths
        return self

    def predict(self, inputs: Array) -> Array:
        """Evaluate the terms."""
        return np.asarray(self._library.transform(inputs)) @ self._coefficients


class Process:
    """Gaussian process of scikit-learn: smooth, with white noise."""

    def __init__(self) -> None:
        from sklearn.gaussian_process import GaussianProcessRegressor

        self._process = GaussianProcessRegressor()

    def fit(self, inputs: Array, outcome: Array) -> Self:
        """Learn lengths, size and noise by marginal likelihood."""
        from sklearn.exceptions import ConvergenceWarning
        from sklearn.gaussian_process.kernels import RBF, ConstantKernel, WhiteKernel

        lengths = RBF(np.ones(inputs.shape[1]))
        self._process.set_params(kernel=ConstantKernel() * lengths + WhiteKernel())
        with warnings.catch_warnings():
            # A length at its bound means a regressor that does not matter.
            warnings.simplefilter("ignore", ConvergenceWarning)
            self._process.fit(inputs, outcome)
        return self

    def predict(self, inputs: Array) -> Array:
        """Predict the mean."""
        return np.asarray(self._process.predict(inputs))


class Thinned:
    """A regressor that learns from some of the samples."""

    def __init__(self, regressor: Regressor, samples: int, seed: int) -> None:
        self._regressor = regressor
        self._samples = samples
        self._seed = seed

    def fit(self, inputs: Array, outcome: Array) -> Self:
        """Learn from samples drawn at random."""
        random = np.random.default_rng(self._seed)
        some = random.permutation(outcome.size)[: self._samples]
        self._regressor.fit(inputs[some], outcome[some])
        return self

    def predict(self, inputs: Array) -> Array:
        """Predict every sample."""
        return np.asarray(self._regressor.predict(inputs), np.float64).ravel()


def polynomials(exhibit: Exhibit) -> Guess:
    """Sparse polynomials of degree 3."""
    return corrected(exhibit, lambda _seed: Polynomial())


def symbolic(exhibit: Exhibit) -> Guess:
    """Symbolic regression by Operon, its model chosen by description length."""
    return corrected(exhibit, _operon)


def forest(exhibit: Exhibit) -> Guess:
    """Random forest."""
    return corrected(exhibit, _forest)


def gaussian_process(exhibit: Exhibit) -> Guess:
    """Gaussian process with a length for every regressor."""
    return corrected(exhibit, _gaussian_process)


def _operon(seed: int) -> Regressor:
    from pyoperon.sklearn import SymbolicRegressor

    operon = SymbolicRegressor(
        allowed_symbols="add,sub,mul,div,exp,log,sin,tanh,abs,constant,variable",
        max_length=LONGEST,
        max_evaluations=EVALUATIONS,
        optimizer_iterations=1,
        n_threads=1,
        random_state=seed,
    )
    return Thinned(operon, SAMPLES, seed)


def _forest(seed: int) -> Regressor:
    from sklearn.ensemble import RandomForestRegressor

    forest: Regressor = RandomForestRegressor(
        TREES, min_samples_leaf=LEAF, random_state=seed
    )
    return forest


def _gaussian_process(seed: int) -> Regressor:
    return Thinned(Process(), POINTS, seed)
