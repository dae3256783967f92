"""One case: a recording, the model that goes with it, and the sealed truth."""

from dataclasses import asdict, dataclass, replace
from pathlib import Path

import numpy as np

from tests.hidden_rig.campaign import weather
from tests.hidden_rig.draw import ARTEFACTS, FAMILIES, KINDS, SPREAD, Draw, draw_case
from tests.hidden_rig.files import (
    write_model,
    write_recording,
    write_side_file,
    write_truth,
)
from tests.hidden_rig.hidden import PLACES, TEXTBOOK, Hidden
from tests.hidden_rig.measurement import Readings, measured
from tests.hidden_rig.protocol import protocol
from tests.hidden_rig.rig import Rig, built, off_by
from tests.hidden_rig.truth import Bench, full_scale, hide

SLOW = ("isometric", "isobaric")
"""Kinds of sweeps that a crank may drive."""


@dataclass(frozen=True)
class Case:
    """Where a case lies, and what is true of it."""

    recording: Path
    side_file: Path
    model: Path
    sealed: Path
    truth: dict[str, object]


def make_case(
    directory: Path,
    *,
    seed: int,
    family: str,
    kind: str,
    names: tuple[str, ...] = (),
    strength: float | None = None,
) -> Case:
    """Simulate one case and write its four files into a folder of its own.

    ``names`` are effects of the kind's list; none given, the seed chooses. ``strength``
    is the peak of each effect in its signal, as a fraction of full scale (the 95th
    percentile in the run that shows it most); those of the textbook are as strong as
    they are. The bytes written depend on the arguments alone.
    """
    random = np.random.default_rng([seed, FAMILIES.index(family), KINDS.index(kind)])
    draw = draw_case(kind, names, strength, random)
    bench = _bench(family, draw, random)
    effects = () if kind == "artefact" else draw.names
    hidden = hide(bench, dict(zip(effects, draw.strengths, strict=False)), random)
    course, columns = bench.run(hidden)
    if not draw.signed:
        columns = {**columns, "force_N": np.maximum(columns["force_N"], 0.0)}
    readings = measured(course, columns, draw.names, draw.drifts, random)
    label = "-".join((kind, *names, family, str(seed)))
    folder = directory / label
    folder.mkdir(parents=True, exist_ok=True)
    truth = _truth(bench, hidden, draw, readings, columns)
    truth = {"case": label, "kind": kind, **truth}
    noise = {n: m.std for n, m in readings.noises.items() if draw.tells_noise}
    return Case(
        write_recording(folder / f"{label}.csv", readings, bench.sweeps),
        write_side_file(folder / f"{label}.yaml", bench.sweeps, _notes(draw), noise),
        write_model(
            folder / "model.yaml",
            [name for name in TEXTBOOK if name not in effects],
            draw.tolerance,
        ),
        write_truth(folder / "truth.json", truth),
        truth,
    )


def _bench(family: str, draw: Draw, random: np.random.Generator) -> Bench:
    slack = draw.signed or "slack_clipped" in draw.names
    sweeps = protocol(random, taut=not slack)
    sweeps = [replace(s, rounded=draw.rounded and s.kind in SLOW) for s in sweeps]
    drawn = Rig()
    return Bench(
        family=family,
        rig=off_by(drawn, 0.015, random)
        if draw.tight
        else built(drawn, SPREAD, random),
        sweeps=sweeps,
        rests=random.uniform(20, 60, len(sweeps)),
        day=weather(random),
        late=str(random.choice(["force_N", "contraction"])),
    )


def _notes(draw: Draw) -> str:
    if "slack_clipped" in draw.names:
        return ""
    if draw.signed:
        return "The rig clamps both ends: a force below zero is a push."
    return "The load cell hangs on a cord: no force below zero."


def _truth(
    bench: Bench,
    hidden: Hidden,
    draw: Draw,
    readings: Readings,
    columns: dict[str, np.ndarray],
) -> dict[str, object]:
    shown = []
    for name in draw.names:
        if name not in PLACES:
            continue
        change = bench.change(hidden, name)
        signal = bench.signal(name)
        scale = full_scale(signal, columns[signal])
        shown.append(
            {
                "name": name,
                "stage": PLACES[name].stage,
                "signal": signal,
                "amount": getattr(hidden, name),
                "peak_of_full_scale": change.peak,
                "rms_of_full_scale": change.rms,
                "rms_over_noise": change.rms * scale / readings.noises[signal].std,
            }
        )
    return {
        "family": bench.family,
        "effects": shown,
        "artefacts": [name for name in draw.names if name in ARTEFACTS],
        "rig": bench.rig._asdict(),
        "signed": draw.signed,
        "noise": {name: asdict(model) for name, model in readings.noises.items()},
        "noise_floor": {
            name: float(np.hypot(model.std, model.drift_std))
            for name, model in readings.noises.items()
        },
    }
