"""Bytes that Arrow reads, and columns of its tables as NumPy arrays."""

from collections.abc import Collection, Mapping

import numpy as np
import pyarrow as pa
import pyarrow.compute as pc

from gripperd.model.track import Array
from gripperd.recordings.table import Words


def stream(content: bytes) -> pa.BufferReader:
    """Give content to Arrow, in memory of its own.

    A worker thread of Arrow may let go of what it read when the interpreter is already
    ending; of Python's memory it cannot then, and the process aborts (apache/arrow
    issue 34314).
    """
    memory = pa.allocate_buffer(len(content))
    memoryview(memory).cast("B")[:] = content
    return pa.BufferReader(memory)


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
