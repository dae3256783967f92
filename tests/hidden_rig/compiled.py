"""Machine code for the integration loops."""

from collections.abc import Callable
from typing import TypeVar

from numba import njit

Function = TypeVar("Function", bound=Callable[..., object])


def compiled(function: Function) -> Function:
    """Compile at the first call of a process.

    Nothing is kept on disk: numba would not notice a change in a function called
    from another file, and a stale truth is worse than a slow one.
    """
    machine: Function = njit(function)
    return machine
