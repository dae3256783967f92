"""One value or an array of them: the physics is written once for both."""

from collections.abc import Callable
from functools import wraps
from typing import TYPE_CHECKING, TypeAlias, TypeVar

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import NDArray

Real: TypeAlias = "float | NDArray[np.float64]"

Owner = TypeVar("Owner")

CHUNK = 8192
"""Points worked on at once: the temporaries of one pass stay in the L2 cache."""


def positive_part(value: Real) -> Real:
    """Give ``max(value, 0)``, exact; what is not a number stays so."""
    if isinstance(value, np.ndarray):
        return 0.5 * (value + np.abs(value))
    return 0.0 if value < 0 else value


def everywhere(condition: "bool | np.bool_ | NDArray[np.bool_]") -> bool:
    """Tell whether it holds everywhere; numpy's own takes 3 µs for a single bool."""
    return bool(condition.all() if isinstance(condition, np.ndarray) else condition)


def chunked(
    function: Callable[[Owner, Real, Real, Real], Real],
) -> Callable[[Owner, Real, Real, Real], Real]:
    """Let a method of three values walk over large arrays in cache-sized pieces."""

    @wraps(function)
    def walk(owner: Owner, first: Real, second: Real, third: Real) -> Real:
        columns = (first, second, third)
        if not any(isinstance(column, np.ndarray) for column in columns):
            return function(owner, first, second, third)
        shape = np.broadcast_shapes(*(np.shape(column) for column in columns))
        out = np.empty(shape)
        flat = out.reshape(-1)
        if flat.size <= CHUNK:
            out[...] = function(owner, first, second, third)
            return out
        views = [_flattened(column, shape) for column in columns]
        for start in range(0, flat.size, CHUNK):
            piece = slice(start, start + CHUNK)
            a, b, c = (v[piece] if isinstance(v, np.ndarray) else v for v in views)
            flat[piece] = function(owner, a, b, c)
        return out

    return walk


def _flattened(column: Real, shape: tuple[int, ...]) -> Real:
    if isinstance(column, np.ndarray) and column.ndim:
        return np.broadcast_to(column, shape).reshape(-1)
    return float(column)
