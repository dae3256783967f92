"""One gripper on a bus: a valve current out, its sensors' currents in."""

from collections.abc import Mapping
from typing import Protocol, TypeAlias, cast

from gripperd.drivers.ascii_output import AsciiOutput, ItvOutput
from gripperd.drivers.bus import Bus, ModbusBus
from gripperd.drivers.facts import RigFacts, input_facts, output_facts, warnings
from gripperd.drivers.inputs import AsciiInputs, ModbusInputs
from gripperd.drivers.modbus_output import ModbusOutput
from gripperd.drivers.wiring import (
    InputWiring,
    OutputWiring,
    SensorWiring,
    WatchdogSettings,
)
from gripperd.errors import (
    DeviceRefused,
    InputError,
    LinkError,
    ModuleMismatch,
    WatchdogTripped,
)
from gripperd.protocol import itv
from gripperd.protocol.dcon import Ask
from gripperd.protocol.modules import ModuleDialect
from gripperd.signals import Measurement, Reading

__all__ = [
    "AnalogRig",
    "InputWiring",
    "OutputWiring",
    "SensorWiring",
    "WatchdogSettings",
]

AnyBus: TypeAlias = ModbusBus | Bus[Ask, str] | Bus[itv.Request, int]


class Output(Protocol):
    """The channel that drives the valve."""

    @property
    def range_verified(self) -> bool:
        """Whether the module has confirmed its range."""
        ...

    @property
    def armed(self) -> bool:
        """Whether its watchdog is armed."""
        ...

    async def attach(self) -> None:
        """Check how the module is set up, and arm what the settings ask for."""
        ...

    async def read(self, now: float) -> Reading:
        """Read the current back. [A]."""
        ...

    async def write(self, current: float, *, urgent: bool) -> None:
        """Set the current. [A]."""
        ...


class Inputs(Protocol):
    """The sensors."""

    @property
    def range_verified(self) -> bool:
        """Whether the module has confirmed its ranges."""
        ...

    async def attach(self) -> None:
        """Check how the module is set up."""
        ...

    async def read(self) -> Mapping[str, Reading]:
        """Read every sensor."""
        ...


class AnalogRig:
    """Valve and sensors of one gripper.

    The modules are looked at before the first sample, and again after every time that
    no trustworthy answer came: they may have been switched off meanwhile.

    Parameters
    ----------
    bus
        What both modules are on.
    output, inputs
        What is connected where.
    """

    def __init__(
        self, bus: AnyBus, output: OutputWiring, inputs: InputWiring | None
    ) -> None:
        fitted = inputs if inputs and inputs.sensors else None
        self.warnings = warnings(output, fitted)
        """What a person should hear at every start."""
        self._output_wiring, self._input_wiring = output, fitted
        self._output = _output_on(bus, output)
        self._inputs = _inputs_on(bus, fitted) if fitted else None
        self._attached = self._inputs_attached = False
        self._fault: LinkError | None = None

    @property
    def facts(self) -> RigFacts:
        """What is known of the modules; what they confirmed holds until a failure."""
        wiring, inputs = self._input_wiring, self._inputs
        sensed = self._inputs_attached
        return RigFacts(
            output=output_facts(
                self._output_wiring,
                range_verified=self._attached and self._output.range_verified,
                armed=self._attached and self._output.armed,
            ),
            input=input_facts(wiring, range_verified=sensed and inputs.range_verified)
            if wiring and inputs
            else None,
        )

    async def read(self, now: float) -> Measurement:
        """Sample the commanded current and every sensor.

        Raises
        ------
        ModuleMismatch
            The output module is set up otherwise than the settings say. Where the
            input module is, its sensors are bad.
        WatchdogTripped
            The output is at its safe value until a person clears it.
        LinkError
            When no trustworthy answer came.
        """
        try:
            if not self._attached:
                await self._output.attach()
            current = await self._output.read(now)
            sensors = await self._sensors()
        except LinkError as error:
            self._doubt(error)
            raise
        self._attached, self._fault = True, None
        return Measurement(time=now, current=current, **sensors)

    async def write(self, current: float, *, urgent: bool = False) -> None:
        """Set the valve current; return once the module has confirmed it. [A].

        Raises
        ------
        InputError
            Outside what the module can drive.
        ModuleMismatch, WatchdogTripped
            What the last sample has found stands against driving it.
        LinkError
            When no trustworthy confirmation came; it may have arrived or not.
        """
        if self._fault is not None:
            raise self._fault
        try:
            await self._output.write(current, urgent=urgent)
        except LinkError as error:
            self._doubt(error)
            raise

    def _doubt(self, error: LinkError) -> None:
        """Look at the modules again before the next sample is believed."""
        self._attached = self._inputs_attached = False
        if isinstance(error, ModuleMismatch | WatchdogTripped):
            self._fault = error

    async def _sensors(self) -> Mapping[str, Reading]:
        if self._inputs is None or self._input_wiring is None:
            return {}
        try:
            if not self._inputs_attached:
                await self._inputs.attach()
                self._inputs_attached = True
            return await self._inputs.read()
        except (DeviceRefused, ModuleMismatch) as error:
            # The line is sound: without its sensors the valve can still be driven.
            self._inputs_attached = False
            bad = Reading.bad(str(error))
            return dict.fromkeys(self._input_wiring.sensors, bad)


def _output_on(bus: AnyBus, wiring: OutputWiring) -> Output:
    module, dialect = wiring.module, wiring.dialect
    if dialect is ModuleDialect.ITV and module.itv:
        return ItvOutput(cast("Bus[itv.Request, int]", bus), wiring)
    if dialect is ModuleDialect.MODBUS and module.modbus:
        return ModbusOutput(cast("ModbusBus", bus), wiring, module.modbus)
    if dialect in module.phrases:
        return AsciiOutput(cast("Bus[Ask, str]", bus), wiring, module.phrases[dialect])
    raise _unspoken(module.name, dialect)


def _inputs_on(bus: AnyBus, wiring: InputWiring) -> Inputs:
    module, dialect = wiring.module, wiring.dialect
    if dialect is ModuleDialect.MODBUS and module.modbus:
        return ModbusInputs(cast("ModbusBus", bus), wiring, module.modbus)
    if dialect in module.phrases:
        return AsciiInputs(cast("Bus[Ask, str]", bus), wiring, module.phrases[dialect])
    raise _unspoken(module.name, dialect)


def _unspoken(module: str, dialect: ModuleDialect) -> InputError:
    return InputError(f"{module} does not speak {dialect}", key="dialect")
