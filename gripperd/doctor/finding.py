"""What one check has found, and what to do about it."""

from dataclasses import dataclass
from enum import StrEnum
from typing import Self


class Verdict(StrEnum):
    """How a check went."""

    OK = "ok"
    WARNING = "warning"
    """It works, and a person should know something."""
    FAILED = "failed"
    NOT_POSSIBLE = "not possible"
    """Nobody can tell from here."""


@dataclass(frozen=True, slots=True)
class Result:
    """How a check went, in words."""

    verdict: Verdict
    said: str
    """What was found."""
    remedy: str = ""
    """What to do, one sentence; "" where nothing is to be done."""

    @classmethod
    def ok(cls, said: str) -> Self:
        """As it should be."""
        return cls(Verdict.OK, said)

    @classmethod
    def warning(cls, said: str, remedy: str) -> Self:
        """Worth knowing."""
        return cls(Verdict.WARNING, said, remedy)

    @classmethod
    def failed(cls, said: str, remedy: str) -> Self:
        """Wrong."""
        return cls(Verdict.FAILED, said, remedy)

    @classmethod
    def not_possible(cls, said: str, remedy: str = "") -> Self:
        """Unknown, and why."""
        return cls(Verdict.NOT_POSSIBLE, said, remedy)


@dataclass(frozen=True, slots=True)
class Finding:
    """A result, and of what."""

    subject: str
    """Such as a gripper, a port or the machine."""
    check: str
    result: Result
