"""What comes nearest where nothing is sure enough to be told."""

from gripperd.diagnose.search.found import Found
from gripperd.diagnose.search.rivalry import Contest, Place


def nearest_of(found: Found) -> Contest:
    """Give the likeliest single explanation that noise alone does not reach, or none.

    It may change no reading by as much as sensors drift, and so be told by no search.

    Parameters
    ----------
    found
        The search.
    """
    least = found.null.evidence + found.threshold
    alone = [
        rival
        for rival in found.rivals
        if len(rival.candidates) == 1 and rival.evidence > least
    ]
    if not alone:
        return Contest(found.null)
    best = max(alone, key=lambda rival: rival.evidence)
    return Contest(best, (Place(found.null),))
