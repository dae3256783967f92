"""What a model leaves open and the recording decided: no effect, but to be known."""

from collections.abc import Iterator
from dataclasses import replace

from gripperd.diagnose.readings.recording import Recording
from gripperd.diagnose.residuals.explanation import AtRest, Explanation
from gripperd.diagnose.residuals.point import Point
from gripperd.diagnose.residuals.problem import Problem

TURNS = {
    AtRest.INFLATING: "turns with the pressure",
    AtRest.YIELDING: "yields a while and turns with the pressure",
    AtRest.BLADDER: "of the braid turns with the pressure, any other stays as it came",
}
"""What friction does where nothing travels, unless it stays as it came there."""


def with_conventions(recording: Recording, problem: Problem, point: Point) -> Recording:
    """Say how a recording was read where its model leaves a choice.

    Parameters
    ----------
    recording
        What was diagnosed.
    problem, point
        As it was searched, and with what was found.
    """
    told = (*_at_rest(problem.explanation(point)), *_of_regulator(problem))
    return replace(recording, remarks=(*recording.remarks, *told))


def _at_rest(model: Explanation) -> Iterator[str]:
    if not any(effect.turns == "contraction" for effect in model.effects):
        return
    ways = [TURNS[model.at_rest]] if model.at_rest in TURNS else []
    if model.winding:
        ways = [f"turns with what a frame yields, {model.winding:.2%} either way"]
    if model.fading:
        ways.append(f"fades, by e in {model.fading:g} s")
    if ways:
        yield f"Where nothing travels, dry friction {', and '.join(ways)}."


def _of_regulator(problem: Problem) -> Iterator[str]:
    if problem.model.vents is not None:
        yield "Asked for nothing, the regulator vents, whatever its line says."
    if problem.band:
        width = problem.band / 1e3
        yield f"Within {width:.1f} kPa of its command the regulator sleeps."
