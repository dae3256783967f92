"""How much louder than its noise a signal is taken, so that misfit is no news."""

from collections.abc import Collection, Iterable, Mapping
from dataclasses import replace
from types import MappingProxyType

from gripperd.diagnose.fit.polish import Polished
from gripperd.diagnose.noise.model import Noise
from gripperd.diagnose.residuals.problem import Problem
from gripperd.model.effect import Signal

HOT = 1.3
"""Mean square of whitened residuals above which the library does not reach the noise:
what is left is then taken for noise, or every constant would be torn. [-]"""


def temperatures_of(fit: Polished) -> dict[Signal, float]:
    """Mean square of what is left, whitened; 1 where it is little more than noise."""
    shares = {signal: fit.misfits[signal] / n for signal, n in fit.counts.items()}
    return {
        s: share if share > HOT or share < 1 else 1.0 for s, share in shares.items()
    }


def _coolest(fits: Iterable[Polished]) -> dict[Signal, float]:
    """Mean square that the best explanation of each signal leaves."""
    found: dict[Signal, float] = {}
    for fit in fits:
        for signal, here in temperatures_of(fit).items():
            found[signal] = min(found.get(signal, here), here)
    return found


def reached(
    warm: Mapping[Signal, float], fits: Iterable[Polished]
) -> dict[Signal, float]:
    """How loud noises that were taken so warm turn out, by the best of some fits."""
    found = {signal: warm[signal] * share for signal, share in _coolest(fits).items()}
    return {signal: share if share > HOT else 1.0 for signal, share in found.items()}


def louder(problem: Problem, temperatures: Mapping[Signal, float]) -> Problem:
    """Give the problem with noise as loud as what no explanation reaches."""
    noises = dict(problem.noises)
    for signal, temperature in temperatures.items():
        noise, factor = noises[signal], temperature**0.5
        noises[signal] = Noise(
            noise.std * factor, noise.correlation, noise.drift * factor, noise.memory
        )
    return replace(
        problem, noises=noises, temperatures=MappingProxyType(dict(temperatures))
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


def cooled(problem: Problem, fit: Polished) -> Problem:
    """Give the problem with noise no louder than what an explanation leaves."""
    warm = problem.temperatures
    cooler = {s: min(found, warm[s]) for s, found in reached(warm, [fit]).items()}
    shares = {signal: found / warm[signal] for signal, found in cooler.items()}
    return replace(louder(problem, shares), temperatures=MappingProxyType(cooler))
