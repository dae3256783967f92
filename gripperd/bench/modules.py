"""The rig's analog modules: registers in front of currents."""

from collections.abc import Sequence

from gripperd.bench import contacts
from gripperd.bench.rig import Rig
from gripperd.protocol.modbus import Read, Refusal, Request, Table, Write
from gripperd.protocol.modules import InputModule, OutputModule


class Modules:
    """An output and an input module on one line, wired to the rig.

    The valve is on channel 0 of the output module; pressure, opening and grip are on
    the first channels of the input module, the contacts on those after them.

    Parameters
    ----------
    rig
        What they are wired to.
    output, inputs
        Which modules they are, each with its unit.
    """

    def __init__(
        self,
        rig: Rig,
        output: tuple[OutputModule, int],
        inputs: tuple[InputModule, int],
    ) -> None:
        self.rig = rig
        self._output, self._output_unit = output
        self._inputs, self._input_unit = inputs
        self._counts = [0] * self._output.channels

    def answer(self, request: Request) -> Sequence[int] | Refusal:
        """Registers read, nothing for a write, or why not."""
        if request.unit == self._output_unit:
            return self._answer_output(request)
        if request.unit == self._input_unit:
            return self._answer_input(request)
        return Refusal.NO_RESPONSE

    def _answer_output(self, request: Request) -> Sequence[int] | Refusal:
        module, first = self._output, self._output.address
        if isinstance(request, Read):
            if request.table is not Table.HOLDING:
                return Refusal.ILLEGAL_FUNCTION
            return _window(self._counts, first, request)
        last = request.address + len(request.values)
        if not first <= request.address <= last <= first + module.channels:
            return Refusal.ILLEGAL_ADDRESS
        if any(module.decode(count) > module.highest for count in request.values):
            return Refusal.ILLEGAL_VALUE
        start = request.address - first
        self._counts[start : start + len(request.values)] = request.values
        self.rig.write_current(module.decode(self._counts[0]))
        return ()

    def _answer_input(self, request: Request) -> Sequence[int] | Refusal:
        module = self._inputs
        if isinstance(request, Write):
            return Refusal.ILLEGAL_FUNCTION
        if request.table is Table.HOLDING:
            codes = [module.range_code] * module.channels
            return _window(codes, module.range_address, request)
        opened = self.rig.plant.faults.opened
        currents = [*self.rig.read_inputs(), *contacts.currents(opened)]
        currents += [0.0] * (module.channels - len(currents))
        counts = [module.encode(current) for current in currents]
        return _window(counts, module.address, request)


def _window(counts: list[int], first: int, request: Read) -> Sequence[int] | Refusal:
    start = request.address - first
    if not 0 <= start <= start + request.count <= len(counts):
        return Refusal.ILLEGAL_ADDRESS
    return counts[start : start + request.count]
