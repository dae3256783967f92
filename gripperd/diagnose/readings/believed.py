"""Which of two groups of repeats is believed when they contradict each other."""

from dataclasses import replace

from gripperd.diagnose.readings.recording import Contradiction, Recording, Rejection


def believed(recording: Recording) -> Recording:
    """Leave out the weaker group: a mount that slips or a slack cord only loses force.

    The contradiction stays on record. All of its runs are left out; listed as rejected
    is the column that contradicts.
    """
    dropped: list[Rejection] = []
    names: set[str] = set()
    for one in recording.contradictions:
        weaker = _weaker(one)
        names |= set(weaker)
        reason = f"contradicts {len(_stronger(one))} runs of the same sweep"
        dropped += [
            Rejection(run.name, one.column, len(run), reason)
            for run in recording.runs
            if run.name in weaker
        ]
    if not dropped:
        return recording
    runs = tuple(run for run in recording.runs if run.name not in names)
    return replace(recording, runs=runs, rejected=(*recording.rejected, *dropped))


def _weaker(one: Contradiction) -> tuple[str, ...]:
    return one.runs if one.difference < 0 else one.others


def _stronger(one: Contradiction) -> tuple[str, ...]:
    return one.others if one.difference < 0 else one.runs
