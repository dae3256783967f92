"""Other methods on the same cases: ``make exam-peers CASES=50``."""

import typer
from rich.console import Console

from tests.exam import options
from tests.exam.peers.contest import Outcome, contested
from tests.exam.peers.scores import side_by_side


def main(
    cases: options.Cases = 100,
    family: options.Family = "both",
    jobs: options.Jobs = 2,
    seed: options.Seed = 1,
    results: options.Results = None,
) -> None:
    """Show seeded cases to every method and compare what they say."""
    families = options.chosen(family)
    asked = options.mixture(families, cases, seed)
    outcomes = options.solved(contested, Outcome, asked, jobs, results)
    console = Console(width=120)
    console.print(side_by_side(outcomes))
    for name in families:
        of = [one for one in outcomes if one.question.family == name]
        if len(families) > 1:
            console.print(f"Family {name}")
            console.print(side_by_side(of))


if __name__ == "__main__":
    typer.run(main)
