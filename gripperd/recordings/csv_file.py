"""Tables in CSV, as RFC 4180 has them: commas, a decimal point, UTF-8."""

import csv
import re
from codecs import BOM_UTF8
from collections.abc import Collection, Iterator
from dataclasses import dataclass
from functools import partial
from itertools import islice

import pyarrow as pa
import pyarrow.csv

from gripperd.config.complaint import printable
from gripperd.errors import InputError
from gripperd.recordings.arrow import columns_of, stream
from gripperd.recordings.table import Table

EMPTY = ("", "nan", "NaN", "NAN", "NA", "N/A", "null", "NULL", "None")
"""Cells that mean "not measured"."""
# What matched once is not tried shorter: a cell may be as long as a file.
NUMBER = re.compile(
    r"[-+]?(([0-9]++\.?+[0-9]*+|\.[0-9]++)(e[-+]?[0-9]++)?|inf|infinity)",
    re.IGNORECASE,
)
DECIMAL_COMMA = re.compile(r"[-+]?[0-9]++,[0-9]++")
ENDING = re.compile(rb"\r\n|\n|\r")
ROW = re.compile(
    rb"""
    ((?:
        ,?+ (?: "(?:[^"]|"")*+" | (?P<unclosed>") )?+ [^,\r\n]*+
    )*+)
    (?: \r\n | \n | \r | \Z )
    """,
    re.VERBOSE,
)
"""Its cells; a quoted one may have ends of lines in it."""
SEPARATORS = {";": "semicolons", "\t": "tabs"}
NOT_UTF8 = "is not UTF-8 text; save it as such"
LONGEST_HEADER = 100_000
"""Bytes."""


@dataclass(frozen=True, slots=True)
class CsvFile:
    """The content of a CSV file; `names` are those of its first line."""

    source: str
    content: bytes
    names: tuple[str, ...]

    @classmethod
    def opened(cls, source: str, content: bytes) -> "CsvFile":
        """Read the line with the names.

        Raises
        ------
        InputError
            There is none, or this is another kind of file.
        """
        content = content.removeprefix(BOM_UTF8)
        first = next(_rows(content), None)
        if first is None:
            raise _refused(source, "is empty")
        number, line = first[0], first[1][1]
        if b"\0" in content[:LONGEST_HEADER] or len(line) > LONGEST_HEADER:
            raise _refused(source, "is neither a CSV file in UTF-8 nor Parquet")
        place = f"{source}:{number}"
        try:
            text = line.decode()
        except UnicodeDecodeError:
            raise _refused(place, NOT_UTF8) from None
        names = tuple(name.strip() for name in _cells(text))
        for separator, plural in SEPARATORS.items():
            if len(names) == 1 and separator in text:
                detail = (
                    f"cells are separated by {plural}; separate them by commas and "
                    "write decimals with a point"
                )
                raise _refused(place, detail)
        return cls(source, content, names)

    def table(self, words: Collection[str], numbers: Collection[str]) -> Table:
        """Read those of the columns of text and of numbers that are there.

        Raises
        ------
        InputError
            A line is no row of the table, or a cell is no number.
        """
        kinds = {name: pa.string() for name in words if name in self.names}
        kinds |= {name: pa.float64() for name in numbers if name in self.names}
        header, _ = next(_rows(self.content))
        if number := _unclosed(self.content):
            raise _refused(f"{self.source}:{number}", "a quote opens and never closes")
        try:
            table = pyarrow.csv.read_csv(
                stream(self.content),
                pyarrow.csv.ReadOptions(column_names=self.names, skip_rows=header),
                convert_options=pyarrow.csv.ConvertOptions(
                    column_types=kinds, include_columns=kinds, null_values=EMPTY
                ),
            )
        except pa.ArrowInvalid as broken:
            raise self._misprint(numbers) or _refused(
                self.source, f"is no table: {printable(str(broken))}"
            ) from None
        return Table(
            self.source, *columns_of(table, words, numbers), partial(_place, self)
        )

    def _misprint(self, numbers: Collection[str]) -> InputError | None:
        """Find the first line that cannot be read, and say why."""
        for number, row in islice(_rows(self.content), 1, None):
            place = f"{self.source}:{number}"
            try:
                cells = _cells(row[1].decode())
            except UnicodeDecodeError:
                return _refused(place, NOT_UTF8)
            if len(cells) != len(self.names):
                detail = f"{len(cells)} cells under {len(self.names)} names"
                return _refused(place, detail)
            for name, cell in zip(self.names, cells, strict=True):
                if name in numbers and not _is_number(cell):
                    return _refused(f"{place}: {name}", _no_number(cell))
        return None


def _rows(content: bytes) -> Iterator[tuple[int, re.Match[bytes]]]:
    """Give every row that is not empty, with the number from 1 of its first line."""
    number = 1
    for row in ROW.finditer(content):
        if row[1]:
            yield number, row
        number += len(ENDING.findall(row[0])) if b'"' in row[1] else 1


def _unclosed(content: bytes) -> int | None:
    """Number of the first line with a quote that nothing closes."""
    if b'"' not in content:
        return None
    return next((number for number, row in _rows(content) if row["unclosed"]), None)


def _place(file: CsvFile, row: int) -> str:
    number, _ = next(islice(_rows(file.content), row + 1, None))
    return f"{file.source}:{number}"


def _cells(line: str) -> list[str]:
    try:
        return next(csv.reader([line]))
    except csv.Error:
        return [line]


def _is_number(cell: str) -> bool:
    return cell in EMPTY or NUMBER.fullmatch(cell.strip()) is not None


def _no_number(cell: str) -> str:
    detail = f'"{printable(cell)}" is not a number'
    if DECIMAL_COMMA.fullmatch(cell.strip()):
        return f"{detail}; write decimals with a point"
    return detail


def _refused(place: str, detail: str) -> InputError:
    return InputError(f"{place}: {detail}")
