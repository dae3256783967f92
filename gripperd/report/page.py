"""The page: one file that needs nothing but a browser."""

from typing import TYPE_CHECKING

import yaml

from gripperd.diagnose.diagnosis import Diagnosis
from gripperd.diagnose.objection import contradicted, left_out
from gripperd.diagnose.readings.columns import BY_QUANTITY
from gripperd.diagnose.search.price import SEEN
from gripperd.diagnose.statement import offered, statement, summary
from gripperd.diagnose.verdict.conclude import Verdict
from gripperd.diagnose.verdict.key import public
from gripperd.report import rows
from gripperd.report.untested import untested
from gripperd.reproduce.extra import not_installed

if TYPE_CHECKING:
    from collections.abc import Iterator

    from gripperd.reproduce.picture import Picture

TITLES = {
    Verdict.NAMED: "Found",
    Verdict.NONE: "Nothing is missing",
    Verdict.AMBIGUOUS: "Cannot be told apart",
    Verdict.UNEXPLAINED: "Unexplained",
    Verdict.UNUSABLE: "Unusable",
}

CLOSE = 5.0
"""Evidence behind that goes without saying: by it alone a rival could be true. [nat]"""


def page(diagnosis: Diagnosis, *, model: str, program: str) -> str:
    """Write a diagnosis as HTML, with every picture and style inside.

    The arguments are those of :func:`gripperd.diagnose.document.document`; the same
    give the same page.

    Raises
    ------
    InputError
        When the extra ``report`` is not installed.
    """
    try:
        from jinja2 import ChoiceLoader, Environment, PackageLoader, StrictUndefined

        from gripperd.reproduce import drawing
    except ModuleNotFoundError as missing:
        raise not_installed(missing, "report") from missing
    packages = ("gripperd.report", "gripperd.reproduce")
    environment = Environment(
        loader=ChoiceLoader([PackageLoader(name, ".") for name in packages]),
        autoescape=True,
        undefined=StrictUndefined,
        keep_trailing_newline=True,
    )
    # In a key such as time_s the underscore is no sign for a subscript.
    environment.filters["subscripts"] = str
    with drawing.styled():
        figures = {
            picture.name: picture.on_page(drawing.svg(picture.drawing))
            for picture in _pictures(diagnosis)
        }
    return environment.get_template("diagnosis.html.jinja").render(
        model=model, program=program, figures=figures, **_told(diagnosis)
    )


def _pictures(diagnosis: Diagnosis) -> "Iterator[Picture]":
    from gripperd.report import correction, curves, where
    from gripperd.report.trace import traces

    if (plan := curves.plan(diagnosis.proposal)) is not None:
        yield plan
    signal = diagnosis.main
    if signal is None or not (found := traces(diagnosis, signal)):
        return
    column = BY_QUANTITY[signal.value]
    floor = diagnosis.gaps[signal].noise_floor / column.scale
    for drawn in (where.residual_map(found, column), curves.held_out(found, column)):
        if drawn is not None:
            yield drawn
    yield where.over_time(found, column, floor)
    yield where.against_regressors(found, column, floor)
    yield from map(correction.picture, diagnosis.corrections)


def _told(diagnosis: Diagnosis) -> dict[str, object]:
    recording, proposal = diagnosis.recording, diagnosis.proposal
    main = diagnosis.main
    others = [signal for signal in diagnosis.gaps if signal is not main]
    return {
        "verdict": diagnosis.verdict,
        "title": TITLES[diagnosis.verdict],
        "sentence": summary(diagnosis),
        "recording": recording,
        "contradictions": [
            contradicted(one, len(one.runs + one.others))
            for one in recording.contradictions
        ],
        "left_out": left_out(recording.rejected),
        "statements": [
            {"name": public(entry.name), "text": statement(diagnosis, entry)}
            for entry in diagnosis.named
        ],
        "gap": rows.gap_bars(diagnosis, diagnosis.gaps[main]) if main else None,
        "other_gaps": [rows.gap_bars(diagnosis, diagnosis.gaps[one]) for one in others],
        "extrapolation": _beyond(diagnosis),
        "held_out": diagnosis.held_out,
        "places": rows.places(diagnosis),
        "ranking": rows.ranking(diagnosis),
        "contenders": rows.contenders(diagnosis),
        "overruled": rows.overruled(diagnosis),
        "seen": f"{SEEN:.1%}",
        "numbers": rows.numbers(diagnosis),
        "constants": rows.constants(diagnosis),
        "open": [
            (public(entry.name), [public(name) for name in entry.equivalents])
            for entry in diagnosis.named
            if entry.equivalents
        ],
        "within": f"{diagnosis.contest.margin:.0f}",
        "misshaped": diagnosis.contest.margin > CLOSE,
        "next": proposal,
        "plan": _yaml(proposal.plan) if proposal and proposal.plan else "",
        "signature": diagnosis.signature,
        "corrections": [
            {
                "figure": f"correction_{offer.correction.signal.value}",
                "sentence": offered(offer),
                "table": rows.correction(offer),
            }
            for offer in diagnosis.corrections
        ],
        "untested": untested(diagnosis),
        "seed": diagnosis.seed,
    }


def _beyond(diagnosis: Diagnosis) -> dict[str, object] | None:
    beyond = diagnosis.extrapolation
    if beyond is None:
        return None
    bars = [rows.gap_bars(diagnosis, gap) for gap in beyond.gaps.values()]
    above = bool({*beyond.runs} & {*diagnosis.held_out})
    return {"runs": beyond.runs, "gaps": bars, "above": above}


def _yaml(plan: object) -> str:
    return yaml.safe_dump(plan, sort_keys=False, default_flow_style=None, width=96)
