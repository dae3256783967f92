"""How much louder than its noise a signal is taken, so that misfit is no news.

References
----------
.. [1] R. T. Birge, "The calculation of errors by the method of least squares", Phys.
       Rev. 40(2), 207-227, 1932: uncertainties grow by the root of chi² per degree of
       freedom where a fit is worse than they allow.
"""

from collections.abc import Collection, Iterable, Mapping
from dataclasses import replace
from types import MappingProxyType

from gripperd.diagnose.fit.polish import Polished
from gripperd.diagnose.noise.model import Noise
from gripperd.diagnose.residuals.problem import Problem
from gripperd.model.effect import Signal

UNREACHED = 1.3
"""Mean square of whitened residuals above which the library does not reach the noise:
what is left is then taken for noise, or every constant would be torn. [-]"""


def birge_ratios(fit: Polished) -> dict[Signal, float]:
    """Mean square of what is left, whitened [1]_; 1 if little more than noise."""
    shares = {signal: fit.misfits[signal] / n for signal, n in fit.counts.items()}
    return {
        s: share if share > UNREACHED or share < 1 else 1.0
        for s, share in shares.items()
    }


def _least_ratios(fits: Iterable[Polished]) -> dict[Signal, float]:
    """Mean square that the best explanation of each signal leaves."""
    found: dict[Signal, float] = {}
    for fit in fits:
        for signal, here in birge_ratios(fit).items():
            found[signal] = min(found.get(signal, here), here)
    return found


def reached(
    inflated: Mapping[Signal, float], fits: Iterable[Polished]
) -> dict[Signal, float]:
    """How loud noises turn out that were inflated so, by the best of some fits."""
    found = {
        signal: inflated[signal] * share
        for signal, share in _least_ratios(fits).items()
    }
    return {
        signal: share if share > UNREACHED else 1.0 for signal, share in found.items()
    }


def louder(problem: Problem, inflations: Mapping[Signal, float]) -> Problem:
    """Give the problem with noise as loud as what no explanation reaches."""
    noises = dict(problem.noises)
    for signal, ratio in inflations.items():
        noise, factor = noises[signal], ratio**0.5
        noises[signal] = replace(
            noise, std=noise.std * factor, drift=noise.drift * factor
        )
    return replace(
        problem, noises=noises, inflations=MappingProxyType(dict(inflations))
    )


def plain(problem: Problem, signals: Collection[Signal]) -> Problem:
    """Give the problem with noise that has no memory in some signals.

    Where no explanation comes near the noise, its fine law says nothing about what is
    left, and every newton of misfit counts the same.
    """
    noises = {
        signal: Noise(noise.std, 0.0, 1e-3 * noise.std, noise.memory)
        if signal in signals
        else noise
        for signal, noise in problem.noises.items()
    }
    return replace(problem, noises=noises)


def deflated(problem: Problem, fit: Polished) -> Problem:
    """Give the problem with noise no louder than what an explanation leaves."""
    inflated = problem.inflations
    lower = {
        s: min(found, inflated[s]) for s, found in reached(inflated, [fit]).items()
    }
    shares = {signal: found / inflated[signal] for signal, found in lower.items()}
    return replace(louder(problem, shares), inflations=MappingProxyType(lower))
