"""Constants of a model as a recording has them, beside what was found."""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from gripperd.diagnose.fit.rival import Rival
from gripperd.diagnose.residuals.constants import Constant
from gripperd.diagnose.residuals.problem import Problem
from gripperd.diagnose.verdict.key import Key, key_of


@dataclass(frozen=True, slots=True)
class Recalibrated:
    """A constant that has a name for users, in the unit of its key."""

    constant: Constant
    key: Key
    model: float
    """As the model had it."""
    tolerance: float
    """One sigma, stated or assumed."""
    fit: float
    """As the recording has it."""
    std: float
    """Standard deviation of that."""

    @property
    def moved(self) -> float:
        """From the model to the fit, in tolerances. [-]."""
        return (self.fit - self.model) / self.tolerance


def recalibrated(problem: Problem, told: Rival) -> Iterator[Recalibrated]:
    """Give the constants of the model, as they came and as they fit.

    Parameters
    ----------
    problem
        Whose constants they are.
    told
        The explanation that was fitted with them.
    """
    point, covariance = told.fit.point, told.fit.posterior
    stds = np.sqrt(np.diag(covariance)[: point.shifts.size]) * point.widths
    for constant, shift, std in zip(
        problem.constants, point.shifts.tolist(), stds.tolist(), strict=True
    ):
        if (key := key_of(constant.path)) is not None:
            scale = constant.sigma / key.factor
            model = constant.nominal / key.factor
            yield Recalibrated(
                constant, key, model, scale,
                constant.value(shift) / key.factor, std * scale,
            )  # fmt: skip
