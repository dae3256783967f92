"""Both halves of a line, and how to try them."""

import random
from collections.abc import Callable
from dataclasses import dataclass
from typing import Generic, TypeAlias, TypeVar

from gripperd.errors import BadReply, DeviceRefused
from gripperd.protocol.modbus import Refusal

from .octets import mutated, noise

Case: TypeAlias = Callable[[random.Random], str]
"""Makes one input, tries it, and says in a word what became of it."""

Q = TypeVar("Q")
R = TypeVar("R")


@dataclass(frozen=True)
class Half(Generic[Q, R]):
    """The half of a line that reads replies, and how to try it."""

    requests: tuple[Q, ...]
    length: Callable[[Q, bytes], int | None]
    decode: Callable[[Q, int, bytes], R]
    good: Callable[[random.Random, Q], bytes]
    """A reply that is right, to begin with."""
    repair: Callable[[random.Random, bytes], bytes]
    holds: Callable[[Q, bytes, R], bool]
    """Whether the reply says what was believed."""

    def __call__(self, rng: random.Random) -> str:
        request = rng.choice(self.requests)
        plain = rng.random() < 0.25
        octets = noise(rng) if plain else mutated(rng, self.good(rng, request))
        octets = self.repair(rng, octets)
        try:
            length = self.length(request, octets)
            if length is None:
                self.decode(request, 1, octets)
                raise AssertionError((request, octets, "believed, yet incomplete"))
            assert 0 <= length <= len(octets), (request, octets, length)
            believed = self.decode(request, 1, octets[:length])
        except DeviceRefused:
            return "refused"
        except BadReply:
            return "not believed"
        assert self.holds(request, octets[:length], believed), (request, octets)
        return "believed"


@dataclass(frozen=True)
class OtherHalf(Generic[Q]):
    """The half of a line that reads requests, and how to try it."""

    good: Callable[[random.Random], bytes]
    length: Callable[[bytes], int | None]
    decode: Callable[[bytes], Q]
    repair: Callable[[random.Random, bytes], bytes]
    holds: Callable[[bytes, Q], bool]
    """Whether the request says what was understood."""

    def __call__(self, rng: random.Random) -> str:
        plain = rng.random() < 0.25
        octets = noise(rng) if plain else mutated(rng, self.good(rng))
        octets = self.repair(rng, octets)
        try:
            length = self.length(octets)
        except BadReply:
            return "not followed"
        if length is None:
            return "incomplete"
        assert 0 < length <= len(octets), (octets, length)
        understood = self.decode(octets[:length])
        assert self.holds(octets[:length], understood), octets
        return "refused" if isinstance(understood, Refusal) else "understood"
