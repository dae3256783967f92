"""Effects at work on one signal, each with its memory."""

from collections.abc import Iterable
from copy import deepcopy

import numpy as np

from gripperd.model.effect import Effect
from gripperd.model.track import Track


class ActiveEffects:
    """Effects that change a signal one after the other, sample by sample.

    Parameters
    ----------
    effects
        In the order in which they act.
    """

    __slots__ = ("_effects", "_memories")

    def __init__(self, effects: Iterable[Effect]) -> None:
        self._effects = tuple(effects)
        self._memories = [effect.rest() for effect in self._effects]

    def __bool__(self) -> bool:
        """Whether there are any."""
        return bool(self._effects)

    def along(self, value: float, now: Track) -> float:
        """Signal with the effects. [SI].

        Parameters
        ----------
        value
            Without them.
        now
            One sample of what the rig goes through; it is remembered.
        """
        signal = np.array([value])
        for effect, memory in zip(self._effects, self._memories, strict=True):
            signal = effect.along(signal, now, memory)
        return float(signal[0])

    def ahead(self, value: float, now: Track) -> float:
        """Signal with the effects, without remembering the sample. [SI]."""
        kept = deepcopy(self._memories)
        ahead = self.along(value, now)
        self._memories = kept
        return ahead
