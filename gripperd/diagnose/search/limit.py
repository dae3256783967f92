"""What an effect is called whose numbers lie where it is another effect."""

from gripperd.diagnose.fit.rival import Rival


def has_become(rival: Rival, other: Rival) -> bool:
    """Whether what is but in the first has become what is but in the other.

    Springs that slip at once are dry friction: a fit that chooses them says so, and its
    little lead over dry friction says how much that rounds off.
    """
    new = set(other.names) - set(rival.names)
    own = set(rival.names) - set(other.names)
    return any(
        effect.becomes in new
        for effect in rival.fit.point.effects
        if effect.name in own
    )
