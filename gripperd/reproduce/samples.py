"""Table 1 of the paper: four objects held at one valve current."""

from dataclasses import dataclass

from gripperd.model import Chain, Prediction, PressedObject

PAPER_CURRENT = 0.0107
"""Valve current that held all four samples, found by trial. [A]"""


@dataclass(frozen=True, slots=True)
class Sample:
    """One object of Table 1."""

    name: str
    diameter: float
    """Size between the jaws. [m]"""
    reported: str = "clamped"
    """What the paper says became of it; no force was measured."""


SAMPLES = (
    Sample("apple", 0.065),
    Sample("peach", 0.058),
    Sample("raw egg", 0.041),
    Sample("grape", 0.022),
)


@dataclass(frozen=True, slots=True)
class Grasp:
    """A sample with what the model says about holding it."""

    sample: Sample
    prediction: Prediction


def table_1(chain: Chain) -> tuple[Grasp, ...]:
    """Predict the grip on each sample, taken as rigid, at the paper's current.

    Raises
    ------
    DomainError
        When a sample does not fit between the jaws of this chain.
    """
    return tuple(
        Grasp(sample, chain.predict(PAPER_CURRENT, PressedObject(sample.diameter)))
        for sample in SAMPLES
    )
