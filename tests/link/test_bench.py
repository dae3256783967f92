import pytest

from gripperd.bench.faults import BenchFaults
from gripperd.bench.object import BenchObject
from gripperd.bench.placed import ObjectState
from gripperd.bench.sensors import Channel
from gripperd.bench.wire_faults import WireFault, WireFaultKind
from gripperd.errors import BadReply, InputError
from gripperd.link.bench import (
    BenchState,
    MendWire,
    PlacedState,
    PlaceObject,
    ReadBench,
    RemoveObject,
    Request,
    SetFaults,
    SetWireFaults,
)
from gripperd.link.frames import decode, encode

EGG = BenchObject(
    diameter=0.041, stiffness=1e5, mass=0.058, friction=0.4, damage_force=35.0
)
FAULTS = BenchFaults(
    supply_pressure=150e3,
    leak_rate=0.5,
    broken=frozenset({Channel.GRIP}),
    frozen=frozenset({Channel.PRESSURE, Channel.OPENING}),
)

LATE = WireFault(kind=WireFaultKind.LATE, delay=0.5, unit=2, times=3)


@pytest.mark.parametrize(
    "request_",
    [
        ReadBench(),
        PlaceObject(EGG),
        RemoveObject(),
        SetFaults(FAULTS),
        SetWireFaults((LATE, WireFault(kind=WireFaultKind.EXCEPTION, code=6)), 0.1),
        MendWire(),
    ],
    ids=lambda request: type(request).__name__,
)
def test_a_request_arrives_as_it_was_meant(request_: Request) -> None:
    assert decode(encode(request_), Request) == request_  # type: ignore[arg-type]


def test_the_state_of_the_rig_arrives_as_it_is() -> None:
    state = BenchState(
        time=1.5,
        current=0.0107,
        pressure=209_375.0,
        opening=0.0408,
        grip=22.3,
        placed=PlacedState(kind=EGG, state=ObjectState.HELD, cracked=False),
        faults=FAULTS,
        address="127.0.0.1:502",
        line="modbus_tcp",
        wire_faults=(LATE,),
        wire_fault_chance=0.25,
    )
    assert decode(encode(state), BenchState) == state


@pytest.mark.parametrize("diameter", [0.0, -1.0, float("inf"), float("nan")])
def test_an_impossible_object_is_refused_on_arrival(diameter: float) -> None:
    octets = encode(
        {
            "type": "PlaceObject",
            "kind": {
                "diameter": diameter,
                "stiffness": 1e5,
                "mass": 0.058,
                "friction": 0.4,
                "damage_force": 35.0,
            },
        }
    )
    with pytest.raises((BadReply, InputError)):
        decode(octets, Request)  # type: ignore[arg-type]
