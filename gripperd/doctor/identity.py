"""Which described module something is, as far as reading it can tell."""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from enum import StrEnum
from typing import TypeAlias

from gripperd.protocol.modules import InputModule, OutputModule

AnyModule: TypeAlias = OutputModule | InputModule


class Certainty(StrEnum):
    """How sure it is."""

    NAMED = "named"
    """It says its own type."""
    LIKELY = "likely"
    """Codes that only this description knows are where it expects them."""
    POSSIBLE = "possible"
    """Its registers can be read and hold what they may; others' could as well."""
    AMBIGUOUS = "ambiguous"
    """Several descriptions fit as well."""
    UNKNOWN = "unknown"


@dataclass(frozen=True, slots=True)
class Identity:
    """What something is taken for."""

    certainty: Certainty
    modules: tuple[AnyModule, ...]
    """Every description that fits best; where it is not ambiguous, all mean the same.
    """
    grounds: str
    """Why, for a person."""

    @property
    def module(self) -> AnyModule | None:
        """The description to go by, if there is one."""
        if self.certainty in {Certainty.AMBIGUOUS, Certainty.UNKNOWN}:
            return None
        return self.modules[0]


@dataclass(frozen=True, slots=True)
class Match:
    """A description that fits, and what speaks for it beyond that."""

    module: AnyModule
    agreements: tuple[str, ...]


def named(said: str, found: Iterable[AnyModule]) -> Identity:
    """Identity of what says its type, given the descriptions that bear it."""
    grounds, modules = f'it says that it is "{said}"', tuple(found)
    if not modules:
        return Identity(Certainty.UNKNOWN, (), f"{grounds}, which is not described")
    certainty = Certainty.NAMED if _alike(modules) else Certainty.AMBIGUOUS
    return Identity(certainty, modules, grounds)


def matched(matches: Sequence[Match]) -> Identity:
    """Identity of what does not say its type."""
    if not matches:
        return Identity(Certainty.UNKNOWN, (), "no description fits what can be read")
    most = max(len(match.agreements) for match in matches)
    best = [match for match in matches if len(match.agreements) == most]
    modules = tuple(match.module for match in best)
    grounds = "; ".join(best[0].agreements) or "what it holds can be read, no more"
    if not _alike(modules):
        return Identity(Certainty.AMBIGUOUS, modules, grounds)
    return Identity(Certainty.LIKELY if most else Certainty.POSSIBLE, modules, grounds)


def _alike(modules: Sequence[AnyModule]) -> bool:
    """Whether all are driven alike, so that it does not matter which it is."""
    first, *others = (
        (each.modbus, each.phrases, dict(each.ranges)) for each in modules
    )
    return all(other == first for other in others)
