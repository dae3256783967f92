"""What nobody could name, in words: what it depends on and what it does not."""

from gripperd.diagnose.conclude import Conclusion
from gripperd.diagnose.problem import Problem
from gripperd.diagnose.rivalry import Contest
from gripperd.diagnose.structure import Structure

CLEAR = 1e-6
"""Chance below which a dependence is told."""
LINE = 0.5
"""Share of one wave from which a dependence is called periodic. [-]"""


def signature(
    problem: Problem, best: Contest, conclusion: Conclusion
) -> tuple[str, ...]:
    """Describe what is left, most telling first."""
    words = [f"share of the gap that known effects explain: {conclusion.share:.0%}"]
    if best.best.names:
        words.append(f"nearest known effects: {', '.join(best.best.names)}")
    for signal in problem.signals:
        views = [one for one in conclusion.left if one.signal is signal]
        words += _told(signal.value, views)
    return tuple(words)


def _told(signal: str, views: list[Structure]) -> list[str]:
    clear = [one for one in views if one.p_value < CLEAR]
    if not clear:
        return []
    words = [
        f"{signal}: depends on {one.along}"
        + (", as one wave" if one.share > LINE else "")
        for one in clear
    ]
    plain = {one.along for one in clear}
    words += [
        f"{signal}: not on {one.along}"
        for one in views
        if one.p_value > 0.01 and one.along not in plain
    ]
    return words
