"""A recording from its file: read, put into SI, screened."""

from collections.abc import Iterator, Sequence
from hashlib import sha256
from pathlib import Path

from gripperd.diagnose.readings.columns import COLUMNS
from gripperd.diagnose.readings.recording import Recording, Rejection, Run
from gripperd.diagnose.readings.repeats import contradictions
from gripperd.diagnose.readings.screening import screened
from gripperd.errors import InputError
from gripperd.recordings.csv_file import CsvFile
from gripperd.recordings.header import WORDS, judge_names
from gripperd.recordings.parquet_file import MAGIC, ParquetFile
from gripperd.recordings.side_file import read_side_file
from gripperd.recordings.sufficiency import (
    require_enough,
    require_milliamperes,
    require_ratio,
)
from gripperd.recordings.sweeps import sweeps
from gripperd.recordings.table import TableFile

MAX_BYTES = 512 * 2**20


def read_recording(path: Path) -> Recording:
    """Read a recording, CSV or Parquet, with the side file ``<name>.yaml`` if any.

    Raises
    ------
    InputError
        It cannot be used; the message names the file and the line or column.
    """
    content = _content(path)
    file = _opened(str(path), content)
    unread = judge_names(str(path), file.names)
    cut = sweeps(file.table(WORDS, COLUMNS))
    require_ratio(str(path), cut.runs)
    require_milliamperes(str(path), cut.runs)
    side = read_side_file(path.with_suffix(".yaml"), cut.runs)
    runs, rejected = screened(side.labelled(cut.runs))
    require_enough(str(path), runs, cut.rejected, rejected)
    return Recording(
        name=path.stem,
        digest=sha256(content).hexdigest(),
        runs=runs,
        noise=side.noise,
        rejected=(*cut.rejected, *rejected),
        contradictions=contradictions(runs),
        remarks=(*_lost(runs, rejected), *unread, *cut.remarks, *side.remarks),
    )


def _lost(runs: Sequence[Run], rejected: Sequence[Rejection]) -> Iterator[str]:
    """Name the columns of which nothing is believed: they count as not there."""
    for name in dict.fromkeys(entry.column for entry in rejected):
        if not any(run.has(COLUMNS[name].quantity) for run in runs):
            reasons = dict.fromkeys(
                one.reason for one in rejected if one.column == name
            )
            yield f"Every reading of {name} is rejected: {', '.join(reasons)}."


def _content(path: Path) -> bytes:
    try:
        if not path.is_file():
            there = path.exists()
            detail = f"{path}: {'is not a file' if there else 'there is no such file'}"
            raise InputError(detail)
        size = path.stat().st_size
        if size > MAX_BYTES:
            detail = (
                f"{path}: {size / 2**20:.0f} MB are more than {MAX_BYTES / 2**20:.0f} "
                "MB; thin it or cut it into several recordings"
            )
            raise InputError(detail)
        return path.read_bytes()
    except OSError as broken:
        detail = f"{path}: cannot be read: {broken.strerror}"
        raise InputError(detail) from None


def _opened(source: str, content: bytes) -> TableFile:
    if content.startswith(MAGIC):
        return ParquetFile.opened(source, content)
    return CsvFile.opened(source, content)
