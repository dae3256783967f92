"""Curve of the electro-pneumatic regulator: valve current to gauge pressure."""

from dataclasses import dataclass

from gripperd.model.real import Real


@dataclass(frozen=True, slots=True, kw_only=True)
class Regulator:
    """A straight line through two points, as the makers of E/P regulators state it."""

    current_low: float
    """Current at the low end of the span, the live zero. [A]"""
    current_high: float
    """Current at the high end of the span. [A]"""
    pressure_low: float
    """Gauge pressure at the low end. [Pa]"""
    pressure_high: float
    """Gauge pressure at the high end. [Pa]"""

    @property
    def gain(self) -> float:
        """Slope of the curve. [Pa/A]."""
        span = self.current_high - self.current_low
        return (self.pressure_high - self.pressure_low) / span

    def pressure(self, current: Real) -> Real:
        """Gauge pressure at a current; beyond the span the line goes on. [Pa].

        >>> reference = Regulator(current_low=0.004, current_high=0.020,
        ...                       pressure_low=0.0, pressure_high=500e3)
        >>> reference.pressure(0.0107)
        209375.0
        """
        return self.pressure_low + self.gain * (current - self.current_low)

    def current(self, pressure: Real) -> Real:
        """Current for a gauge pressure; beyond the span the line goes on. [A]."""
        return self.current_low + (pressure - self.pressure_low) / self.gain
