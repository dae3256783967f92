"""Whether the range of a module can be what the settings ask of it."""

from gripperd.drivers.wiring import InputWiring, OutputWiring
from gripperd.model import Regulator
from gripperd.protocol.encoding import ROUNDING, Range
from gripperd.protocol.modules import ModuleDialect, OutputModule
from gripperd.units import MILLI


def check_set_range(wiring: OutputWiring | InputWiring) -> None:
    """Refuse `set_range` where nothing could be set.

    Raises
    ------
    ValueError
        The module has no range register, or speaks text.
    """
    registers = wiring.module.modbus
    if not wiring.set_range or (
        wiring.dialect is ModuleDialect.MODBUS and registers and registers.range_code
    ):
        return
    message = (
        f"set_range: the range of {wiring.module.name} cannot be set over"
        f" {wiring.dialect}; set it with the maker's utility"
    )
    raise ValueError(message)


def check_driven(regulator: Regulator, module: OutputModule, chosen: Range) -> None:
    """Refuse a valve that the range of its module cannot drive from end to end."""
    ends = (
        ("starts", regulator.current_low, "from", chosen.current_low),
        ("ends", regulator.current_high, "up to", chosen.current_high),
    )
    for verb, current, how, limit in ends:
        beyond = current - limit if verb == "ends" else limit - current
        if beyond > ROUNDING:
            message = (
                f"valve.current_mA {verb} at {current / MILLI:g} mA,"
                f" {module.name} drives {how} {limit / MILLI:g} mA"
            )
            raise ValueError(message)
