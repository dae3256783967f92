"""The report as one page that needs nothing but a browser."""

import re
from collections import Counter
from dataclasses import dataclass
from datetime import datetime

from jinja2 import Environment, PackageLoader, StrictUndefined
from markupsafe import Markup, escape

from gripperd.model import Chain
from gripperd.reproduce import drawing
from gripperd.reproduce.chapters import Chapter, Equation, Table
from gripperd.reproduce.claims import Claim, Verdict
from gripperd.reproduce.picture import Picture
from gripperd.reproduce.samples import PAPER_CURRENT, Grasp
from gripperd.units import KILO, MILLI


@dataclass(frozen=True, slots=True)
class Contents:
    """Everything the page tells."""

    chain: Chain
    claims: tuple[Claim, ...]
    grasps: tuple[Grasp, ...]
    chapters: tuple[Chapter, ...]
    pictures: tuple[tuple[Picture, str], ...]
    """Each picture with its SVG."""
    version: str
    made_at: datetime


def page(contents: Contents) -> str:
    """Set the contents as HTML, with every picture and style inside."""
    environment = Environment(
        loader=PackageLoader("gripperd.reproduce", "."),
        autoescape=True,
        undefined=StrictUndefined,
        keep_trailing_newline=True,
    )
    environment.filters |= {"subscripts": subscripts, "bound": bound}
    counts = Counter(claim.verdict for claim in contents.claims)
    return environment.get_template("page.html.jinja").render(
        chain=contents.chain,
        claims=contents.claims,
        score=[(verdict, counts[verdict]) for verdict in Verdict if counts[verdict]],
        pictures=[picture.on_page(svg) for picture, svg in contents.pictures],
        chapters=[
            _chapter(number, chapter)
            for number, chapter in enumerate(contents.chapters, 1)
        ],
        table_1=_table_1(contents.grasps),
        current=f"{PAPER_CURRENT / MILLI:g} mA",
        gripper=_gripper(contents.chain),
        doubt=bool(contents.chain.tolerances),
        version=contents.version,
        made_at=contents.made_at,
    )


def bound(text: str) -> str:
    """Keep a number and its unit, and an equality, on one line."""
    text = re.sub(r"(?<=\d) (?=N\b|mm\b|mA\b|kPa\b|MPa\b|%)", "\u00a0", text)
    return text.replace(" = ", "\u00a0=\u00a0")


def subscripts(text: str) -> Markup:
    """Lower what follows an underscore.

    >>> print(subscripts("F_s [N]"))
    F<sub>s</sub> [N]
    """
    return Markup(re.sub(r"_(\w)", r"<sub>\1</sub>", str(escape(text))))


def _chapter(number: int, chapter: Chapter) -> dict[str, object]:
    return {
        "title": chapter.title,
        "text": chapter.text,
        "tables": chapter.tables,
        "equations": [
            _equation(f"equation-{number}-{index}", equation)
            for index, equation in enumerate(chapter.equations, 1)
        ],
    }


def _equation(name: str, equation: Equation) -> dict[str, str]:
    markup = drawing.equation(equation.mathtext, name, str(escape(equation.spoken)))
    return {"number": equation.number, "markup": Markup(markup)}


def _table_1(grasps: tuple[Grasp, ...]) -> Table:
    rows = []
    for grasp in grasps:
        sample, seen = grasp.sample, grasp.prediction
        doubt = f" ± {seen.grip_std:.1f}" if seen.grip_std else ""
        rows.append(
            (
                sample.name,
                f"{sample.diameter / MILLI:.0f}",
                f"{seen.pressure / KILO:.1f}",
                f"{seen.contraction:.3f}",
                f"{seen.grip_force:.1f}{doubt}",
                sample.reported,
            )
        )
    return Table(
        "Predicted grip at 10.7 mA",
        (
            "Sample",
            "Size [mm]",
            "Pressure [kPa]",
            "Contraction h",
            "Grip force per jaw [N]",
            "Paper",
        ),
        tuple(rows),
    )


def _gripper(chain: Chain) -> str:
    regulator, linkage = chain.regulator, chain.linkage
    return (
        f"{regulator.current_low / MILLI:g}-{regulator.current_high / MILLI:g} mA to"
        f" {regulator.pressure_low / KILO:g}-{regulator.pressure_high / KILO:g} kPa,"
        f" jaws that open {linkage.open_width / MILLI:g} mm and close"
        f" {linkage.ratio:g} mm per millimetre of shortening, against a spring of"
        f" {linkage.spring_preload:g} N plus {linkage.spring_rate * MILLI:g} N/mm"
    )
