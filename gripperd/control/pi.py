"""A discrete PI controller that does not wind up.

References
----------
.. [1] K. J. Astrom, T. Hagglund, "Advanced PID Control", ISA, 2006, chapter 3:
       windup, conditional integration, back-calculation, bumpless transfer.
"""

from gripperd.control.tuning import Gains

LONGEST_STEP = 0.1
"""A stall of the loop is not made up for in one step. [s]"""


class PI:
    r"""Output ``K (e + ∫ e dt / T)``, within bounds.

    At a bound the integral is set back to what the bound allows (back-calculation in
    one step), so it leaves the bound as soon as the error turns. An error that is
    larger than what is left up to the bound cannot be closed by this output: it has
    another cause, and is not integrated (conditional integration).
    """

    def __init__(self, gains: Gains) -> None:
        self.output = 0.0
        self._gains = gains
        self._integral = 0.0

    def begin(self, error: float) -> None:
        """Start with an output of 0 at this error, so that nothing jumps."""
        self.output = 0.0
        self._integral = -self._gains.proportional * error

    def step(self, error: float, dt: float, low: float, high: float) -> float:
        """Output after a period.

        Parameters
        ----------
        error
            Wanted less measured, in the unit of the output.
        dt
            Time since the last step. [s]
        low, high
            Bounds of the output, around 0.
        """
        if not low <= self.output + error <= high:
            return self.hold(error, low, high)
        gain = self._gains.proportional
        share = min(dt, LONGEST_STEP) / self._gains.integral_time
        self._integral += gain * error * share
        wanted = gain * error + self._integral
        self.output = min(max(wanted, low), high)
        self._integral += self.output - wanted
        return self.output

    def hold(self, error: float, low: float, high: float) -> float:
        """Keep the output, within bounds, and go on from it without a jump."""
        self.output = min(max(self.output, low), high)
        self._integral = self.output - self._gains.proportional * error
        return self.output
