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
from gripperd.model.effect import GripperEffect
from gripperd.model.loaded import LoadedLinkage

REST_SPEED = 1e-9
"""Slower than this is standing still: the jaws settle within 25 ms at that point, so
0.03 nm are left to go. [m/s]"""


class Jaws:
    """Where the jaws are, how fast, and how hard they press.

    Parameters
    ----------
    linkage
        Between muscle and jaws.
    settings
        The dynamics.
    effects
        What rubs and bends in the gripper. In the stretch of a series compliance the
        share that the joints keep is left out.
    """

    __slots__ = (
        "_bending",
        "_closing_stiffness",
        "_contact",
        "_linkage",
        "_loaded",
        "_lost",
        "_object",
        "_opening_stiffness",
        "_passed",
        "_ratio",
        "_series",
        "_settings",
        "_stiffens",
        "_stiffness",
        "_stop",
        "_touch",
        "direction",
        "grip",
        "shortening",
        "velocity",
    )

    def __init__(
        self,
        linkage: Linkage,
        settings: PlantSettings,
        effects: tuple[GripperEffect, ...] = (),
    ) -> None:
        self._linkage = linkage
        self._settings = settings
        self._loaded = loaded = LoadedLinkage(linkage, effects)
        self._stiffens = loaded.stiffens
        self._passed = {way: float(loaded.passed(way)) for way in Direction}
        self._lost = 0.0
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
        yielding = self._series * self._spring + self._bending * self.grip
        return self.straight + self._lost + yielding

    @property
    def pull(self) -> float:
        """Pull of a muscle that holds the jaws where they are. [N]."""
        return float(self._loaded.pull(self.grip, self._spring, self.direction))

    @property
    def _spring(self) -> float:
        return (
            self._linkage.spring_preload + self._linkage.spring_rate * self.shortening
        )

    @property
    def straight(self) -> float:
        """Distance between the jaws without play or load. [m]."""
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
        self._object = diameter, stiffness
        self._bend()

    def _bend(self) -> None:
        """Take the stiffness of what bends as it is at the present loads."""
        linkage, loaded = self._linkage, self._loaded
        diameter, stiffness = self._object
        pull = self._spring + linkage.ratio * self.grip
        self._series = series = float(loaded.series_compliance(pull))
        jaws = float(loaded.jaw_compliance(self.grip))
        self._bending = jaws + series * linkage.ratio
        # Closing per shortening, with the stretch that the return spring costs.
        self._ratio = linkage.ratio - series * linkage.spring_rate
        stretched = series * linkage.spring_preload
        self._contact = inf
        if stiffness:
            self._contact = linkage.open_width + stretched - diameter
        in_series = stiffness / (1 + stiffness * self._bending)
        self._stiffness = in_series * self._ratio * linkage.ratio
        closing, opening = (
            float(loaded.joints(self._stiffness, way))
            for way in (Direction.CONTRACTING, Direction.EXTENDING)
        )
        self._closing_stiffness, self._opening_stiffness = closing, opening
        self.lose(self._lost)

    def lose(self, motion: float) -> None:
        """Let the jaws stand apart by more than linkage and load say. [m]."""
        self._lost = motion
        self._touch = (self._contact + motion) / self._ratio
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
        linkage, passed = self._linkage, self._passed
        contracting *= passed[Direction.CONTRACTING]
        extending *= passed[Direction.EXTENDING]
        start = self.shortening
        push = (
            self.velocity * self._settings.moving_mass / dt
            - linkage.spring_preload
            - linkage.spring_rate * start
        )
        velocity = self._velocity(push + contracting, self._closing_stiffness, dt)
        if velocity < REST_SPEED:
            velocity = self._velocity(push + extending, self._opening_stiffness, dt)
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
        if self._stiffens:
            self._bend()

    def _grip(self) -> float:
        depth = self.shortening - self._touch
        return depth * self._stiffness / self._linkage.ratio if depth > 0.0 else 0.0

    def _velocity(self, force: float, stiffness: float, dt: float) -> float:
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
        force -= stiffness * depth
        loss = stiffness * settings.pad_loss
        if depth < 0.0:
            # The pads resist only that part of the step which lies in the object.
            force -= loss * depth / dt
        return force / (resistance + stiffness * dt + loss)
