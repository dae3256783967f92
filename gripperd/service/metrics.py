"""Figures for Prometheus, read at the moment they are asked for."""

from collections import Counter
from collections.abc import Iterator
from contextlib import suppress

from fastapi import APIRouter
from prometheus_client import CollectorRegistry, generate_latest
from prometheus_client.core import (
    CounterMetricFamily,
    GaugeMetricFamily,
    HistogramMetricFamily,
    InfoMetricFamily,
    Metric,
    StateSetMetricFamily,
)
from prometheus_client.exposition import CONTENT_TYPE_PLAIN_0_0_4
from prometheus_client.registry import Collector
from starlette.responses import Response

from gripperd.control.monitors.policy import Cause
from gripperd.control.states import Grip, Machine
from gripperd.control.timing import BOUNDS, Distribution
from gripperd.errors import LinkError
from gripperd.link.control import Overview, ReadOverview
from gripperd.service.context import Daemon
from gripperd.service.health import OVERVIEW_WITHIN
from gripperd.service.state import StateDocument

EVERY = 8
"""Classes of control's distributions that make one bucket here: a factor of four."""

routes = APIRouter(include_in_schema=False)


class Figures(Collector):
    """What is known at one moment.

    Parameters
    ----------
    version
        Of gripperd.
    states
        Of every gripper that can be asked.
    overview
        Of control, None while it cannot be asked.
    """

    def __init__(
        self,
        version: str,
        states: tuple[StateDocument, ...],
        overview: Overview | None,
    ) -> None:
        self._version = version
        self._states = states
        self._overview = overview

    def collect(self) -> Iterator[Metric]:
        """Every figure there is; one that is not known is left out."""
        build = InfoMetricFamily("gripperd", "The daemon.")
        build.add_metric([], {"version": self._version})
        yield build
        up = self._overview is not None
        yield GaugeMetricFamily("gripperd_control_up", "Control answers.", float(up))
        yield from self._grippers()
        if self._overview is not None:
            yield from _of_control(self._overview)

    def _grippers(self) -> Iterator[Metric]:
        label = ["gripper"]
        machine = StateSetMetricFamily(
            "gripperd_machine", "Machine state.", labels=label
        )
        grip = StateSetMetricFamily("gripperd_grip", "Grip state.", labels=label)
        current = GaugeMetricFamily(
            "gripperd_current_amperes", "Valve current asked for.", labels=label
        )
        force = GaugeMetricFamily(
            "gripperd_grip_force_newtons",
            "Grip force per jaw.",
            labels=["gripper", "quality"],
        )
        budget = GaugeMetricFamily(
            "gripperd_hold_budget_seconds",
            "Time to the slip limit after a loss; +Inf where the grip stays.",
            labels=["gripper", "loss"],
        )
        for state in self._states:
            name = [state.name]
            machine.add_metric(name, {each: each is state.machine for each in Machine})
            grip.add_metric(name, {each: each is state.grip for each in Grip})
            if state.current_mA is not None:
                current.add_metric(name, state.current_mA / 1000)
            felt = state.measured.force_N
            if felt.value is not None:
                force.add_metric([state.name, felt.quality], felt.value)
            for loss, seconds in _losses(state):
                budget.add_metric([state.name, loss], seconds)
        yield from (machine, grip, current, force, budget, self._faults())

    def _faults(self) -> Metric:
        active = GaugeMetricFamily(
            "gripperd_faults_active",
            "Faults that still matter.",
            labels=["gripper", "cause"],
        )
        for state in self._states:
            now = Counter(fault.cause for fault in state.faults)
            for cause in Cause:
                active.add_metric([state.name, cause], now[cause])
        return active


def _losses(state: StateDocument) -> Iterator[tuple[str, float]]:
    found = state.hold_budget
    if found is None:
        return
    for loss, seconds in (
        ("air", found.air_s),
        ("power", found.power_s),
        ("bus", found.bus_s),
    ):
        yield loss, float("inf") if seconds is None else seconds


def _of_control(overview: Overview) -> Iterator[Metric]:
    commands = CounterMetricFamily(
        "gripperd_commands",
        "Commands that are over, since the start of control.",
        labels=["gripper", "type", "status"],
    )
    for gripper, ended in overview.ended.items():
        for what, count in ended.items():
            commands.add_metric([gripper, *what.split()], count)
    yield commands
    faults = CounterMetricFamily(
        "gripperd_faults",
        "Faults there have been, since the start of control.",
        labels=["gripper", "cause"],
    )
    for gripper, raised in overview.raised.items():
        for cause in Cause:
            faults.add_metric([gripper, cause], raised.get(cause, 0))
    yield faults
    overruns = CounterMetricFamily(
        "gripperd_overruns",
        "Periods that began late, the one before not being over.",
        labels=["gripper"],
    )
    lateness = HistogramMetricFamily(
        "gripperd_lateness_seconds",
        "From the deadline of a period to its start.",
        labels=["gripper"],
    )
    for gripper, timing in overview.timings.items():
        overruns.add_metric([gripper], timing.overruns)
        buckets = list(_buckets(timing.lateness))
        lateness.add_metric([gripper], buckets, timing.lateness.total)
    yield from (overruns, lateness)


def _buckets(found: Distribution) -> Iterator[tuple[str, float]]:
    for upper in range(0, len(BOUNDS), EVERY):
        yield f"{BOUNDS[upper]:.3g}", sum(found.counts[: upper + 1])
    yield "+Inf", found.count


@routes.get("/metrics")
async def metrics(daemon: Daemon) -> Response:
    """Figures in the text format of Prometheus."""
    states: tuple[StateDocument, ...] = ()
    overview = None
    # What cannot be asked has no figures, and gripperd_control_up says so.
    with suppress(LinkError):
        seen = [await daemon.states.get(name) for name in daemon.fleet]
        states = tuple(each.document for each in seen)
        overview = await daemon.control.ask(ReadOverview(), Overview, OVERVIEW_WITHIN)
    registry = CollectorRegistry()
    registry.register(Figures(daemon.version, states, overview))
    return Response(generate_latest(registry), media_type=CONTENT_TYPE_PLAIN_0_0_4)
