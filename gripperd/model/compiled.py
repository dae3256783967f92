"""Machine code for loops that cannot be written without a loop."""

from collections.abc import Callable
from functools import cache
from typing import Any, TypeVar

Loop = TypeVar("Loop", bound=Callable[..., object])


def compiled(loop: Loop) -> Loop:
    """Compile a loop over arrays, once, and keep the result on disk.

    Importing numba takes half a second and 60 MB; who has no such loop does not pay.
    """
    machine: Loop = _machine(loop)
    return machine


@cache
def _machine(loop: Callable[..., object]) -> Any:  # noqa: ANN401  (numba has no types)
    from numba import njit

    return njit(cache=True)(loop)
