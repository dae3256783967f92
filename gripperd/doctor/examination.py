"""All checks of one gripper, in order; what a dead link prevents is said so."""

from collections.abc import AsyncIterator, Iterator
from typing import TYPE_CHECKING, cast

from gripperd.doctor.finding import Finding, Result, Verdict
from gripperd.doctor.input_check import InputCheck, as_currents
from gripperd.doctor.output_check import (
    RIGHT_MODULE,
    OutputCheck,
    Step,
)
from gripperd.doctor.register_output_check import RegisterOutputCheck
from gripperd.doctor.text_output_check import ItvOutputCheck, PhraseOutputCheck
from gripperd.drivers.analog import AnyBus
from gripperd.drivers.inputs import AsciiInputs, ModbusInputs
from gripperd.drivers.wiring import InputWiring, OutputWiring
from gripperd.errors import DeviceRefused, LinkError, WatchdogTripped
from gripperd.model import Regulator
from gripperd.protocol.encoding import ROUNDING
from gripperd.protocol.modules import Evidence, Module, ModuleDialect
from gripperd.units import MILLI

if TYPE_CHECKING:
    from gripperd.drivers.bus import DconBus, ItvBus, ModbusBus

LINE = (
    "see that the module has power and is wired, and that address, speed, parity and"
    " unit are those of the settings; docs/serial.md lists what to try"
)
UNREACHED = Result.not_possible("the output module does not answer", "see to the link")


class Examination:
    """Checks one gripper, without writing anything.

    Parameters
    ----------
    name
        Of the gripper.
    output, inputs
        What is connected where.
    regulator
        The valve, as the model has it.
    """

    def __init__(
        self,
        name: str,
        output: OutputWiring,
        inputs: InputWiring | None,
        regulator: Regulator,
    ) -> None:
        self._name = name
        self._output = output
        self._inputs = inputs if inputs and inputs.sensors else None
        self._regulator = regulator

    def on_paper(self) -> Iterator[Finding]:
        """What the settings alone tell."""
        yield self._found("model and output", self._driven())
        for module in (self._output.module, *self._input_modules()):
            yield self._found(f"evidence of {module.name}", _evidence(module))

    async def on_the_line(self, bus: AnyBus) -> AsyncIterator[Finding]:
        """What the modules tell."""
        output = _output_check(bus, self._output)
        link = await _link(output)
        yield self._found("link", link)
        for check, step in output.steps.items():
            reached = link.verdict is Verdict.OK
            yield self._found(check, await _made(step) if reached else UNREACHED)
        if self._inputs is None:
            said = "no sensors are wired"
            yield self._found("loops", Result.not_possible(said, "wire one, if any"))
            return
        async for finding in self._sensed(bus, self._inputs):
            yield finding

    async def _sensed(self, bus: AnyBus, wiring: InputWiring) -> AsyncIterator[Finding]:
        check = InputCheck(_inputs_on(bus, as_currents(wiring)), wiring)
        yield self._found("input range", await _made(check.range))
        try:
            for finding in await check.loops(self._name):
                yield finding
        except LinkError as error:
            yield self._found("loops", Result.failed(str(error), LINE))

    def _driven(self) -> Result:
        valve, chosen = self._regulator, self._output.range
        ends = f"{valve.current_low / MILLI:g} to {valve.current_high / MILLI:g} mA"
        if (
            chosen.current_low - ROUNDING <= valve.current_low
            and valve.current_high <= chosen.current_high + ROUNDING
        ):
            return Result.ok(f"the valve's {ends} are within {chosen.span}")
        remedy = "correct valve.current_mA in the model file, or choose another range"
        return Result.failed(f"the valve's {ends} leave {chosen.span}", remedy)

    def _input_modules(self) -> tuple[Module, ...]:
        return () if self._inputs is None else (self._inputs.module,)

    def _found(self, check: str, result: Result) -> Finding:
        return Finding(self._name, check, result)


def _evidence(module: Module) -> Result:
    if not module.unverified and module.evidence is Evidence.MANUAL:
        return Result.ok(module.evidence)
    doubts = "; ".join(module.unverified) or "nobody has confirmed it"
    said = f"{module.evidence}; not confirmed: {doubts}"
    return Result.warning(said, "try it without anything between the jaws first")


async def _made(step: Step) -> Result:
    """Result of a check, whatever comes of it."""
    try:
        return await step()
    except WatchdogTripped as error:
        return Result.failed(str(error), "see why the host was silent, then clear it")
    except DeviceRefused as error:
        return Result.failed(str(error), RIGHT_MODULE)
    except LinkError as error:
        return Result.failed(str(error), LINE)


async def _link(output: OutputCheck) -> Result:
    try:
        await output.read_back()
    except DeviceRefused as error:
        return Result.ok(f"the output module answers: {error}")
    except LinkError as error:
        return Result.failed(str(error), LINE)
    return Result.ok("the output module answers")


def _output_check(bus: AnyBus, wiring: OutputWiring) -> OutputCheck:
    module, dialect = wiring.module, wiring.dialect
    if dialect is ModuleDialect.MODBUS and module.modbus:
        return RegisterOutputCheck(cast("ModbusBus", bus), wiring, module.modbus)
    if dialect in module.phrases:
        phrases = module.phrases[dialect]
        return PhraseOutputCheck(cast("DconBus", bus), wiring, phrases)
    return ItvOutputCheck(cast("ItvBus", bus), wiring)


def _inputs_on(bus: AnyBus, wiring: InputWiring) -> ModbusInputs | AsciiInputs:
    module, dialect = wiring.module, wiring.dialect
    if dialect is ModuleDialect.MODBUS and module.modbus:
        return ModbusInputs(cast("ModbusBus", bus), wiring, module.modbus)
    return AsciiInputs(cast("DconBus", bus), wiring, module.phrases[dialect])
