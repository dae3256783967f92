"""What is asked: a mixture of cases that depends on nothing but a seed."""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from itertools import count

import numpy as np

from tests.hidden_rig import ARTEFACTS, NAMES, OUTSIDE

MIXTURE: Mapping[str, int] = {
    "single": 80,
    "pair": 24,
    "none": 30,
    "drift": 24,
    "outside": 24,
    "artefact": 16,
}
"""Parts of each kind of case."""

ONE_OF = {"single": NAMES, "outside": OUTSIDE, "artefact": ARTEFACTS}
"""Kinds that hide one thing, and what it may be; the seed of a case draws the rest."""


@dataclass(frozen=True, slots=True)
class Question:
    """One case to solve."""

    family: str
    kind: str
    names: tuple[str, ...]
    """What the rig shall hide; none for what its seed draws."""
    seed: int


def questions(family: str, cases: int, seed: int) -> list[Question]:
    """Draw a mixture of which every beginning is a mixture as well.

    Names come in turn, so that none is asked twice before all were asked once.
    """
    random = np.random.default_rng(seed)
    names = {kind: _in_turn(list(pool), random) for kind, pool in ONE_OF.items()}
    asked = dict.fromkeys(MIXTURE, 0)
    drawn = []
    for number in range(cases):
        kind = min(MIXTURE, key=lambda one: (asked[one] + 0.5) / MIXTURE[one])
        asked[kind] += 1
        chosen = (next(names[kind]),) if kind in names else ()
        drawn.append(Question(family, kind, chosen, 100_000 * seed + number))
    return drawn


def _in_turn(pool: list[str], random: np.random.Generator) -> Iterator[str]:
    for _ in count():
        yield from (str(name) for name in random.permutation(pool))
