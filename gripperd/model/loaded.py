"""The linkage as it is: joints that rub, and parts that bend under the load."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from gripperd.errors import DomainError
from gripperd.model.effect import GripperEffect
from gripperd.model.linkage import Linkage
from gripperd.model.real import Real, positive_part
from gripperd.model.root import falling_root, falling_roots

LEAST = 1e-6
"""Load at which a part gives as it does without any. [N]"""
LOOKS = 8
"""At the pull in a stretch that stiffens: each leaves a sixteenth, in the softest there
is, of what the one before was off by."""


@dataclass(frozen=True, slots=True)
class LoadedLinkage:
    r"""A linkage with the effects that act in the gripper, settled.

    The opening is

    .. math:: w = w_0 - r L h + c_j N + c_s F, \quad
              N = k (F - F_{spring}) / r - q F

    with the compliances of jaws and series at these loads, the share k that the joints
    leave of the grip, and q that they take of the pull. Inside a stretch that the
    length takes in, the muscle is shorter than h, see :meth:`inside`.
    """

    linkage: Linkage
    effects: tuple[GripperEffect, ...]

    def jaw_compliance(self, grip: Real) -> Real:
        """Opening per grip force of each jaw, at one. [m/N]."""
        load = np.fmax(grip, LEAST)
        return self._widening(load, 0.0 * load) / load

    def series_compliance(self, pull: Real) -> Real:
        """Opening per pull of the muscle, at one. [m/N]."""
        load = np.fmax(pull, LEAST)
        return self._widening(0.0 * load, load) / load

    @property
    def stiffens(self) -> bool:
        """Whether anything that bends gives less the more of its load there is."""
        return any(effect.stiffens for effect in self.effects)

    def contraction(
        self, opening: Real, grip: Real, direction: Real, rest_length: float
    ) -> Real:
        """Contraction at which the jaws are this far apart under a grip force. [-].

        Parameters
        ----------
        opening
            Distance between the jaws. [m]
        grip
            Force of each jaw. [N]
        direction
            Direction of travel, or of the last travel when at rest.
        rest_length
            Of the muscle. [m]
        """
        linkage = self.linkage
        pressing = positive_part(grip)
        bent = opening - self._widening(pressing, 0.0 * pressing)
        straight = linkage.contraction(bent, rest_length)
        spring = linkage.spring_force(straight, rest_length)
        pull = stretching = self.pull(grip, spring, direction)
        rate = linkage.spring_rate / self.passed(direction)
        shorter: Real = 0.0
        for _ in range(LOOKS if self.stiffens else 1):
            series = self.series_compliance(stretching)
            shorter = series * pull / (linkage.ratio - series * rate)
            stretching = pull + rate * shorter
        return straight + shorter / rest_length

    def pull(self, grip: Real, spring: Real, direction: Real) -> Real:
        """Pull of the muscle that holds a grip force against the spring. [N].

        Raises
        ------
        DomainError
            The joints take all that the muscle pulls with.
        """
        joints = self.joints(grip, direction) * self.linkage.ratio
        return (joints + spring) / self.passed(direction)

    def inside(self, contraction: Real, pull: Real) -> Real:
        """Contraction of the muscle itself, where that of the whole is told. [-]."""
        pulling = positive_part(pull)
        return contraction + sum(
            (effect.hidden_contraction(pulling) for effect in self.effects), 0.0
        )

    def joints(self, grip: Real, direction: Real) -> Real:
        """Grip force before the joints take their share. [N]."""
        return grip / self._kept(direction)

    def passed(self, direction: Real) -> Real:
        """Share of the pull that comes through joints which carry it. [-].

        Raises
        ------
        DomainError
            None comes through: they lock.
        """
        taken = self._taken(direction)
        coming = self._kept(direction) / self.linkage.ratio
        share = 1 - taken / coming
        if np.any(np.less_equal(share, 0)):
            message = (
                "the friction of the joints takes all that the muscle pulls with:"
                f" pull_loss is {np.max(taken):g}, and {np.min(coming):.3g} of the pull"
                " comes to each jaw"
            )
            raise DomainError(message, key="pull_loss")
        return share

    def grip_force(
        self,
        tension: Callable[[Real], Real],
        opening: Real,
        direction: Real,
        rest_length: float,
    ) -> Real:
        """Force of each jaw with the jaws held at an opening, signed. [N].

        The muscle has to shorten more the harder the grip, and pulls the less for it:
        the balance is the root of a falling function.

        Parameters
        ----------
        tension
            Pull of the muscle at a contraction. [N]
        opening
            Distance between the jaws. [m]
        direction
            Direction of travel, or of the last travel when at rest.
        rest_length
            Of the muscle. [m]
        """
        kept, taken = self._kept(direction), self._taken(direction)
        linkage = self.linkage

        def surplus(grip: Real) -> Real:
            contraction = self.contraction(opening, grip, direction, rest_length)
            spring = linkage.spring_force(contraction, rest_length)
            held = self.pull(grip, spring, direction)
            pull = tension(self.inside(contraction, held))
            return kept * (pull - spring) / linkage.ratio - taken * pull - grip

        shut = self.contraction(opening, 0.0, direction, rest_length)
        slack = kept * self.linkage.grip_force(0.0, shut, rest_length)
        rigid = positive_part(surplus(0.0))
        if isinstance(rigid, np.ndarray):
            return falling_roots(surplus, slack + 0.0 * rigid, rigid)
        return falling_root(lambda n: float(surplus(n)), float(slack), rigid)

    def _kept(self, direction: Real) -> Real:
        share: Real = 1.0
        for effect in self.effects:
            share = effect.transmitted(share, direction)
        return share

    def _taken(self, direction: Real) -> Real:
        """Grip force that joints take per pull of the muscle. [-]."""
        return sum((effect.taken(1.0, direction) for effect in self.effects), 0.0)

    def _widening(self, grip: Real, pull: Real) -> Real:
        return sum((effect.widening(grip, pull) for effect in self.effects), 0.0 * grip)
