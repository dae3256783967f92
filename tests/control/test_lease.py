import pytest

from gripperd.control.command import GraspOrder, Status
from gripperd.control.journal import Happening
from gripperd.control.lease import Tenancy
from gripperd.control.snapshot import Instant
from gripperd.control.states import Grip, Machine
from gripperd.errors import Refused
from gripperd.link.lease import TakeLease, respond

from .stage import Stage, real


def at(seconds: float) -> Instant:
    return Instant(seconds, 1e9 + seconds)


@pytest.fixture
def tenancy() -> Tenancy:
    """Taken by Ann for 10 s at 100 s."""
    tenancy = Tenancy()
    tenancy.take("Ann", "a", 10.0, at(100.0))
    return tenancy


def test_nobody_needs_a_lease_while_there_is_none() -> None:
    Tenancy().check(None, at(0.0))


def test_only_the_owner_passes(tenancy: Tenancy) -> None:
    tenancy.check("a", at(105.0))
    for token in (None, "b", ""):
        with pytest.raises(Refused, match=r"Ann has .* another 5\.0 s") as no:
            tenancy.check(token, at(105.0))
        assert no.value.code == "leased"


def test_people_see_its_end_by_the_clock_as_it_is_now(tenancy: Tenancy) -> None:
    lease = tenancy.lease(Instant(105.0, 2e9))
    assert lease is not None
    assert (lease.due, lease.expires_at) == (110.0, 2e9 + 5.0)


def test_the_owner_renews_and_nobody_else_takes(tenancy: Tenancy) -> None:
    with pytest.raises(Refused, match="Ann"):
        tenancy.take("Bob", "b", 10.0, at(105.0))
    lease = tenancy.take("Ann", "a", 10.0, at(105.0))
    assert (lease.due, lease.expires_at) == (115.0, 1e9 + 115.0)


def test_at_its_end_it_is_over_for_its_owner_too(tenancy: Tenancy) -> None:
    tenancy.check("a", at(109.999))
    with pytest.raises(Refused, match="your lease is over") as refused:
        tenancy.check("a", at(110.0))
    assert refused.value.code == "lease-lost"
    tenancy.check(None, at(110.0))
    assert tenancy.take("Bob", "b", 10.0, at(110.0)).owner == "Bob"


def test_its_end_is_told_once(tenancy: Tenancy) -> None:
    assert tenancy.run_out(at(109.0)) is None
    ended = tenancy.run_out(at(110.0))
    assert ended is not None
    assert ended.owner == "Ann"
    assert tenancy.run_out(at(111.0)) is None


def test_a_lease_that_was_given_up_does_not_run_out(tenancy: Tenancy) -> None:
    with pytest.raises(Refused):
        tenancy.give_up("b", at(101.0))
    tenancy.give_up("a", at(101.0))
    assert tenancy.lease(at(102.0)) is None
    assert tenancy.run_out(at(200.0)) is None


def test_when_it_runs_out_what_moves_is_frozen(ready: Stage, apple: GraspOrder) -> None:
    ready.gripper.permission.tenancy.take("Ann", "a", 0.5, ready.instant)
    running = ready.submit(apple)
    waiting = ready.submit(None)
    ready.run(0.7)
    for command in (running, waiting):
        assert ready.command(command).status is Status.CANCELLED
        assert ready.failure(command).code == "lease-lost"
    ready.run(1.0)
    assert ready.state.machine is Machine.READY
    count = len(ready.writes)
    ready.run(1.0)
    assert len(ready.writes) == count


def test_when_it_runs_out_what_is_held_stays_held(holding: Stage) -> None:
    current = holding.rig.plant.current
    holding.gripper.permission.tenancy.take("Ann", "a", 0.5, holding.instant)
    holding.run(3.0)
    assert holding.state.grip is Grip.HOLDING
    assert holding.rig.plant.current == pytest.approx(current, abs=2e-4)


def test_what_is_given_after_its_end_does_not_end_with_it(ready: Stage) -> None:
    ready.gripper.permission.tenancy.take("Ann", "a", 0.5, ready.instant)
    ready.pass_time(0.5)
    given = ready.submit(None)
    ready.run(3.0)
    assert ready.command(given).status is Status.SUCCEEDED


def test_the_next_owner_does_not_inherit_what_moves(
    ready: Stage, apple: GraspOrder
) -> None:
    ready.gripper.permission.tenancy.take("Ann", "a", 0.5, ready.instant)
    running = ready.submit(apple)
    ready.run(0.3)
    assert ready.command(running).status is Status.RUNNING
    late = at(ready.instant.monotonic + 0.5)
    respond(TakeLease("g0", "Bob", "b", 60.0), ready.gripper, late)
    assert ready.failure(running).code == "lease-lost"
    leases = [
        entry.text
        for entry in ready.gripper.ledger.journal.since(0)
        if entry.kind is Happening.LEASE
    ]
    assert leases == ["the lease of Ann ran out", "Bob took the lease for 60 s"]


def test_nothing_ends_before_its_time(ready: Stage, apple: GraspOrder) -> None:
    ready.rig.plant.place(real(apple.profile))
    ready.gripper.permission.tenancy.take("Ann", "a", 60.0, ready.instant)
    assert ready.complete(apple).status is Status.SUCCEEDED
