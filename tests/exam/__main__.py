"""Examine the diagnosis: ``make exam``, ``make exam CASES=400 FAMILY=A JOBS=2``."""

import typer
from rich.console import Console

from tests.exam.answer import Answer, answered
from tests.exam.options import (
    Cases,
    Family,
    Jobs,
    Results,
    Seed,
    chosen,
    mixture,
    solved,
)
from tests.exam.tables import confusion, errors, report


def main(
    cases: Cases = 200,
    family: Family = "both",
    jobs: Jobs = 2,
    seed: Seed = 1,
    results: Results = None,
) -> None:
    """Diagnose seeded cases in which something is hidden, and mark the answers."""
    families = chosen(family)
    answers = solved(answered, Answer, mixture(families, cases, seed), jobs, results)
    console = Console(width=110)
    console.print(confusion(answers))
    for name in families:
        of = [one for one in answers if one.question.family == name]
        console.print(report(of, f"Family {name}, {len(of)} cases"))
    for error in errors(answers):
        console.print(error, markup=False)


if __name__ == "__main__":
    typer.run(main)
