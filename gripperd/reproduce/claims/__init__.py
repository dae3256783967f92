"""What the paper claims, and whether its own equations bear it out."""

from gripperd.model import Chain
from gripperd.reproduce.claims import figures, gripping
from gripperd.reproduce.claims.claim import Claim, Verdict
from gripperd.reproduce.paper import Paper

__all__ = ["Claim", "Verdict", "judge"]


def judge(chain: Chain) -> tuple[Claim, ...]:
    """Put every claim of the paper to the muscle of a chain."""
    paper = Paper(chain.muscle)
    return (
        figures.straight_lines(paper),
        figures.coincidence(paper),
        figures.coincidence_anywhere(paper),
        figures.more_pressure(paper),
        figures.rubber_and_pressure(paper),
        figures.rising_and_falling(paper),
        gripping.friction_is_a_force(paper),
        gripping.clamping(paper),
        gripping.the_current(chain),
    )
