"""Other methods on the same cases: ``make exam-peers CASES=50``."""

import typer
from rich.console import Console

from tests.exam.__main__ import Cases, Family, Jobs, Results, Seed, mixture
from tests.exam.peers.contest import Outcome, contested
from tests.exam.peers.scores import side_by_side
from tests.exam.sitting import note, noted, sat
from tests.hidden_rig import FAMILIES


def main(
    cases: Cases = 100,
    family: Family = "both",
    jobs: Jobs = 2,
    seed: Seed = 1,
    results: Results = None,
) -> None:
    """Show seeded cases to every method and compare what they say."""
    families = FAMILIES if family == "both" else (family,)
    asked = mixture(families, cases, seed)
    known = noted(results, Outcome) if results else []
    old = {one.question for one in known}
    outcomes = [one for one in known if one.question in set(asked)]
    for one in sat(contested, [one for one in asked if one not in old], jobs):
        outcomes.append(one)
        if results:
            note(results, one)
    console = Console(width=120)
    console.print(side_by_side(outcomes))
    for name in families:
        of = [one for one in outcomes if one.question.family == name]
        if len(families) > 1:
            console.print(f"Family {name}")
            console.print(side_by_side(of))


if __name__ == "__main__":
    typer.run(main)
