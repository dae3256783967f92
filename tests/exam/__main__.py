"""Examine the diagnosis: ``make exam``, ``make exam CASES=400 FAMILY=A JOBS=2``."""

import typer
from rich.console import Console

from tests.exam import options
from tests.exam.answer import Answer, answered
from tests.exam.tables import confusion, errors, report


def main(
    cases: options.Cases = 200,
    family: options.Family = "both",
    jobs: options.Jobs = 2,
    seed: options.Seed = 1,
    results: options.Results = None,
) -> None:
    """Diagnose seeded cases in which something is hidden, and mark the answers."""
    families = options.chosen(family)
    asked = options.mixture(families, cases, seed)
    answers = options.solved(answered, Answer, asked, jobs, results)
    console = Console(width=110)
    console.print(confusion(answers))
    for name in families:
        of = [one for one in answers if one.question.family == name]
        console.print(report(of, f"Family {name}, {len(of)} cases"))
    for error in errors(answers):
        console.print(error, markup=False)


if __name__ == "__main__":
    typer.run(main)
