"""Linkage between muscle and jaws, with the return spring that opens them.

Both jaws move by half the opening, so by virtual work
``grip per jaw · d(opening) = (F - F_spring) · d(length)``, and with the opening
``w = w0 - r · (shortening)`` the grip force per jaw is ``(F - F_spring) / r``.
"""

from dataclasses import dataclass

from gripperd.model.real import Real


@dataclass(frozen=True, slots=True, kw_only=True)
class Linkage:
    """A constant transmission ratio and a linear return spring."""

    open_width: float
    """Opening of the jaws with the muscle at rest length, w0. [m]"""
    ratio: float
    """Closing of the jaws per shortening of the muscle, r. [m/m]"""
    spring_preload: float
    """Force of the return spring with the jaws open. [N]"""
    spring_rate: float
    """Rise of the return spring per shortening of the muscle. [N/m]"""

    def opening(self, contraction: Real, rest_length: float) -> Real:
        """Distance between the jaws at a contraction. [m]."""
        return self.open_width - self.ratio * rest_length * contraction

    def contraction(self, opening: Real, rest_length: float) -> Real:
        """Contraction at which the jaws are this far apart. [-]."""
        return (self.open_width - opening) / (self.ratio * rest_length)

    def spring_force(self, contraction: Real, rest_length: float) -> Real:
        """Pull the muscle spends on the return spring. [N]."""
        return self.spring_preload + self.spring_rate * rest_length * contraction

    def grip_force(
        self, muscle_force: Real, contraction: Real, rest_length: float
    ) -> Real:
        """Force of each jaw; below 0 the spring holds the jaws off. [N]."""
        spring = self.spring_force(contraction, rest_length)
        return (muscle_force - spring) / self.ratio

    def muscle_force(
        self, grip_force: Real, contraction: Real, rest_length: float
    ) -> Real:
        """Pull the muscle needs for a force of each jaw. [N]."""
        spring = self.spring_force(contraction, rest_length)
        return grip_force * self.ratio + spring
