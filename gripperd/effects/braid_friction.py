"""Dry friction between bladder and braid, eq. (6), in both readings.

References
----------
.. [1] "Study on static characteristics of pneumatic muscles", eq. (6).
.. [2] B. Tondu, "Modelling of the McKibben artificial muscle: a review", J. Intell.
       Mater. Syst. Struct. 23(3), 225-253, 2012, eq. (33): friction of contact
       pressure on the braid's surface (after Schulte, 1961).
"""

from dataclasses import dataclass
from enum import StrEnum
from typing import ClassVar

from gripperd.model import Muscle, MuscleState
from gripperd.model.kinds import InMuscle
from gripperd.model.parameter import amplitude
from gripperd.model.real import Real, positive_part


class Form(StrEnum):
    """Where the closing brace of eq. (6) stands."""

    REBRACED = "rebraced"
    """Dimensionally sound: contact pressure times area times μ."""
    AS_PRINTED = "as_printed"
    """As in the paper. It adds N/m to N, so it holds in SI units only."""


@dataclass(frozen=True, slots=True)
class BraidFriction(InMuscle):
    """Friction against the direction of travel, growing with pressure and area.

    A share ``k`` of eq. (6): a coefficient of friction is seldom known before.

    Shows in data as a loop in contraction whose width grows with pressure.
    """

    name: ClassVar[str] = "braid_friction"
    needs: ClassVar[frozenset[str]] = frozenset({"force", "pressure", "contraction"})
    shows: ClassVar[str] = (
        "a loop between force and contraction whose width grows with pressure and area"
    )
    confused_with: ClassVar[tuple[str, ...]] = ("pressure_friction", "coulomb_friction")
    remedy: ClassVar[str] = "add the friction between bladder and braid to the model"
    turns: ClassVar[str] = "contraction"
    form: Form = Form.REBRACED
    share: float = amplitude(unit=None, scale=1.0, low=0.0, high=10.0, default=1.0)
    """Of the friction of eq. (6), k. [-]"""

    def force(self, at: MuscleState, muscle: Muscle) -> Real:
        """Friction on the axis: against contraction when contracting. [N]."""
        size = self.magnitude(at, muscle)
        return -at.direction * (size if self.share == 1.0 else self.share * size)

    def magnitude(self, at: MuscleState, muscle: Muscle) -> Real:
        r"""Size of the friction of a share of 1, F_k of eq. (6).

        .. math:: F_k = \mu \pi L_N (1-h) \{[p D_N - 2 E t] s + 2 E t\}

        which is ``μ · contact pressure · area of the braid``, with
        ``contact pressure = p - 2 E t (s - 1) / (D_N s)``. Below zero contact
        pressure the bladder does not touch the braid and the friction is 0.

        ``as_printed`` closes the brace before ``+ 2 E t``, which leaves
        ``F_k = μ{π L_N (1-h) [p D_N - 2 E t] s + 2 E t}``: its value depends on the
        unit system, and it is negative for a slack muscle.

        Returns
        -------
        F_k. [N]
        """
        load = at.pressure * muscle.diameter - muscle.hoop_support
        sliding = muscle.friction_length * (1 - at.contraction)
        if self.form is Form.AS_PRINTED:
            loose = muscle.friction_coefficient * muscle.hoop_support
            return sliding * load * at.diameter_ratio + loose
        contact = sliding * (load * at.diameter_ratio + muscle.hoop_support)
        return positive_part(contact)

    def kinks(
        self, contraction: Real, diameter_ratio: Real, muscle: Muscle
    ) -> tuple[Real, ...]:
        """Pressure at which the bladder reaches the braid, ``2Et(s-1)/(D_N s)``."""
        if self.form is Form.AS_PRINTED:
            return ()
        return ((1 - 1 / diameter_ratio) * muscle.hoop_support / muscle.diameter,)
