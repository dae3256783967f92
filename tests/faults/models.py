"""Models that are damaged, activated while an egg is held, or asked for too much."""

import shutil
import tempfile
import time
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import replace
from datetime import UTC, datetime
from pathlib import Path

from gripperd.config import load_model, shipped
from gripperd.config.lineage import Added, Provenance, Recorded
from gripperd.errors import ConfigError
from gripperd.model import PressedObject
from gripperd.model.muscle import CATALOGUE_RANGE
from gripperd.store import Versions
from tests.faults.held import Held, held_egg
from tests.faults.row import Row, counted

REFUSED_WITHIN = 1.0
"""[s]"""
NOON = datetime(2026, 1, 31, 12, tzinfo=UTC)
MADE = Provenance(
    program="0.1.0",
    recording=Recorded(name="steps.csv", sha256="0" * 64),
    seed=7,
    effects=(Added(name="parameter:gripper.spring_preload_N"),),
)
OPEN_WIDTH = 0.4
"""Of jaws that shorten the muscle beyond its catalogue. [m]"""
SIZES = 60


def versions(folder: Path) -> Versions:
    """Versions of the shipped model in a state directory: two of them."""
    base = load_model(shipped("models/reference.yaml"))
    found = Versions(folder / "models" / base.name, base)
    for _ in range(2):
        found.add(base, parent=0, created_at=NOON, provenance=MADE)
    return found


@contextmanager
def held_with_versions() -> Iterator[Held]:
    """A daemon that holds an egg and has two further versions; one is damaged."""
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        versions(folder / "state")
        damaged = folder / "state" / "models" / "reference" / "2.yaml"
        damaged.write_bytes(damaged.read_bytes()[:-100])
        with held_egg(folder) as held:
            yield held


def activated(held: Held, version: int, code: str) -> Row:
    """Ask for another version while an egg is held."""
    wrong = set[str]()
    start = time.monotonic()
    answer = held.http.post(f"/models/{version}/activate")
    took = time.monotonic() - start
    if (answer.status_code, answer.json()["code"]) != (409, code):
        wrong.add(f"{answer.status_code} {answer.json()['code']}")
    names = held.answer("/grippers/g0")["model"], held.answer("/models")["active"]
    if names != ("reference", "reference"):
        wrong.add(f"{names}")
    which = "damaged version" if code == "model-unusable" else "version"
    return Row(
        fault=f"{which} activated, egg held",
        noticed=f"409 {code}",
        took=(took,),
        limit=REFUSED_WITHIN,
        wrong=tuple(sorted(wrong | held.wrong())),
    )


def damaged(stride: int = 1) -> Row:
    """Change a bit, or cut off the rest, at every octet of a version."""
    found = []
    with tempfile.TemporaryDirectory() as name:
        kept = versions(Path(name))
        path = Path(kept.get(1).model.source)
        content = path.read_bytes()
        for place in range(0, len(content), stride):
            flipped = bytes([content[place] ^ 1])
            for bad in (
                content[:place] + flipped + content[place + 1 :],
                content[:place],
            ):
                path.write_bytes(bad)
                found.append(_read(kept))
        path.write_bytes(content)
        found.append(_read(kept))
        shutil.rmtree(path.parent)
    return counted("version with a bit wrong, or cut off", found, {"refused", "read"})


def _read(kept: Versions) -> str:
    try:
        kept.get(1)
    except ConfigError as refused:
        return "refused" if "1.yaml" in str(refused) else f"{refused}"
    return "read"


def outside(sizes: int = SIZES) -> Row:
    """Ask a model for contractions within its domain and outside it."""
    chain = load_model(shipped("models/reference.yaml")).chain()
    wide = replace(chain, linkage=replace(chain.linkage, open_width=OPEN_WIDTH))
    low, high = CATALOGUE_RANGE
    found = []
    for number in range(1, sizes + 1):
        size = OPEN_WIDTH * number / sizes
        said = wide.predict(0.0107, PressedObject(size)).extrapolated
        shortened = (OPEN_WIDTH - size) / wide.linkage.ratio / wide.muscle.rest_length
        beyond = not low <= shortened <= high
        told = "extrapolated" if said else "within"
        found.append(told if said == beyond else f"{told} at {shortened:g}")
    return counted("model asked outside its domain", found, {"extrapolated", "within"})


def rows() -> Iterator[Row]:
    """The files by themselves, then a daemon."""
    yield damaged()
    yield outside()
    with held_with_versions() as held:
        yield activated(held, 1, "object-held")
        yield activated(held, 2, "model-unusable")
