"""Tables in Parquet, with the columns that the CSV would have."""

from collections.abc import Collection
from dataclasses import dataclass

import pyarrow as pa
import pyarrow.parquet
import pyarrow.types

from gripperd.config.complaint import printable
from gripperd.errors import InputError
from gripperd.recordings.arrow import columns_of, stream
from gripperd.recordings.table import Table

MAGIC = b"PAR1"
"""A Parquet file begins and ends with it (Apache Parquet, file format)."""
MAX_ROWS = 10_000_000
"""Few bytes can stand for any number of equal rows."""


@dataclass(frozen=True, slots=True)
class ParquetFile:
    """The content of a Parquet file."""

    source: str
    content: bytes
    names: tuple[str, ...]

    @classmethod
    def opened(cls, source: str, content: bytes) -> "ParquetFile":
        """Read the schema.

        Raises
        ------
        InputError
            The file is damaged, or has too many rows.
        """
        try:
            meta = pyarrow.parquet.read_metadata(stream(content))
            names = tuple(meta.schema.to_arrow_schema().names)
        except (pa.ArrowException, OSError) as broken:
            raise _damaged(source, broken) from None
        if meta.num_rows > MAX_ROWS:
            detail = f"{source}: {meta.num_rows} rows are more than {MAX_ROWS}"
            raise InputError(detail)
        return cls(source, content, names)

    def table(self, words: Collection[str], numbers: Collection[str]) -> Table:
        """Read those of the columns of text and of numbers that are there.

        Raises
        ------
        InputError
            The file is damaged, or a column of numbers holds something else.
        """
        wanted = [name for name in (*words, *numbers) if name in self.names]
        try:
            table = pyarrow.parquet.read_table(stream(self.content), columns=wanted)
        except (pa.ArrowException, OSError) as broken:
            raise _damaged(self.source, broken) from None
        for name in wanted:
            kind = table.schema.field(name).type
            if name in numbers and not _numeric(kind):
                detail = (
                    f"{self.source}: column {name} holds {kind}; numbers are expected"
                )
                raise InputError(detail)
            if name in words and pyarrow.types.is_nested(kind):
                detail = f"{self.source}: column {name} holds {kind}; text is expected"
                raise InputError(detail)
        try:
            columns = columns_of(table, words, numbers)
        except pa.ArrowInvalid as broken:
            raise _damaged(self.source, broken) from None
        return Table(self.source, *columns, lambda row: f"{self.source}: row {row + 1}")


def _numeric(kind: pa.DataType) -> bool:
    tests = ("is_floating", "is_integer", "is_decimal", "is_null")
    return any(getattr(pyarrow.types, test)(kind) for test in tests)


def _damaged(source: str, broken: Exception) -> InputError:
    return InputError(f"{source}: is a damaged Parquet file: {printable(str(broken))}")
