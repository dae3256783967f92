"""What is done about a held object between commands: nothing, or small corrections."""

from gripperd.control.force_loop import SLOW
from gripperd.control.grasp import TRIP_MARGIN
from gripperd.control.held import Held
from gripperd.control.regulation import Regulation, RegulationState
from gripperd.control.trust import Level
from gripperd.errors import DomainError
from gripperd.model import Chain
from gripperd.signals import Measurement


class Keep:
    """The object that is held, and the loop that keeps its force where allowed.

    Corrections take a profile that allows them and a force to keep. They are bounded
    by the profile's share of the pressure, counted from the end of the command, and
    move by at most that share in :data:`~gripperd.control.force_loop.SLOW`.
    """

    def __init__(self) -> None:
        self.held: Held | None = None
        self._regulation: Regulation | None = None

    def begin(self, held: Held | None) -> None:
        """From now on this is held; None: nothing is, or nobody knows what."""
        self.held = held
        self._regulation = None

    def leave(self) -> None:
        """Leave the current alone: someone else has set it."""
        if self.held is not None:
            self.begin(self.held.at(None, self.held.travel))

    def step(
        self, measured: Measurement, chain: Chain, current: float, dt: float
    ) -> float:
        """Current after a period without a command. [A].

        Parameters
        ----------
        measured
            The newest measurement.
        chain
            The model of the gripper.
        current
            As it is. [A]
        dt
            Time since the last step. [s]
        """
        held = self.held
        if held is None or held.force is None or not held.profile.compensate:
            return current
        try:
            regulation = self._regulation or self._begin(held, measured, chain, current)
            asked = regulation.step(measured, dt)
            force = measured.grip.value
            if force is not None and force > held.profile.damage_force / TRIP_MARGIN:
                asked = regulation.reduce()
        except DomainError:
            # The model has no answer here; the grip is as good as it was.
            self.leave()
            return current
        self.held = regulation.held
        return asked

    def pause(self) -> None:
        """Go on later from whatever the current is by then."""
        self._regulation = None

    def state(self, measured: Measurement | None) -> RegulationState | None:
        """Snapshot for whoever asks; None while nothing is known to be held."""
        if self._regulation is not None:
            return self._regulation.state
        if self.held is None or measured is None:
            return None
        return RegulationState(
            level=Level.MANUAL if self.held.force is None else Level.MODEL,
            quality=measured.grip.quality,
            cause=measured.grip.cause,
            wanted=self.held.force,
            correction=0.0,
            most=0.0,
        )

    def _begin(
        self, held: Held, measured: Measurement, chain: Chain, current: float
    ) -> Regulation:
        self._regulation = Regulation(
            held, chain, current, felt=measured.grip.value, closed=SLOW
        )
        return self._regulation
