"""A recording to a file: CSV or Parquet, with what the contract puts beside it."""

from pathlib import Path

import numpy as np
import pyarrow as pa
import pyarrow.csv
import pyarrow.parquet
import yaml

from gripperd.diagnose.readings.columns import BY_QUANTITY
from gripperd.diagnose.readings.recording import Recording
from gripperd.errors import InputError
from gripperd.recordings.header import RUN

SUFFIXES = (".csv", ".parquet")


def write_recording(recording: Recording, path: Path) -> None:
    """Write the runs of a recording in the units of the contract.

    What is not measured or not believed becomes an empty cell. Kinds of runs and stated
    noise go into the side file ``<name>.yaml``; there is none without them.

    Raises
    ------
    InputError
        The name of the file ends neither in ``.csv`` nor in ``.parquet``.
    OSError
        It cannot be written.
    """
    if path.suffix not in SUFFIXES:
        detail = f"{path}: recordings are written as {' or '.join(SUFFIXES)}"
        raise InputError(detail)
    table = _table(recording)
    if path.suffix == ".csv":
        pyarrow.csv.write_csv(table, path)
    else:
        pyarrow.parquet.write_table(table, path)
    if beside := _beside(recording):
        text = yaml.safe_dump(beside, sort_keys=False, allow_unicode=True)
        path.with_suffix(".yaml").write_text(text, encoding="utf-8")


def _table(recording: Recording) -> pa.Table:
    names = [run.name for run in recording.runs for _ in range(len(run))]
    columns = {RUN: pa.array(names, pa.string())}
    for quantity, column in BY_QUANTITY.items():
        if any(quantity in run.columns for run in recording.runs):
            values = np.concatenate(
                [
                    run.columns.get(quantity, np.full(len(run), np.nan))
                    for run in recording.runs
                ]
            )
            columns[column.name] = pa.array(column.written(values), from_pandas=True)
    return pa.table(columns)


def _beside(recording: Recording) -> dict[str, object]:
    noise = {
        BY_QUANTITY[quantity].name: std / BY_QUANTITY[quantity].scale
        for quantity, std in recording.noise.items()
    }
    kinds = {run.name: {"kind": run.kind.value} for run in recording.runs if run.kind}
    parts: dict[str, object] = {"noise": noise, "runs": kinds}
    return {key: part for key, part in parts.items() if part}
