"""An object between the jaws: what it is, and how hard it is to be held."""

from dataclasses import dataclass, replace

from gripperd.control.profile import Profile
from gripperd.model import Chain, Direction, PressedObject
from gripperd.model.effect import acts_in_valve


@dataclass(frozen=True, slots=True, kw_only=True)
class Held:
    """What is held under which limits."""

    profile: Profile
    size: float
    """Opening at first contact, as measured or else as the profile says. [m]"""
    force: float | None = None
    """Force to keep, per jaw; None: the current was given, and stays. [N]"""
    travel: Direction = Direction.CONTRACTING
    """Direction of the last travel, for the sign of the friction."""

    @property
    def pressed(self) -> PressedObject:
        """The object as the model sees it."""
        return PressedObject(self.size, self.profile.stiffness)

    @property
    def sized(self) -> Profile:
        """Its profile, with the size that was measured."""
        return replace(self.profile, diameter=self.size)

    @property
    def least(self) -> float:
        """Least force per jaw to aim for. [N]."""
        return self.profile.slip_force * self.profile.slip_margin

    @property
    def most(self) -> float:
        """Highest force per jaw to aim for. [N]."""
        return self.profile.damage_force / self.profile.crush_margin

    def at(self, force: float | None, travel: Direction) -> "Held":
        """The same to be held with another force."""
        return replace(self, force=force, travel=travel)

    def pressure(self, muscle: Chain, force: float, travel: Direction) -> float:
        """Gauge pressure that gives a force on this object. [Pa].

        Parameters
        ----------
        muscle
            The model behind the valve, see :func:`behind_valve`.
        force
            Per jaw. [N]
        travel
            Direction of the last travel.

        Raises
        ------
        DomainError
            When the muscle cannot do that at any pressure.
        """
        opening = self.size - force / self.profile.stiffness
        current = muscle.current(force, opening, travel)
        return float(muscle.regulator.pressure(current))


def behind_valve(chain: Chain) -> Chain:
    """The chain with a valve that does what its line says: pressure to force."""
    kept = tuple(each for each in chain.effects if not acts_in_valve(each))
    return replace(chain, effects=kept)
