"""The muscle as a braided cylinder: geometry, eqs. (1)-(3), and ideal pull, eq. (4).

Symbols: contraction ``h = (L_N - L) / L_N``, braid angle ``θ`` between strand and axis,
``s = sin θ / sin θ0`` the diameter relative to rest.

References
----------
.. [1] "Study on static characteristics of pneumatic muscles", eqs. (1)-(5).
.. [2] C.-P. Chou, B. Hannaford, "Measurement and modeling of McKibben pneumatic
       artificial muscles", IEEE Trans. Robot. Autom. 12(1), 90-102, 1996.
.. [3] A. Martens, I. Boblan, "Modeling the static force of a Festo pneumatic muscle
       actuator", Actuators 6(4), 33, 2017: the two terms of eq. (5), with E = E(L).
"""

from dataclasses import dataclass
from functools import cached_property
from math import cos, pi, sin, tan

from gripperd.model.real import Real

CATALOGUE_RANGE = (-0.03, 0.25)
"""Contraction a fluidic muscle is specified for (Festo DMSP: 3 % stretch, 25 %)."""


@dataclass(frozen=True, kw_only=True)
class Muscle:
    """Constants of one muscle at rest."""

    rest_length: float
    """Active length between the clamps, without fittings, L_N. [m]"""
    diameter: float
    """Diameter of the braid surface at rest, D_N = D_0. [m]"""
    braid_angle: float
    """Angle of a strand to the axis at rest, θ0. [rad]"""
    wall_thickness: float
    """Thickness of the bladder, t. [m]"""
    elastic_modulus: float
    """Modulus of the bladder, the same in both directions, E. [Pa]"""
    friction_coefficient: float
    """Between bladder and braid, μ. [-]"""

    @cached_property
    def _pull(self) -> tuple[float, float]:
        """Coefficients of eq. (4), so that F_i / p = axial (1-h)² - radial. [m²]."""
        area = pi * self.diameter**2 / 4
        return (
            3 * area / tan(self.braid_angle) ** 2,
            area / sin(self.braid_angle) ** 2,
        )

    @property
    def radial_area(self) -> float:
        """What eq. (4) takes off per pressure, π D_N²/(4 sin²θ0) = l²/(4πn²). [m²]."""
        return self._pull[1]

    @cached_property
    def cot_squared(self) -> float:
        """1/tan²θ0, the leverage of the hoop on the axis at rest. [-]."""
        return 1 / tan(self.braid_angle) ** 2

    @cached_property
    def rubber_stiffness(self) -> float:
        """E t π D_0, the factor of eq. (5). [N]."""
        return self.elastic_modulus * self.wall_thickness * pi * self.diameter

    @cached_property
    def friction_length(self) -> float:
        """μ π L_N, the factor of eq. (6). [m]."""
        return self.friction_coefficient * pi * self.rest_length

    @cached_property
    def hoop_support(self) -> float:
        """2 E t, what a unit of hoop strain of the bladder holds back. [N/m]."""
        return 2 * self.elastic_modulus * self.wall_thickness

    @cached_property
    def straight(self) -> float:
        """Contraction at which the strands lie along the axis, 1 - 1/cos θ0. [-].

        The geometry ends there: a braid cannot be stretched further.
        """
        return 1 - 1 / cos(self.braid_angle)

    @cached_property
    def spent(self) -> float:
        """Contraction at which eq. (4) gives no pull: cos²θ = 1/3, θ = 54.7°. [-]."""
        return 1 - 1 / (3**0.5 * cos(self.braid_angle))

    def diameter_ratio(self, contraction: Real) -> Real:
        r"""Diameter of the braid relative to rest, from eqs. (1)-(3).

        .. math:: s = \frac{\sin\theta}{\sin\theta_0}
                    = \frac{\sqrt{1 - (1-h)^2\cos^2\theta_0}}{\sin\theta_0}

        Parameters
        ----------
        contraction
            Shortening relative to rest, not below :attr:`straight`. [-]

        Returns
        -------
        The ratio s, 1 at rest. [-]

        Examples
        --------
        The paper's muscle bulges from 20 to 27.38 mm when it shortens by a tenth.

        >>> muscle = Muscle(rest_length=0.25, diameter=0.02, braid_angle=pi * 25 / 180,
        ...     wall_thickness=0.002, elastic_modulus=1.3e6, friction_coefficient=0.002)
        >>> 20 * muscle.diameter_ratio(0.1)
        27.3773
        """
        length = 1 - contraction
        # 1/sin²θ0 = 1 + 1/tan²θ0, which makes s exactly 1 at h = 0.
        return (1 + self.cot_squared * (1 - length * length)) ** 0.5

    def pull_area(self, contraction: Real) -> Real:
        r"""Ideal pull per pressure, eq. (4) divided by p.

        .. math:: \frac{F_i}{p} = \frac{\pi D_N^2}{4} \left[
                  \frac{3(1-h)^2}{\tan^2\theta_0} - \frac{1}{\sin^2\theta_0} \right]

        It equals ``-dV/dL`` of the braided cylinder, so it holds no free constant.

        Parameters
        ----------
        contraction
            Shortening relative to rest. [-]

        Returns
        -------
        Force per gauge pressure, positive when the muscle pulls. [m²]
        """
        axial, radial = self._pull
        length = 1 - contraction
        return axial * (length * length) - radial

    def elastic_force(self, contraction: Real, diameter_ratio: Real) -> Real:
        r"""Elastic force of the bladder, eq. (5).

        .. math:: F_s = E t \pi D_0 \left\{ \frac{(1-h)^2}{\tan^2\theta_0}
                  \left(1 - \frac{1}{s}\right) + h s \right\}

        The first term is the hoop, carried to the axis by the braid; the second is
        the axial stress. Thin wall of constant thickness, linear rubber.

        Parameters
        ----------
        contraction
            Shortening relative to rest. [-]
        diameter_ratio
            The diameter there, as :meth:`diameter_ratio` gives it. [-]

        Returns
        -------
        Force towards rest length: positive when shortened. [N]
        """
        length = 1 - contraction
        hoop = self.cot_squared * (length * length) * (1 - 1 / diameter_ratio)
        axial = contraction * diameter_ratio
        return self.rubber_stiffness * (hoop + axial)

    @cached_property
    def elastic_stiffness(self) -> float:
        r"""Slope of :meth:`elastic_force` at rest length, per contraction. [N].

        .. math:: E t \pi D_0 (1 / \tan^4\theta_0 + 1), \quad
                  s'(0) = 1 / \tan^2\theta_0
        """
        return self.rubber_stiffness * (self.cot_squared**2 + 1)

    def volume(self, contraction: Real) -> Real:
        """Volume inside the braid, ``π D² L / 4`` with eqs. (1)-(3). [m³]."""
        ratio = self.diameter_ratio(contraction)
        rest = pi * self.diameter**2 * self.rest_length / 4
        return rest * ratio * ratio * (1 - contraction)
