"""The state machines as a page of Mermaid diagrams, drawn from their tables.

``python -m gripperd.control.diagram > docs/states.md`` writes the page.
"""

import sys
from collections import defaultdict
from collections.abc import Mapping
from enum import StrEnum
from typing import TypeVar

from gripperd.control.monitors.policy import DETECTION, POLICIES
from gripperd.control.states import GRIPS, TRANSITIONS

State = TypeVar("State", bound=StrEnum)
Cue = TypeVar("Cue", bound=StrEnum)

PAGE = """# States and monitors

Drawn from the tables of the program by
`python -m gripperd.control.diagram > docs/states.md`.

## Machine: what the gripper is allowed to do

{machine}

## Grip: what the jaws are known to hold

{grip}

## Monitors: what is watched

A cause that is not latched is told and changes nothing else. One that is latched leads
to `fault_reaction`, carries out its reaction, and stays in `fault` until it is
acknowledged, its cause is gone and somebody resets it; that leads to `disabled` and
moves nothing. Until then it outlives the control process. The time until it is noticed
holds at 100 Hz and for a change of twice the limit. It counts from the moment a part is
gone, from the current that a valve does not follow, from the pressure at which a
blocked jaw ought to press with the limit: how soon that is reached depends on the
profile. Limit, duration, reaction and latch can be set for each gripper under
`monitors`.

{monitors}

A sensor with wild samples has failed with the third within a second; that takes as long
as they take to come.

## Interlocks: what an open contact does

`not_enabled` and `estopped` are the contacts of `interlocks`, which also sets their
`reaction`. A motion ends in any case, and none begins while a contact is open.

| reaction | what is held or moving |
|---|---|
| `freeze` (as shipped), `hold` | comes to rest where it is; the current stays |
| `controlled_release` | the current ramps down to the live zero: the object drops |
| `vent` | the current goes to the live zero at once: the object drops |

An open `enable` that lets go is latched: `fault`, until it is closed, acknowledged and
reset. Otherwise closing it is enough. An open `estop` leads to `estopped`, whatever
went on before, and is left by closing it and a reset that is refused while the jaws
still open; nobody has to acknowledge it. A cut wire and a dead input are open contacts.
One that is open at the start, or when a lost link comes back, moves nothing: what was
adopted stays until the contact has been closed once.
"""


def diagram(table: Mapping[State, Mapping[Cue, State]]) -> str:
    """Draw one table as a Mermaid state diagram; arrows between the same share one."""
    arrows: dict[tuple[State, State], list[Cue]] = defaultdict(list)
    for state, allowed in table.items():
        for event, target in allowed.items():
            arrows[state, target].append(event)
    lines = [
        f"    {state} --> {target}: {', '.join(events)}"
        for (state, target), events in arrows.items()
    ]
    return "\n".join(["```mermaid", "stateDiagram-v2", *lines, "```"])


def monitors() -> str:
    """List every cause with what counts and what follows, as a Markdown table."""
    rows = [
        f"| `{cause}` | {DETECTION[cause]:g} s | {policy.reaction} |"
        f" {'yes' if policy.latched else 'no'} |"
        for cause, policy in POLICIES.items()
    ]
    head = ["| cause | noticed within | reaction | latched |", "|---|---|---|---|"]
    return "\n".join([*head, *rows])


def page() -> str:
    """Write the whole page."""
    return PAGE.format(
        machine=diagram(TRANSITIONS), grip=diagram(GRIPS), monitors=monitors()
    )


if __name__ == "__main__":
    sys.stdout.write(page())
