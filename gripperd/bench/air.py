"""The air from the regulator to the muscle: two lags and a leak."""

from math import expm1

from gripperd.bench.settings import PlantSettings

SETTLED = 0.1
"""Distance from the final pressure that no longer counts; 0.3 mN of pull. [Pa]"""


class Air:
    """Gauge pressures at the regulator outlet and in the muscle.

    First-order lags, exact for any step. That the air is also compressed when the
    muscle is moved from outside is left out.
    """

    __slots__ = ("_settings", "chamber", "outlet", "settled")

    def __init__(self, settings: PlantSettings) -> None:
        self._settings = settings
        self.outlet = 0.0
        self.chamber = 0.0
        self.settled = True
        """Whether both pressures have reached their final values."""

    def leak(self, leak_rate: float, dt: float) -> None:
        """Lose air from a muscle whose tube is shut, for a time. [1/s, s]."""
        lost = -self.chamber * expm1(-leak_rate * dt)
        self.settled = leak_rate * self.chamber < SETTLED
        self.chamber -= lost

    def step(self, target: float, leak_rate: float, dt: float) -> None:
        """Follow the regulator for a time.

        Parameters
        ----------
        target
            Gauge pressure the regulator is after. [Pa]
        leak_rate
            Fall of the muscle pressure per pressure with the tube shut. [1/s]
        dt
            [s]
        """
        settings = self._settings
        change = target - self.outlet
        lag = settings.regulator_lag
        if change < 0.0:
            lag *= settings.exhaust_factor
        self.settled = -SETTLED < change < SETTLED
        outlet = target if self.settled else self.outlet - change * expm1(-dt / lag)
        self.outlet = outlet

        lag = settings.chamber_lag
        if outlet < self.chamber:
            lag *= settings.exhaust_factor
        # dp/dt = (outlet - p) / lag - leak p, solved for a constant outlet.
        droop = 1.0 + leak_rate * lag
        final = outlet / droop
        change = final - self.chamber
        if -SETTLED < change < SETTLED:
            self.chamber = final
        else:
            self.chamber -= change * expm1(-dt * droop / lag)
            self.settled = False
