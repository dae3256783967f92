from pathlib import Path

import numpy as np
import pyarrow as pa
import pyarrow.parquet
import pytest

from gripperd.recordings import read_recording
from tests.recordings.conftest import Complaint, Write, good


def _written(tmp_path: Path, table: pa.Table) -> Path:
    path = tmp_path / "rig.parquet"
    pyarrow.parquet.write_table(table, path)
    return path


def test_parquet_reads_like_the_same_csv(tmp_path: Path, write: Write) -> None:
    (run,) = read_recording(_written(tmp_path, pa.table(good()))).runs
    (same,) = read_recording(write(good())).runs
    assert run.name == same.name
    for key, values in same.columns.items():
        np.testing.assert_allclose(run.columns[key], values, rtol=1e-12)


def test_narrow_types_and_nulls_are_read(tmp_path: Path) -> None:
    columns = good()
    table = pa.table(
        columns
        | {
            "run": pa.array(columns["run"]).dictionary_encode(),
            "force_N": pa.array(range(30), pa.int16()),
            "pressure_kPa": pa.array([None, *range(101, 130)], pa.float32()),
        }
    )
    (run,) = read_recording(_written(tmp_path, table)).runs
    assert run.name == "h0.10"
    assert run.columns["force"][29] == 29.0
    assert np.isnan(run.columns["pressure"][0])
    assert run.columns["pressure"][1] == 101e3


def test_a_name_that_is_no_text_is_refused(
    tmp_path: Path, complaint: Complaint
) -> None:
    path = _written(tmp_path, pa.table(good() | {"run": [b"\xff\xfeA"] * 30}))
    assert complaint(path) == (
        "rig.parquet: is a damaged Parquet file: Invalid UTF8 payload"
    )


@pytest.mark.parametrize(
    ("column", "values", "kind"),
    [
        ("force_N", ["x"] * 30, "string"),
        ("t_s", pa.array(range(30), pa.timestamp("ms")), "timestamp[ms]"),
        ("force_N", [[1.0]] * 30, "list<"),
        ("run", [[1.0]] * 30, "list<"),
    ],
)
def test_a_column_of_another_type_is_refused(
    tmp_path: Path, complaint: Complaint, column: str, values: object, kind: str
) -> None:
    path = _written(tmp_path, pa.table(good() | {column: values}))
    message = complaint(path)
    assert message.startswith(f"rig.parquet: column {column} holds {kind}")
    assert message.endswith(" expected")


def test_rows_are_named_where_there_are_no_lines(
    tmp_path: Path, complaint: Complaint
) -> None:
    columns = good()
    columns["t_s"][5] = 0.0
    path = _written(tmp_path, pa.table(columns))
    assert complaint(path).startswith("rig.parquet: row 6: t_s runs backwards")


def test_few_bytes_cannot_stand_for_too_many_rows(
    tmp_path: Path, complaint: Complaint
) -> None:
    rows = 10_000_001
    path = _written(tmp_path, pa.table({"t_s": pa.array(np.zeros(rows, np.int8))}))
    assert path.stat().st_size < 1_000_000
    assert complaint(path) == "rig.parquet: 10000001 rows are more than 10000000"


def test_a_damaged_file_is_refused(tmp_path: Path, complaint: Complaint) -> None:
    path = _written(tmp_path, pa.table(good()))
    content = bytearray(path.read_bytes())
    path.write_bytes(content[:-40])
    assert complaint(path).startswith("rig.parquet: is a damaged Parquet file")
    content[10:200] = bytes(190)
    path.write_bytes(content)
    assert complaint(path).startswith("rig.parquet: is a damaged Parquet file")
