"""How much louder than its noise a recording is taken, so that misfit is no news."""

from dataclasses import replace

from gripperd.diagnose.noise import Noise
from gripperd.diagnose.polish import Polished
from gripperd.diagnose.problem import Problem

HOT = 1.3
"""Mean square of whitened residuals above which the library does not reach the noise:
what is left is then taken for noise, or every constant would be torn. [-]"""


def temperature_of(fit: Polished) -> float:
    """Mean square of what is left, whitened; 1 when it is the noise alone."""
    share = sum(fit.misfits.values()) / fit.samples
    return share if share > HOT or share < 1 else 1.0


def louder(problem: Problem, temperature: float) -> Problem:
    """Give the problem with noise as loud as what no explanation reaches."""
    factor = temperature**0.5
    noises = {
        signal: Noise(
            noise.std * factor, noise.correlation, noise.drift * factor, noise.memory
        )
        for signal, noise in problem.noises.items()
    }
    return replace(problem, noises=noises, temperature=temperature)


def plain(problem: Problem) -> Problem:
    """Give the problem with noise that has no memory.

    Where no explanation comes near the noise, its fine law says nothing about what is
    left, and every newton of misfit counts the same.
    """
    noises = {
        signal: Noise(noise.std, 0.0, 1e-3 * noise.std, noise.memory)
        for signal, noise in problem.noises.items()
    }
    return replace(problem, noises=noises)
