"""What the seed decides about a case."""

from dataclasses import dataclass

import numpy as np

from tests.hidden_rig.hidden import NAMES, OUTSIDE, PLACES

KINDS = ("none", "drift", "single", "pair", "outside", "artefact")
ARTEFACTS = ("offset_80ms", "slack_clipped", "quantised_8bit", "tight_tolerances")
FAMILIES = ("A", "B")

SPREAD = 0.02
"""As-built constants are off by up to this fraction, uniformly."""


@dataclass(frozen=True)
class Draw:
    """What the seed decided about a case."""

    names: tuple[str, ...]
    strengths: tuple[float, ...]
    signed: bool
    tolerance: float | None
    drifts: bool
    tells_noise: bool
    rounded: bool
    """Whether a crank drives the sweeps, and no spindle."""

    @property
    def tight(self) -> bool:
        """Whether the constants are off by three times the stated tolerance."""
        return "tight_tolerances" in self.names


def draw_case(
    kind: str,
    names: tuple[str, ...],
    strength: float | None,
    random: np.random.Generator,
) -> Draw:
    """Draw what the caller left open.

    Raises
    ------
    ValueError
        The names are not of that kind, or not as many as it takes.
    """
    choices: dict[str, tuple[tuple[str, ...], int]] = {
        "single": (NAMES, 1),
        "pair": (NAMES, 2),
        "outside": (OUTSIDE, 1),
        "artefact": (ARTEFACTS, 1),
    }
    pool, count = choices.get(kind, ((), 0))
    drawn = (
        tuple(str(n) for n in random.choice(pool, count, replace=False)) if pool else ()
    )
    chosen = names or drawn
    if len(chosen) != count or not set(chosen) <= set(pool):
        raise ValueError(f"{kind!r} takes {count} of {pool}, not {chosen}")
    shares = random.random(count)
    strengths = [_usual(n, s) for n, s in zip(chosen, shares, strict=True)]
    tight = "tight_tolerances" in chosen
    stated = bool(random.random() < 0.5) or tight
    wanders = bool(random.random() < 1 / 3)
    usual = SPREAD / np.sqrt(3)
    return Draw(
        names=chosen,
        strengths=tuple(strengths if strength is None else [strength] * count),
        signed=bool(random.random() < 0.5) and "slack_clipped" not in chosen,
        tolerance=(0.005 if tight else usual) if stated else None,
        drifts=kind == "drift" or (kind != "none" and wanders),
        tells_noise=bool(random.random() < 0.5),
        # Of a stream of its own: every other draw of a seed stays as it was.
        rounded=bool(random.spawn(1)[0].random() < 1 / 3),
    )


def _usual(name: str, share: float) -> float:
    low, high = PLACES[name].usual if name in PLACES else (0.0, 0.0)
    return low + (high - low) * float(share)
