"""The jaws on the muscle: mass, damping, dry friction, stops and contact.

All forces are taken to the muscle: with the opening ``w = w0 - r x`` a stiffness k
between the jaws is ``r² k`` there. Each step is implicit in speed, load and friction
(time stepping after Moreau), so that no step is too long for a stiff object.

References
----------
.. [1] J. J. Moreau, "Unilateral contact and dry friction in finite freedom dynamics",
       in Nonsmooth Mechanics and Applications, CISM 302, Springer, 1988.
"""

from math import inf

from gripperd.bench.settings import PlantSettings
from gripperd.model import Direction, Linkage

REST_SPEED = 1e-9
"""Slower than this is standing still: the jaws settle within 25 ms at that point, so
0.03 nm are left to go. [m/s]"""


class Jaws:
    """Where the jaws are, how fast, and how hard they press."""

    __slots__ = (
        "_linkage",
        "_settings",
        "_stiffness",
        "_stop",
        "_touch",
        "direction",
        "grip",
        "shortening",
        "velocity",
    )

    def __init__(self, linkage: Linkage, settings: PlantSettings) -> None:
        self._linkage = linkage
        self._settings = settings
        self._stop = linkage.open_width / linkage.ratio
        self.shortening = 0.0
        """Of the muscle; the jaws start at the open stop. [m]"""
        self.velocity = 0.0
        """Rate of the shortening. [m/s]"""
        self.direction = Direction.EXTENDING
        """Direction of the last travel; the spring has opened the jaws."""
        self.grip = 0.0
        """Force of each jaw on the object; it is that of the deformation, without the
        loss in the pads, which lasts 2 ms. [N]"""
        self.face(inf, 0.0)

    @property
    def opening(self) -> float:
        """Distance between the jaws. [m]."""
        return self._linkage.open_width - self._linkage.ratio * self.shortening

    def face(self, diameter: float, stiffness: float) -> None:
        """Put something between the jaws; a stiffness of 0 takes it away.

        Parameters
        ----------
        diameter
            Opening at first contact. [m]
        stiffness
            Grip force per jaw for a metre of yielding. [N/m]
        """
        ratio = self._linkage.ratio
        self._touch = (self._linkage.open_width - diameter) / ratio
        self._stiffness = stiffness * ratio * ratio
        if not stiffness:
            self._touch = inf
        self.grip = self._grip()

    def step(self, contracting: float, extending: float, dt: float) -> None:
        """Move for a time.

        Parameters
        ----------
        contracting, extending
            Pull of the muscle in each direction of travel, less and plus dry
            friction; in between the jaws stick. [N]
        dt
            [s]
        """
        linkage = self._linkage
        start = self.shortening
        push = (
            self.velocity * self._settings.moving_mass / dt
            - linkage.spring_preload
            - linkage.spring_rate * start
        )
        velocity = self._velocity(push + contracting, dt)
        if velocity < REST_SPEED:
            velocity = self._velocity(push + extending, dt)
            if velocity > -REST_SPEED:
                self.velocity = 0.0
                return
        end = start + velocity * dt
        if not 0.0 < end < self._stop:
            end = 0.0 if end <= 0.0 else self._stop
            velocity = 0.0
        if end != start:
            self.direction = (
                Direction.CONTRACTING if end > start else Direction.EXTENDING
            )
        self.velocity = velocity
        self.shortening = end
        self.grip = self._grip()

    def _grip(self) -> float:
        depth = self.shortening - self._touch
        return depth * self._stiffness / self._linkage.ratio if depth > 0.0 else 0.0

    def _velocity(self, force: float, dt: float) -> float:
        """Speed at the end of a step; `force` is what acts if the jaws stay. [m/s]."""
        settings = self._settings
        resistance = (
            settings.moving_mass / dt
            + settings.damping
            + self._linkage.spring_rate * dt
        )
        velocity = force / resistance
        depth = self.shortening - self._touch
        if depth + velocity * dt <= 0.0:
            return velocity
        force -= self._stiffness * depth
        loss = self._stiffness * settings.pad_loss
        if depth < 0.0:
            # The pads resist only that part of the step which lies in the object.
            force -= loss * depth / dt
        return force / (resistance + self._stiffness * dt + loss)
