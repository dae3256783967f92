"""What an explanation still lacks, where sweeps that were left out show that it does.

What the search adds to a first effect has a price, for no formula is that of nature and
any other mends it a little. Sweeps that took no part are nobody's to mend: where they
are off by far more than noise, and something that the search left alone takes much of
that away, the price is paid.

References
----------
.. [1] M. Stone, "Cross-validatory choice and assessment of statistical predictions",
       J. R. Stat. Soc. B 36(2), 111-147, 1974.
"""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from gripperd.diagnose.fit.candidates import Candidate
from gripperd.diagnose.fit.rival import Rival
from gripperd.diagnose.readings.recording import Recording
from gripperd.diagnose.residuals.holdout import Split
from gripperd.diagnose.residuals.problem import Problem
from gripperd.diagnose.search.belief import MOST
from gripperd.diagnose.search.found import Found
from gripperd.diagnose.search.price import is_seen
from gripperd.diagnose.search.rivalry import Contest, contest
from gripperd.diagnose.search.stepwise import additions
from gripperd.diagnose.verdict.gap import Gap, gaps
from gripperd.diagnose.verdict.initial_state import with_fitted_state
from gripperd.diagnose.verdict.key import plain

HEARD = 4
"""Additions that are fitted in full."""
CLOSED = 2 / 3
"""Share of what is open that an addition closes at least. On three rigs nobody here had
seen what was missing closed 0.75 or more; where nothing was but the form of what was
named, no addition closed more than 0.45. [-]"""


def completed(
    parts: Split,
    inside: Problem,
    found: Found,
    best: Contest,
    listed: Sequence[Candidate],
) -> Contest:
    """Add what an explanation lacks, for as long as what was left out shows it.

    Parameters
    ----------
    parts
        What was searched, and what was not.
    inside
        Of the latter what lies within the former.
    found, best
        The search and its outcome.
    listed
        What could be missing.
    """
    while 0 < len(best.best.candidates) < MOST:
        told = best.best
        if not any(gap.is_open for gap in _compared(parts, inside, told, told)):
            break
        # What bears its name by right comes first.
        ranked = {
            (not one.is_misnamed, _closed(_compared(parts, inside, told, one))): one
            for one in additions(found, told, listed, HEARD)
            if is_seen(found.problem, told, one)
        }
        closing = [rank for rank in ranked if rank[1] >= CLOSED]
        if not closing:
            break
        champion = ranked[max(closing)]
        best = contest(replace(found, best=champion), listed)
        if len(best.best.candidates) <= len(told.candidates):
            break
    return best


def remarked(recording: Recording, told: Contest, more: Contest) -> Recording:
    """Say which names sweeps that were left out have helped to choose.

    Parameters
    ----------
    recording
        What was diagnosed.
    told, more
        The outcome without what they show, and with it.
    """
    names = [name for name in more.best.names if name not in told.best.names]
    if not names:
        return recording
    words = ", ".join(map(plain, names))
    remark = f"{words}: chosen with the help of sweeps held out."
    return replace(recording, remarks=(*recording.remarks, remark))


def _compared(parts: Split, inside: Problem, told: Rival, more: Rival) -> list[Gap]:
    """Gaps of what was left out, from one explanation to another."""
    here, there = (with_fitted_state(parts, one.fit.point) for one in (told, more))
    draws = np.random.default_rng(0)
    judged = gaps(inside, (here, here, there), draws)
    return list(judged.values())


def _closed(judged: Sequence[Gap]) -> float:
    """Share that is closed of what is open most; none if anything is spoilt."""
    worst = max(judged, key=lambda one: one.left_open)
    return 0.0 if any(gap.is_spoilt for gap in judged) else worst.closed
