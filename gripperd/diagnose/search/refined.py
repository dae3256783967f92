"""An outcome of which every explanation is given a further liberty alike."""

from collections.abc import Callable

from gripperd.diagnose.fit.rival import Rival
from gripperd.diagnose.search.found import Found
from gripperd.diagnose.search.rivalry import Contest, Place, standing_in


def refined(
    found: Found, best: Contest, told: Rival, alike: Callable[[Rival], Rival]
) -> Contest:
    """Give the outcome with the best as told, and all that it was held against.

    Parameters
    ----------
    found, best
        The search and its outcome.
    told
        The best explanation, with the liberty.
    alike
        Gives any other the same one; itself where that changes nothing.
    """
    if told is best.best:
        return best
    places = tuple(
        Place(alike(place.without), tuple(alike(one) for one in place.rivals))
        for place in best.places
    )
    return standing_in(found, Contest(told, places))
