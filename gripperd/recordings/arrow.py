"""Columns of an Arrow table as NumPy arrays."""

from collections.abc import Collection, Mapping

import numpy as np
import pyarrow as pa
import pyarrow.compute as pc

from gripperd.model.track import Array
from gripperd.recordings.table import Words


def columns_of(
    table: pa.Table, words: Collection[str], numbers: Collection[str]
) -> tuple[Mapping[str, Words], Mapping[str, Array]]:
    """Give the columns of text and the columns of numbers of a table."""
    there = set(table.column_names)
    return (
        {name: _words(table[name]) for name in words if name in there},
        {name: _numbers(table[name]) for name in numbers if name in there},
    )


def _words(column: pa.ChunkedArray) -> Words:
    text = pc.utf8_trim_whitespace(pc.fill_null(column.cast(pa.string()), ""))
    encoded = text.combine_chunks().dictionary_encode()
    codes = np.asarray(encoded.indices, dtype=np.int64)
    return Words(codes, tuple(encoded.dictionary.to_pylist()))


def _numbers(column: pa.ChunkedArray) -> Array:
    values = pc.fill_null(column.cast(pa.float64(), safe=False), float("nan"))
    return np.array(values.to_numpy(), dtype=np.float64)
