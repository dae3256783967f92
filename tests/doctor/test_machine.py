from dataclasses import replace

from gripperd.doctor.finding import Verdict
from gripperd.doctor.machine import Machine, this_machine

SOUND = Machine(
    priority_limit=10,
    sys_nice=False,
    user=1000,
    groups={1000, 20},
    dialout=20,
    synchronised=True,
)


def verdicts(machine: Machine) -> list[Verdict]:
    return [each.result.verdict for each in machine.findings(10)]


def test_a_machine_that_grants_everything_is_in_order() -> None:
    assert verdicts(SOUND) == [Verdict.OK] * 3
    assert verdicts(replace(SOUND, priority_limit=0, sys_nice=True))[0] is Verdict.OK


def test_what_is_not_granted_is_a_warning() -> None:
    poor = replace(SOUND, priority_limit=9, groups={1000}, synchronised=False)
    assert verdicts(poor) == [Verdict.WARNING] * 3
    assert all(each.result.remedy for each in poor.findings(10))


def test_root_needs_no_group_and_a_machine_may_have_none() -> None:
    assert verdicts(replace(SOUND, user=0, groups={0}))[1] is Verdict.OK
    assert verdicts(replace(SOUND, dialout=None))[1] is Verdict.NOT_POSSIBLE


def test_this_machine_can_be_asked() -> None:
    assert len(list(this_machine().findings(10))) == 3
