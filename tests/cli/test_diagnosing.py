"""The diagnosis from the command line, run for real."""

import json
import os
import subprocess
from collections.abc import Callable
from pathlib import Path
from typing import NamedTuple

import pytest

from gripperd.demo.files import write_rig
from gripperd.demo.hidden import Hidden
from gripperd.diagnose.document import document
from gripperd.store import Versions
from tests.daemon import PATIENCE, START, gripperd, settings_file
from tests.demonstration import SEED, STEP, example


class Done(NamedTuple):
    """A rig with creep, diagnosed with everything that can be asked for."""

    folder: Path
    settings: Path
    output: str
    error: str
    status: int

    def at(self, name: str) -> str:
        return str(self.folder / name)


@pytest.fixture(scope="module")
def done(tmp_path_factory: pytest.TempPathFactory) -> Done:
    folder = tmp_path_factory.mktemp("diagnosis")
    write_rig(folder, Hidden.CREEP, SEED, STEP)
    settings = settings_file(folder)
    ended = gripperd(
        "diagnose", str(folder / "rig.csv"), "--model", str(folder / "model.yaml"),
        "--json", str(folder / "found.json"), "--report", str(folder / "found.html"),
        "--apply", "--seed", str(SEED), "--config", str(settings),
    )  # fmt: skip
    return Done(folder, settings, ended.stdout, ended.stderr, ended.returncode)


def test_a_verdict_is_a_success(done: Done) -> None:
    assert done.status == 0, done.error
    assert done.output.startswith("named  The model lacks creep; ")


def test_the_summary_has_effect_place_and_gap(done: Done) -> None:
    for said in ("time_s", "off by", "recalibrated", "noise floor", "not testable"):
        assert said in done.output


def test_constants_that_moved_are_told(done: Done) -> None:
    told = json.loads(Path(done.at("found.json")).read_text())["constants"]
    moved = [(one["fit"] - one["model"]) / one["tolerance"] for one in told]
    far = [f"{one:+.1f} tolerances" for one in moved if abs(one) > 0.71]
    assert far
    assert all(said in done.output for said in far)


def test_in_a_pipe_there_is_no_progress_and_no_colour(done: Done) -> None:
    assert done.error == ""
    assert "\x1b" not in done.output


def test_another_process_with_the_same_seed_says_the_same(done: Done) -> None:
    model, found = example(Hidden.CREEP)
    here = document(found, model=model.name, program="0.1.0")
    there = json.loads((done.folder / "found.json").read_text())
    assert there == json.loads(json.dumps(here))


def test_what_was_named_is_kept_as_a_version(done: Done) -> None:
    model, _ = example(Hidden.CREEP)
    versions = Versions(done.folder / "state" / "models" / "as-drawn", model)
    version = versions.get(1)
    assert version.model.effects == ()
    assert [each.name for each in version.model.static.effects] == ["creep"]
    assert f"kept as as-drawn-1: {version.model.source}" in done.output


def test_the_page_is_written(done: Done) -> None:
    page = done.folder / "found.html"
    assert page.read_text(encoding="utf-8").startswith("<!doctype html>")
    assert f"wrote {page.resolve().as_uri()}" in done.output


def short(done: Done) -> str:
    """Few rows in which nothing can be missing; it takes a second."""
    text = (done.folder / "rig.csv").read_text().splitlines(keepends=True)
    path = done.folder / "short.csv"
    path.write_text("".join(text[:45]))
    return str(path)


def test_json_on_stdout_stands_alone(done: Done) -> None:
    ended = gripperd(
        "diagnose", short(done), "--model", done.at("model.yaml"), "--json", "-"
    )
    assert ended.returncode == 0, ended.stderr
    assert json.loads(ended.stdout)["verdict"] == "none"


def test_beside_json_on_stdout_it_is_told_what_was_kept(
    done: Done, tmp_path: Path
) -> None:
    ended = gripperd(
        "diagnose", done.at("rig.csv"), "--model", done.at("model.yaml"),
        "--json", "-", "--apply", "--config", str(settings_file(tmp_path)),
    )  # fmt: skip
    assert ended.returncode == 0, ended.stderr
    assert json.loads(ended.stdout)["verdict"] == "named"
    kept = tmp_path / "state/models/as-drawn/1.yaml"
    assert f"kept as as-drawn-1: {kept}" in ended.stderr


def test_nothing_named_is_nothing_applied(done: Done) -> None:
    ended = gripperd(
        "diagnose", short(done), "--model", done.at("model.yaml"), "--apply",
        "--config", str(done.settings),
    )  # fmt: skip
    assert ended.returncode == 1
    assert "error: nothing to apply, the verdict is none" in ended.stderr
    assert ended.stdout.startswith("none  ")


def test_what_is_to_be_written_is_written_though_nobody_reads_on(done: Done) -> None:
    """As behind ``| head -1``: the other end of the pipe is closed at once."""
    page, kept = done.folder / "unread.html", done.folder / "unread"
    asked = (
        "diagnose", done.at("rig.csv"), "--model", done.at("model.yaml"),
        "--report", str(page), "--apply",
    )  # fmt: skip
    reader, writer = os.pipe()
    os.close(reader)
    with os.fdopen(writer, "w") as unread:
        ended = subprocess.run(
            [*START, *asked],
            stdout=unread,
            stderr=subprocess.PIPE,
            text=True,
            timeout=PATIENCE,
            check=False,
            env=os.environ | {"XDG_STATE_HOME": str(kept)},
        )
    assert "Traceback" not in ended.stderr
    assert page.exists()
    assert list(kept.rglob("1.yaml"))


def test_a_model_of_the_same_name_is_not_mixed_with_the_configured(done: Done) -> None:
    text = (done.folder / "model.yaml").read_text()
    other = done.folder / "other.yaml"
    other.write_text(text.replace("name: as-drawn", "name: reference"))
    ended = gripperd(
        "diagnose", short(done), "--model", str(other), "--apply",
        "--config", str(done.settings),
    )  # fmt: skip
    assert ended.returncode == 1
    assert "another model is configured as reference" in ended.stderr
    # Before the work, not after it.
    assert ended.stdout == ""


def cut(column: str) -> Callable[[str], str]:
    """Leave a column out."""

    def without(text: str) -> str:
        rows = [line.split(",") for line in text.splitlines()]
        place = rows[0].index(column)
        return "\n".join(",".join(row[:place] + row[place + 1 :]) for row in rows)

    return without


def filled(text: str) -> str:
    """Put nothing measured into every row."""
    header, *rows = text.splitlines()
    empty = [
        ",".join([*row.split(",")[:2], "nan", "nan", "nan", "nan"]) for row in rows
    ]
    return "\n".join([header, *empty])


def shared(text: str) -> str:
    """Let two muscles stand in one file."""
    header, *rows = text.splitlines()
    named = [f"{row},{'AB'[index % 2]}" for index, row in enumerate(rows)]
    return "\n".join([f"{header},muscle", *named])


def reversed_rows(text: str) -> str:
    """Let time run backwards."""
    header, *rows = text.splitlines()
    return "\n".join([header, *reversed(rows)])


def scaled(
    factor: float, every: int = 1, column: str = "force_N"
) -> Callable[[str], str]:
    """Let a column of every so many runs be read in another unit."""

    def other(text: str) -> str:
        header, *lines = text.splitlines()
        rows = [line.split(",") for line in lines]
        place = header.split(",").index(column)
        names = list(dict.fromkeys(row[0] for row in rows))
        for row in rows:
            if names.index(row[0]) % every == 0:
                row[place] = f"{factor * float(row[place]):.6g}"
        return "\n".join([header, *map(",".join, rows)])

    return other


def dropped(text: str) -> str:
    """Let the current drop out to 0 mA in every tenth row."""
    header, *lines = text.splitlines()
    rows = [line.split(",") for line in lines]
    place = header.split(",").index("current_mA")
    for row in rows[::10]:
        row[place] = "0"
    return "\n".join([header, *map(",".join, rows)])


LBF = 0.2248
"""Pounds of force in a newton."""


@pytest.mark.parametrize(
    ("spoilt", "complaint"),
    [
        (cut("pressure_kPa"), "links no two points of the chain"),
        (cut("t_s"), "t_s"),
        (shared, "names 2 muscles"),
        (lambda text: "\n".join(text.splitlines()[:6]), "5 of 5 rows are usable"),
        (filled, "links no two points of the chain"),
        (reversed_rows, "t_s runs backwards"),
        (lambda _text: "", "is empty"),
        (scaled(LBF), "is it in lbf"),
        (scaled(0.01, column="pressure_kPa"), "column pressure_kPa is 0.0"),
        (scaled(100.0, column="contraction"), "it is a ratio"),
        (lambda text: text.replace("force_N", "force_lbf"), "expected in N"),
    ],
    ids=[
        "no pressure",
        "no time",
        "two muscles",
        "5 rows",
        "nan",
        "backwards",
        "empty",
        "lbf for N",
        "bar for kPa",
        "percent for a ratio",
        "lbf by name",
    ],
)
def test_an_unusable_recording_is_one_clear_message(
    done: Done, spoilt: Callable[[str], str], complaint: str
) -> None:
    path = done.folder / "spoilt.csv"
    path.write_text(spoilt((done.folder / "rig.csv").read_text()))
    refused(str(path), done.at("model.yaml"), str(path), complaint)


@pytest.mark.parametrize("factor", [LBF, 2.5], ids=["lbf in half", "two muscles"])
def test_a_recording_that_contradicts_itself_is_a_verdict(
    done: Done, factor: float
) -> None:
    path = done.folder / "torn.csv"
    path.write_text(scaled(factor, 2)((done.folder / "rig.csv").read_text()))
    ended = gripperd(
        "diagnose", str(path), "--model", done.at("model.yaml"),
        "--json", done.at("torn.json"), "--report", done.at("torn.html"),
    )  # fmt: skip
    assert ended.returncode == 0, ended.stderr
    assert ended.stdout.startswith("unusable  The recording contradicts itself")
    said = json.loads((done.folder / "torn.json").read_text())
    assert said["verdict"] == "unusable"
    assert (said["effects"], said["where"], said["gap"]) == ([], [], None)
    (one,) = said["contradictions"]
    assert {"isometric_0", "isometric_2"} <= {*one["runs"]}
    assert "isometric_1" in one["others"]
    page = (done.folder / "torn.html").read_text(encoding="utf-8")
    assert "The recording contradicts itself" in page
    assert "Which, and how sure" not in page


def test_a_recording_that_contradicts_itself_adds_nothing_to_a_model(
    done: Done,
) -> None:
    path = done.folder / "torn.csv"
    path.write_text(scaled(0.4, 2)((done.folder / "rig.csv").read_text()))
    ended = gripperd(
        "diagnose", str(path), "--model", done.at("model.yaml"), "--apply",
        "--config", str(done.settings),
    )  # fmt: skip
    assert ended.returncode == 1
    assert "nothing to apply, the verdict is unusable" in ended.stderr


def test_dropouts_to_0_mA_are_left_out_and_told(done: Done) -> None:  # noqa: N802
    path = done.folder / "dropped.csv"
    path.write_text(dropped(Path(short(done)).read_text()))
    ended = gripperd(
        "diagnose", str(path), "--model", done.at("model.yaml"), "--json", "-"
    )
    assert ended.returncode == 0, ended.stderr
    said = json.loads(ended.stdout)
    assert said["verdict"] == "none"
    assert sum(one["count"] for one in said["rejected_samples"]) == 5
    assert {one["reason"] for one in said["rejected_samples"]} == {"under 3.6 mA"}


def test_what_is_no_recording_is_one_clear_message(done: Done) -> None:
    folder = done.folder / "folder.csv"
    folder.mkdir()
    binary = done.folder / "binary.csv"
    binary.write_bytes(bytes(range(256)) * 40)
    sparse = done.folder / "sparse.csv"
    sparse.touch()
    os.truncate(sparse, 2 * 2**30)
    for path, complaint in (
        (folder, "is not a file"),
        (Path(), "is not a file"),
        (binary, "is neither a CSV file"),
        (sparse, "2048 MB are more than"),
        (done.folder / "absent.csv", "there is no such file"),
    ):
        refused(str(path), done.at("model.yaml"), str(path), complaint)


def test_a_complaint_has_the_line_it_is_about(done: Done) -> None:
    broken = done.folder / "broken.csv"
    rows = "".join(f"a,{row}\n" for row in range(98))
    broken.write_text(f"run,t_s\n{rows}a,x\n")
    refused(str(broken), done.at("model.yaml"), f'{broken}:100: t_s: "x"')


@pytest.mark.parametrize(
    ("model", "complaint"),
    [("rig.csv", "is not a mapping"), ("absent.yaml", "there is no such file")],
)
def test_an_unusable_model_is_one_clear_message(
    done: Done, model: str, complaint: str
) -> None:
    refused(done.at("rig.csv"), done.at(model), model, complaint)


@pytest.mark.parametrize("option", ["--report", "--json"])
@pytest.mark.parametrize(
    ("place", "complaint"),
    [("nowhere/found", "there is no folder"), (".", "is a folder")],
)
def test_a_place_that_cannot_be_is_told_before_the_work(
    done: Done, option: str, place: str, complaint: str
) -> None:
    ended = gripperd(
        "diagnose", done.at("rig.csv"), "--model", done.at("model.yaml"),
        option, done.at(place),
    )  # fmt: skip
    assert ended.returncode == 2
    assert complaint in ended.stderr
    assert ended.stdout == ""


def refused(recording: str, model: str, *said: str) -> None:
    ended = gripperd("diagnose", recording, "--model", model)
    assert ended.returncode == 2
    assert ended.stdout == ""
    assert len(ended.stderr.splitlines()) == 1
    assert ended.stderr.startswith("error: ")
    for words in said:
        assert words in ended.stderr
