"""A simulated SMC regulator."""

from gripperd.bench.channels import Outputs
from gripperd.bench.rig import Rig
from gripperd.protocol import itv


class ItvDevice:
    """One SMC regulator; it measures the pressure at the outlet of the rig."""

    def __init__(self, outputs: Outputs, rig: Rig) -> None:
        self._outputs = outputs
        self._rig = rig

    def answer(self, request: itv.Request | itv.Refusal) -> int | itv.Refusal:
        """Count that was asked for or set, or why not."""
        scale = self._outputs.ranges[0]
        match request:
            case itv.Refusal():
                return request
            case itv.Set(count):
                self._outputs.put_out(0, scale.current(count))
                return count
            case itv.Query.SET_POINT:
                return round(scale.count(self._outputs.currents()[0]))
            case itv.Query.PRESSURE:
                count = round(scale.count(self._rig.outlet_current()))
                return min(max(count, 0), itv.FULL_SCALE)
