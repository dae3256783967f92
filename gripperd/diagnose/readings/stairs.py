"""Stairs: a pressure that rests while its command goes on, and then catches up.

A spool that sticks holds its place until the command is far enough away, and goes there
at once. Where a command rises or falls steadily, a pressure that follows it late, along
a bow, against a ceiling or behind a play does neither; one that swings does some of it.

References
----------
.. [1] Q. P. He, J. Wang, M. Pottmann, S. J. Qin, "A curve fitting method for detecting
       valve stiction in oscillating control loops", Ind. Eng. Chem. Res. 46(13),
       4549-4560, 2007: static and kinetic friction of a spool.
"""

from collections.abc import Iterator, Sequence
from itertools import pairwise
from typing import NamedTuple

import numpy as np

from gripperd.diagnose.noise.model import Noise, coarse_step, quick_noise
from gripperd.diagnose.readings.level import MOVES
from gripperd.diagnose.readings.travel import travel
from gripperd.model.track import Array

SEEN = 6.0
"""Way of the command that is clear of the noise, in standard deviations. [-]"""
RESTS, CATCHES = 1 / 3, 5 / 3
"""Share of that way below which a pressure rests, and above which it catches up. [-]"""
SETTLED = 10
"""Samples in which a pressure may still go to where its command rests."""
MANY = 40
"""Pairs of samples that tell."""
ENOUGH = 200
"""Samples at rest that tell a noise and its memory."""
STILL, CAUGHT = 0.25, 0.1
"""Least shares of them. Of 640 recordings of five rigs the four whose spool sticks by
more than 6 times the noise have 0.32 and 0.14 or more; of the others one that lets the
pulse of a compressor through has 0.18 and 0.13, two whose regulator hunts 0.15 and
0.07, and none of the rest both 0.06 and 0.04. [-]"""


class Sweep(NamedTuple):
    """What was asked of a regulator, and what came of it, shape ``(n,)`` each."""

    current: Array
    """[A]"""
    pressure: Array
    """NaN where it is not known. [Pa]"""


class _Stairs(NamedTuple):
    """How many pairs of samples were looked at, and in how many a pressure did so."""

    pairs: int = 0
    still: int = 0
    caught: int = 0


def noise_on_stairs(sweeps: Sequence[Sweep]) -> Noise | None:
    """Noise of a pressure that goes in stairs; none where it does not.

    Told from where the command rests: neighbours on a stair know less of each other.
    """
    known = [one for sweep in sweeps if (one := _known(sweep)).current.size]
    rests = [rest for sweep in known for rest in _rests(sweep)]
    current = np.concatenate([np.empty(0), *(sweep.current for sweep in known)])
    if not rests or np.ptp(current) < MOVES:
        return None
    pressure = np.concatenate([sweep.pressure for sweep in known])
    noise = quick_noise(rests, coarse_step(rests))
    gain = float(np.polyfit(current, pressure, 1)[0])
    total = [
        _along(*leg, SEEN * noise.std) for sweep in known for leg in _legs(sweep, gain)
    ]
    pairs, still, caught = (sum(each) for each in zip(_Stairs(), *total, strict=True))
    climbs = still >= STILL * pairs and caught >= CAUGHT * pairs
    return noise if pairs >= MANY and climbs else None


def noise_at_rest(sweeps: Sequence[Sweep]) -> Noise | None:
    """Noise of a pressure where its command rests; none where it seldom does.

    Ramps that turn every second, or are read at times that jitter, look like a noise
    that remembers. In 296 recordings of three rigs it was 0.96 to 1.09 of what had been
    put in (2nd to 98th percentile), and that of whole sweeps 1.05 to 1.86.
    """
    rests = [rest for sweep in sweeps for rest in _rests(_known(sweep))]
    if sum(rest.size for rest in rests) < ENOUGH:
        return None
    return quick_noise(rests, coarse_step(rests))


def _known(sweep: Sweep) -> Sweep:
    known = np.isfinite(sweep.current) & np.isfinite(sweep.pressure)
    return Sweep(sweep.current[known], sweep.pressure[known])


def _rests(sweep: Sweep) -> Iterator[Array]:
    """Give the pressure where the command rests, once it has settled."""
    moves = np.flatnonzero(np.abs(np.diff(sweep.current)) > MOVES) + 1
    for rest in np.split(sweep.pressure, moves):
        if rest.size > 2 * SETTLED:
            yield rest[SETTLED:]


def _legs(sweep: Sweep, gain: float) -> Iterator[tuple[Array, Array]]:
    """Give command and pressure between turns of the command, both as if they rose."""
    signs = travel(sweep.current, MOVES)
    cuts = [0, *(np.flatnonzero(np.diff(signs)) + 1).tolist(), signs.size]
    for start, end in pairwise(cuts):
        if end > start and signs[start]:
            command = gain * sweep.current[start:end]
            yield signs[start] * command, signs[start] * sweep.pressure[start:end]


def _along(command: Array, pressure: Array, seen: float) -> _Stairs:
    """Count between the first move of the pressure and its last.

    What it waits for before, and is held up by after, are other causes' as well.
    """
    between = (pressure > pressure[0] + seen) & (pressure < pressure[-1] - seen)
    moves = np.flatnonzero(between)
    if moves.size < 2:
        return _Stairs()
    part = slice(moves[0], moves[-1] + 1)
    command, pressure = command[part], pressure[part]
    after = np.searchsorted(np.maximum.accumulate(command), command + seen)
    before = np.flatnonzero(after < command.size)
    asked, went = (one[after[before]] - one[before] for one in (command, pressure))
    still, caught = np.sum(went < RESTS * asked), np.sum(went > CATCHES * asked)
    return _Stairs(asked.size, int(still), int(caught))
