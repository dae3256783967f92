"""The analog modules on one line, wired to the rig."""

from collections.abc import Sequence
from typing import NamedTuple, TypeAlias

from gripperd.bench import contacts
from gripperd.bench.channels import Inputs, Outputs
from gripperd.bench.rig import Rig
from gripperd.errors import InputError
from gripperd.protocol.modules import InputModule, ModuleDialect, OutputModule


class Fitted(NamedTuple):
    """A module, and what it is set to."""

    module: OutputModule | InputModule
    unit: int
    range_name: str | None = None
    """None: the first of the module."""


AnyFitted: TypeAlias = (
    Fitted
    | tuple[OutputModule, int]
    | tuple[InputModule, int]
    | tuple[OutputModule | InputModule, int]
)


class Modules:
    """Output and input modules, each at its unit; several may share one.

    The valve is on channel 0 of the first output module; pressure, opening and grip
    are on the first channels of the first input module, the contacts on those after
    them. Nothing is on the others.

    Parameters
    ----------
    rig
        What they are wired to.
    fitted
        The modules.

    Raises
    ------
    InputError
        A module has no range of that name.
    """

    def __init__(self, rig: Rig, *fitted: AnyFitted) -> None:
        self.rig = rig
        self.units: dict[int, list[Outputs | Inputs]] = {}
        for each in fitted:
            one = Fitted(*each)
            self.units.setdefault(one.unit, []).append(self._wired(one))

    @property
    def outputs(self) -> Sequence[Outputs]:
        """Every output module."""
        return [each for each in self._all() if isinstance(each, Outputs)]

    def spoken(self, dialects: Sequence[ModuleDialect]) -> None:
        """Refuse a module that speaks none of these.

        Raises
        ------
        InputError
            With what it does speak.
        """
        for each in self._all():
            known = each.module.dialects
            if not set(known) & set(dialects):
                message = (
                    f"{each.module.name} speaks {', '.join(known)}, this line"
                    f" {' and '.join(dialects)}"
                )
                raise InputError(message, key="module")

    def advance(self, to: float) -> None:
        """Let rig and watchdogs live up to a time. [s]."""
        for each in self.outputs:
            due = each.watchdog.due
            if due is not None and due <= to:
                self.rig.advance(due)
                each.trip()
        self.rig.advance(to)

    def power_cycle(self, unit: int) -> None:
        """Switch everything at a unit off and on."""
        for each in self.units.get(unit, ()):
            each.power_cycle()

    def trip(self, unit: int) -> None:
        """Trip the watchdogs at a unit, armed or not."""
        for each in self.units.get(unit, ()):
            if isinstance(each, Outputs):
                each.trip()

    def cut_loop(self, unit: int) -> None:
        """Cut the wire of channel 0 of the outputs at a unit."""
        for each in self.units.get(unit, ()):
            if isinstance(each, Outputs):
                each.loop_open = True

    def mend(self) -> None:
        """Join every cut wire; a trip stays until it is cleared as the maker says."""
        for each in self.outputs:
            each.loop_open = False

    def _all(self) -> Sequence[Outputs | Inputs]:
        return [each for at in self.units.values() for each in at]

    def _currents(self) -> Sequence[float]:
        opened = self.rig.plant.faults.opened
        return (*self.rig.read_inputs(), *contacts.currents(opened))

    def _wired(self, one: Fitted) -> Outputs | Inputs:
        module, _, name = one
        if name is not None and name not in module.ranges:
            known = ", ".join(module.ranges)
            message = f"{name} is not a range of {module.name}: {known}"
            raise InputError(message, key="range")
        first = not any(isinstance(each.module, type(module)) for each in self._all())
        if isinstance(module, InputModule):
            return Inputs(module, self._currents if first else tuple, name)
        drive = self.rig.write_current if first else _nothing
        return Outputs(module, lambda: self.rig.plant.time, drive, name)


def _nothing(current: float) -> None:
    """What hangs on an output that drives no valve."""
