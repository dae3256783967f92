"""The folder that is written, read as a stranger would."""

import csv
import json
import re
import subprocess
import sys
from datetime import UTC, datetime
from html.parser import HTMLParser
from pathlib import Path
from xml.etree import ElementTree

import pytest
from matplotlib.image import imread

from gripperd.errors import InputError
from gripperd.model import Chain
from gripperd.reproduce import Report, Verdict, draw_force_vs_size, reproduce

VOID = {"meta", "link", "br", "hr", "img", "input"}
MADE_AT = datetime(2024, 6, 7, 8, 30, tzinfo=UTC)


class Page(HTMLParser):
    """Tags and attributes of a page, with a complaint for each that is not closed."""

    def __init__(self, text: str) -> None:
        super().__init__(convert_charrefs=True)
        self.open: list[str] = []
        self.complaints: list[str] = []
        self.elements: list[tuple[str, dict[str, str]]] = []
        self.words: list[str] = []
        self.feed(text)
        self.close()

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.elements.append((tag, {name: value or "" for name, value in attrs}))
        if tag not in VOID:
            self.open.append(tag)

    def handle_startendtag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.elements.append((tag, {name: value or "" for name, value in attrs}))

    def handle_endtag(self, tag: str) -> None:
        if not self.open or self.open.pop() != tag:
            self.complaints.append(f"stray </{tag}> at {self.getpos()}")

    def handle_data(self, data: str) -> None:
        self.words.append(data)

    def values(self, attribute: str) -> list[str]:
        return [attrs[attribute] for _, attrs in self.elements if attribute in attrs]


@pytest.fixture(scope="module")
def text(report: Report) -> str:
    return report.page.read_text(encoding="utf-8")


@pytest.fixture(scope="module")
def page(text: str) -> Page:
    return Page(text)


def test_the_folder_holds_what_it_promises(report: Report) -> None:
    folder = report.page.parent
    names = {
        file.relative_to(folder).as_posix()
        for file in folder.rglob("*")
        if file.is_file()
    }
    figures = {
        f"figures/figure_{n}.{kind}" for n in (6, 7, 8) for kind in ("png", "svg")
    }
    assert names == figures | {"index.html", "table1.csv", "verdicts.json"}
    assert {file.relative_to(folder).as_posix() for file in report.files} == names


def test_every_tag_of_the_page_is_closed(page: Page) -> None:
    assert page.complaints == []
    assert page.open == []


def test_every_name_on_the_page_is_its_own(page: Page) -> None:
    names = page.values("id")
    assert len(names) == len(set(names))


def test_the_page_needs_no_network(text: str) -> None:
    assert re.findall(r"https?:|//[a-z]|@import|src=", text) == []


def test_every_link_leads_somewhere(page: Page, report: Report) -> None:
    names = set(page.values("id"))
    for link in page.values("href"):
        if link.startswith("#"):
            assert link[1:] in names
        else:
            assert (report.page.parent / link).is_file()
    for link in re.findall(r"url\(#([^)]+)\)", " ".join(page.values("clip-path"))):
        assert link in names


def test_every_picture_is_told_in_words(page: Page) -> None:
    drawings = [attrs for tag, attrs in page.elements if tag == "svg"]
    seen = [attrs for attrs in drawings if "aria-hidden" not in attrs]
    # Three figures and seven lines of equations.
    assert len(seen) == 10
    assert all(
        attrs["role"] == "img" and len(attrs["aria-label"]) > 20 for attrs in seen
    )


def test_every_table_heads_its_rows_and_columns(page: Page) -> None:
    heads = [attrs.get("scope") for tag, attrs in page.elements if tag == "th"]
    assert set(heads) == {"row", "col"}
    tables = sum(tag == "table" for tag, _ in page.elements)
    assert tables == sum(tag == "caption" for tag, _ in page.elements) == 6


def test_the_page_tells_every_verdict_and_the_version(
    page: Page, report: Report
) -> None:
    words = " ".join(page.words).replace("\u00a0", " ")
    for claim in report.claims:
        assert claim.statement in words
        assert claim.finding in words
    assert "gripperd 1.2.3" in words
    assert "2024-06-07 08:30 UTC" in words
    assert "47.6 ± " in words


@pytest.mark.parametrize(("number", "height"), [(6, 1280), (7, 1120), (8, 1120)])
def test_every_png_is_a_picture(report: Report, number: int, height: int) -> None:
    pixels = imread(report.page.parent / f"figures/figure_{number}.png")
    assert pixels.shape[:2] == (height, 1600)
    ink = (pixels[..., :3].min(axis=-1) < 0.5).mean()
    assert 0.01 < ink < 0.2


@pytest.mark.parametrize("number", [6, 7, 8])
def test_every_svg_is_well_formed(report: Report, number: int) -> None:
    root = ElementTree.parse(report.page.parent / f"figures/figure_{number}.svg")
    assert root.getroot().tag == "{http://www.w3.org/2000/svg}svg"


def test_the_table_as_csv_names_its_units(report: Report) -> None:
    lines = (report.page.parent / "table1.csv").read_text("utf-8").splitlines()
    rows = list(csv.DictReader(lines))
    assert [row["sample"] for row in rows] == ["apple", "peach", "raw egg", "grape"]
    assert [float(row["grip_N"]) for row in rows] == pytest.approx(
        [47.6, 39.8, 22.5, 5.6], abs=0.05
    )
    assert {row["current_mA"] for row in rows} == {"10.7"}
    assert {row["pressure_kPa"] for row in rows} == {"209.375"}
    assert {row["paper"] for row in rows} == {"clamped"}
    assert all(0.5 < float(row["grip_std_N"]) < 10 for row in rows)


def test_the_verdicts_are_for_programs_too(report: Report) -> None:
    told = json.loads((report.page.parent / "verdicts.json").read_bytes())
    assert told["version"] == "1.2.3"
    assert told["made_at"] == "2024-06-07T08:30:00+00:00"
    claims = {claim["key"]: claim for claim in told["claims"]}
    assert claims["elastic-force-clamps"]["verdict"] == "weak"
    numbers = claims["elastic-force-clamps"]["numbers"]
    assert numbers["force_at_h_0_05_N"] == pytest.approx(521.4, abs=0.05)
    assert {claim["verdict"] for claim in claims.values()} <= {*Verdict}


RUN = """
import sys
from datetime import UTC, datetime
from pathlib import Path
from gripperd.config import reference_chain
from gripperd.reproduce import judge, reproduce
chain = reference_chain()
assert len(judge(chain)) == 9
made_at = datetime(2024, 6, 7, 8, 30, tzinfo=UTC)
reproduce(chain, Path(sys.argv[1]), version="1.2.3", made_at=made_at)
"""


def run(script: str, folder: Path, seed: str = "0") -> subprocess.CompletedProcess[str]:
    return subprocess.run(
        [sys.executable, "-c", script, str(folder)],
        env={"PYTHONHASHSEED": seed, "MPLCONFIGDIR": str(folder.parent)},
        capture_output=True,
        text=True,
        check=False,
    )


def test_another_process_writes_the_same_bytes(report: Report, tmp_path: Path) -> None:
    ended = run(RUN, tmp_path / "again", seed="4711")
    assert ended.returncode == 0, ended.stderr
    for file in report.files:
        other = tmp_path / "again" / file.relative_to(report.page.parent)
        assert other.read_bytes() == file.read_bytes(), file.name


@pytest.mark.parametrize("package", ["matplotlib", "jinja2"])
def test_without_the_extra_it_says_what_to_install(
    tmp_path: Path, package: str
) -> None:
    block = f"""
import sys
class Missing:
    def find_spec(self, name, path=None, target=None):
        if name.partition(".")[0] == {package!r}:
            raise ModuleNotFoundError(f"No module named {{name!r}}", name=name)
sys.meta_path.insert(0, Missing())
"""
    ended = run(block + RUN, tmp_path / "report")
    assert ended.returncode == 1
    last = ended.stderr.strip().splitlines()[-1]
    assert last == (
        f"gripperd.errors.InputError: drawing needs {package}:"
        " pip install 'gripperd[reproduce]'"
    )
    assert not (tmp_path / "report").exists()


def test_a_folder_that_cannot_be_written_is_named(chain: Chain, tmp_path: Path) -> None:
    blocked = tmp_path / "taken"
    blocked.write_text("a file")
    with pytest.raises(InputError, match="taken") as refusal:
        reproduce(chain, blocked, version="0", made_at=MADE_AT)
    assert refusal.value.key == "folder"
    assert blocked.read_text() == "a file"


def test_the_picture_for_the_front_page_is_drawn(chain: Chain, tmp_path: Path) -> None:
    file = tmp_path / "images" / "force_vs_size.svg"
    draw_force_vs_size(chain, file)
    root = ElementTree.parse(file).getroot()
    assert root.get("viewBox") == "0 0 604.8 331.2"
    again = tmp_path / "again.svg"
    draw_force_vs_size(chain, again)
    assert again.read_bytes() == file.read_bytes()
