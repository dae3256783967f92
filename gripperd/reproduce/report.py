"""Everything in one folder: page, figures, table and verdicts."""

import csv
import json
from collections.abc import Mapping
from dataclasses import dataclass
from datetime import datetime
from io import StringIO
from pathlib import Path

from gripperd.errors import InputError
from gripperd.model import Chain
from gripperd.reproduce.chapters import chapters
from gripperd.reproduce.claims import Claim, judge
from gripperd.reproduce.extra import not_installed
from gripperd.reproduce.paper import Paper
from gripperd.reproduce.samples import PAPER_CURRENT, Grasp, table_1
from gripperd.units import KILO, MILLI


@dataclass(frozen=True, slots=True)
class Report:
    """What was found, and where it was written."""

    page: Path
    """The page to open first."""
    files: tuple[Path, ...]
    """Every file of the report."""
    claims: tuple[Claim, ...]
    grasps: tuple[Grasp, ...]
    """Table 1."""


def reproduce(chain: Chain, folder: Path, *, version: str, made_at: datetime) -> Report:
    """Redo the paper on a chain and write the report into a folder.

    The same arguments give the same bytes.

    Raises
    ------
    InputError
        When the extra ``reproduce`` is not installed or the folder cannot be written.
    DomainError
        When a sample of the paper does not fit between the jaws of the chain.
    """
    found, grasps, paper = judge(chain), table_1(chain), Paper(chain.muscle)
    try:
        from gripperd.reproduce import drawing, figures
        from gripperd.reproduce.page import Contents, page
    except ModuleNotFoundError as missing:
        raise not_installed(missing, "reproduce") from missing
    written: dict[str, bytes] = {}
    with drawing.styled():
        pictures = []
        for draw in (figures.figure_6, figures.figure_7, figures.figure_8):
            picture = draw(paper)
            svg = drawing.svg(picture.drawing)
            written[f"figures/{picture.name}.svg"] = svg.encode()
            written[f"figures/{picture.name}.png"] = drawing.png(picture.drawing)
            pictures.append((picture, svg))
        contents = Contents(
            chain, found, grasps, chapters(paper), tuple(pictures), version, made_at
        )
        written["index.html"] = page(contents).encode()
    written["table1.csv"] = _table(grasps).encode()
    written["verdicts.json"] = _verdicts(contents.claims, chain, version, made_at)
    files = _write(folder, written)
    return Report(folder / "index.html", files, found, grasps)


def draw_force_vs_size(chain: Chain, file: Path) -> None:
    """Draw the grip force against object size at the paper's current, as SVG.

    Raises
    ------
    InputError
        When the extra ``reproduce`` is not installed or the file cannot be written.
    """
    try:
        from gripperd.reproduce import drawing
        from gripperd.reproduce.grip_picture import force_vs_size
    except ModuleNotFoundError as missing:
        raise not_installed(missing, "reproduce") from missing
    with drawing.styled():
        picture = drawing.svg(force_vs_size(chain).drawing)
    _write(file.parent, {file.name: picture.encode()})


def _write(folder: Path, contents: Mapping[str, bytes]) -> tuple[Path, ...]:
    files = tuple(folder / name for name in contents)
    try:
        for file, content in zip(files, contents.values(), strict=True):
            file.parent.mkdir(parents=True, exist_ok=True)
            file.write_bytes(content)
    except OSError as refusal:
        message = f"cannot write the report into {folder}: {refusal.strerror}"
        raise InputError(message, key="folder") from refusal
    return files


def _table(grasps: tuple[Grasp, ...]) -> str:
    out = StringIO()
    writer = csv.writer(out, lineterminator="\n")
    writer.writerow(
        (
            "sample",
            "diameter_mm",
            "current_mA",
            "pressure_kPa",
            "contraction",
            "grip_N",
            "grip_std_N",
            "paper",
        )
    )
    for grasp in grasps:
        seen = grasp.prediction
        writer.writerow(
            (
                grasp.sample.name,
                f"{grasp.sample.diameter / MILLI:g}",
                f"{PAPER_CURRENT / MILLI:g}",
                f"{seen.pressure / KILO:.3f}",
                f"{seen.contraction:.4f}",
                f"{seen.grip_force:.3f}",
                f"{seen.grip_std:.3f}" if seen.grip_std else "",
                grasp.sample.reported,
            )
        )
    return out.getvalue()


def _verdicts(
    found: tuple[Claim, ...], chain: Chain, version: str, made_at: datetime
) -> bytes:
    told = {
        "version": version,
        "made_at": made_at.isoformat(),
        "model": chain.name,
        "claims": [
            {
                "key": claim.key,
                "source": claim.source,
                "claim": claim.statement,
                "verdict": claim.verdict,
                "finding": claim.finding,
                "numbers": dict(claim.numbers),
            }
            for claim in found
        ],
    }
    return (json.dumps(told, indent=2, ensure_ascii=False) + "\n").encode()
