import asyncio
import sys
from collections.abc import AsyncIterator, Awaitable, Callable, Mapping
from math import radians
from random import Random

import pytest
import structlog
from hypothesis import settings

from gripperd.bench.modules import Modules
from gripperd.bench.rig import Rig
from gripperd.bench.sensors import Sensor, SensorSettings
from gripperd.bench.server import BenchServer, serve_bench
from gripperd.config.module_library import ModuleLibrary
from gripperd.control.profile import Mode, Profile
from gripperd.drivers.analog import AnalogRig, InputWiring, OutputWiring, SensorWiring
from gripperd.drivers.bus import ModbusBus, TcpAddress
from gripperd.effects.braid_friction import BraidFriction
from gripperd.effects.rubber_elasticity import RubberElasticity
from gripperd.model import Chain, Linkage, Muscle, Regulator, StaticMuscle
from gripperd.protocol.live_zero import LoopScale

settings.register_profile("repeatable", derandomize=True, deadline=None)
settings.load_profile("repeatable")

# A daemon that some tests share lives in a thread while others run: what it logs must
# not come between what a doctest or a verdict prints.
structlog.configure(logger_factory=structlog.PrintLoggerFactory(sys.stderr))

OUTPUT = ModuleLibrary().output("waveshare_ao_8ch")
INPUT = ModuleLibrary().input("waveshare_ai_8ch")
OUTPUT_UNIT, INPUT_UNIT = 1, 2
SPANS = {"pressure": 600e3, "opening": 0.1, "grip": 100.0}


@pytest.fixture(
    params=[
        pytest.param(("asyncio", {"use_uvloop": False}), id="asyncio"),
        pytest.param(("asyncio", {"use_uvloop": True}), id="uvloop"),
    ]
)
def anyio_backend(request: pytest.FixtureRequest) -> object:
    """Both event loops: their transports differ once a line is closing."""
    return request.param


@pytest.fixture(scope="session")
def eventually() -> Callable[[Callable[[], bool]], Awaitable[None]]:
    """Waits for what must happen soon and has no event to wait for."""

    async def wait(happened: Callable[[], bool]) -> None:
        async with asyncio.timeout(60.0):
            while not happened():  # noqa: ASYNC110
                await asyncio.sleep(0.001)

    return wait


@pytest.fixture(scope="session")
def muscle() -> Muscle:
    """The paper's muscle."""
    return Muscle(
        rest_length=0.250,
        diameter=0.020,
        braid_angle=radians(25),
        wall_thickness=0.002,
        elastic_modulus=1.3e6,
        friction_coefficient=0.002,
    )


@pytest.fixture(scope="session")
def static(muscle: Muscle) -> StaticMuscle:
    """The paper's static model with eq. (6) rebraced."""
    return StaticMuscle(muscle, (RubberElasticity(), BraidFriction()))


@pytest.fixture(scope="session")
def chain(static: StaticMuscle) -> Chain:
    """The reference rig: the paper's muscle on the gripper chosen for it."""
    return Chain(
        name="reference",
        static=static,
        regulator=Regulator(
            current_low=0.004,
            current_high=0.020,
            pressure_low=0.0,
            pressure_high=500e3,
        ),
        linkage=Linkage(
            open_width=0.085, ratio=4.0, spring_preload=240.0, spring_rate=1000.0
        ),
    )


def profile(name: str, *numbers: float) -> Profile:
    diameter, mass, stiffness, damage, friction, smaller, larger, force, ramp = numbers
    return Profile(
        name=name,
        version=1,
        diameter=diameter,
        smaller=smaller,
        larger=larger,
        mass=mass,
        stiffness=stiffness,
        pad_friction=friction,
        acceleration=5.0,
        damage_force=damage,
        source="estimate",
        slip_margin=1.5,
        crush_margin=1.3,
        mode=Mode.FORCE,
        current=0.0107,
        force=force,
        approach=8e-3,
        ramp=ramp,
    )


@pytest.fixture(scope="session")
def profiles() -> Mapping[str, Profile]:
    """The paper's four objects."""
    objects = (
        profile("apple", 0.065, 0.180, 40e3, 90.0, 0.5, 0.008, 0.008, 25.0, 4e-3),
        profile("peach", 0.058, 0.150, 10e3, 55.0, 0.5, 0.006, 0.006, 15.0, 3e-3),
        profile("raw_egg", 0.041, 0.058, 1e5, 35.0, 0.4, 0.003, 0.004, 12.0, 1.5e-3),
        profile("grape", 0.022, 0.006, 2e3, 12.0, 0.5, 0.004, 0.004, 2.0, 8e-4),
    )
    return {each.name: each for each in objects}


@pytest.fixture
def rig(chain: Chain) -> Rig:
    """A simulated rig with the sensors of the shipped configuration."""
    channels = {
        name: Sensor(LoopScale(value_low=0.0, value_high=span), 5e-4)
        for name, span in SPANS.items()
    }
    return Rig(chain, Random(1), sensors=SensorSettings(**channels))


@pytest.fixture
def modules(rig: Rig) -> Modules:
    """The analog modules of the rig: output unit 1, input unit 2."""
    return Modules(rig, (OUTPUT, OUTPUT_UNIT), (INPUT, INPUT_UNIT))


@pytest.fixture
async def bench(modules: Modules) -> AsyncIterator[BenchServer]:
    """The rig on the wire, in real time."""
    async with serve_bench(modules, "127.0.0.1", 0) as bench:
        yield bench


@pytest.fixture
def bench_address(bench: BenchServer) -> TcpAddress:
    """Where the rig listens; the time-out is generous, so that it tells nothing."""
    host, _, port = bench.address.rpartition(":")
    return TcpAddress(host=host, port=int(port), timeout=60.0)


@pytest.fixture
def wired() -> Callable[[ModbusBus], AnalogRig]:
    """Wires valve and sensors of the simulated rig to a bus."""
    sensors = {
        name: SensorWiring(
            channel=channel,
            scale=LoopScale(
                current_low=0.004, current_high=0.020, value_low=0.0, value_high=span
            ),
        )
        for channel, (name, span) in enumerate(SPANS.items())
    }
    output = OutputWiring(module=OUTPUT, unit=OUTPUT_UNIT, channel=0)
    inputs = InputWiring(module=INPUT, unit=INPUT_UNIT, sensors=sensors)
    return lambda bus: AnalogRig(bus, output, inputs)
