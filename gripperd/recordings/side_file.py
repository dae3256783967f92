"""What stands beside a recording: who, what for, and how noisy. YAML."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import TypeGuard

import numpy as np

from gripperd.config.complaint import did_you_mean
from gripperd.config.document import Document, read_document
from gripperd.config.wording import shown
from gripperd.diagnose.readings.columns import COLUMNS
from gripperd.diagnose.readings.limits import HUGE
from gripperd.diagnose.readings.recording import Kind, Run
from gripperd.errors import ConfigError, InputError
from gripperd.recordings.header import IDENTITIES

KNOWN = {"rig", "notes", "noise", "runs", *IDENTITIES}


@dataclass(frozen=True, slots=True)
class SideFile:
    """What the side file states; nothing when there is none."""

    noise: Mapping[str, float] = field(default_factory=dict)
    """One sigma by quantity. [SI]"""
    kinds: Mapping[str, Kind] = field(default_factory=dict)
    """By name of run."""
    remarks: tuple[str, ...] = ()

    def labelled(self, runs: tuple[Run, ...]) -> tuple[Run, ...]:
        """Give the runs with their kinds."""
        return tuple(replace(run, kind=self.kinds.get(run.name)) for run in runs)


def read_side_file(path: Path, runs: Sequence[Run]) -> SideFile:
    """Read what stands beside a recording of these runs.

    Raises
    ------
    InputError
        It is there and cannot be used; the message has a line for every complaint.
    """
    if not path.exists():
        if path.is_symlink():
            raise InputError(f"{path}: is a link to no file")
        return SideFile()
    try:
        document = read_document(path)
        if document.complaints:
            raise ConfigError(*document.complaints)
        return _side_file(document, runs)
    except ConfigError as broken:
        raise InputError(str(broken)) from None


def _side_file(document: Document, runs: Sequence[Run]) -> SideFile:
    entries = _mapping(document, (), document.value)
    for key in IDENTITIES:
        if isinstance(entries.get(key), list):
            detail = f"{shown(entries[key])} are several; a recording is of one muscle"
            raise ConfigError(document.complaint((key,), detail))
    about = _mapping(document, ("runs",), entries.get("runs"))
    kinds = _kinds(document, about, tuple(run.name for run in runs))
    unread = sorted(set(entries) - KNOWN)
    for run, entry in about.items():
        of_run = _mapping(document, ("runs", run), entry)
        unread += [f"runs.{run}.{key}" for key in sorted(set(of_run) - {"kind"})]
    return SideFile(
        noise=_noise(
            document, _mapping(document, ("noise",), entries.get("noise")), runs
        ),
        kinds=kinds,
        remarks=tuple(f"{document.source}: {key} is not read" for key in unread),
    )


def _noise(
    document: Document, entries: Mapping[str, object], runs: Sequence[Run]
) -> Mapping[str, float]:
    noise: dict[str, float] = {}
    for name, value in entries.items():
        column = COLUMNS.get(name)
        if column is None:
            detail = f"no such column; {did_you_mean(name, COLUMNS)}"
            raise ConfigError(document.complaint(("noise", name), detail))
        if column.quantity == "time":
            detail = "the clock is taken for exact; leave it out"
            raise ConfigError(document.complaint(("noise", name), detail))
        if not _is_number(value) or value <= 0.0:
            detail = f"{shown(value)} is not above 0 {column.unit}".rstrip()
            raise ConfigError(document.complaint(("noise", name), detail))
        if value * column.scale > HUGE:
            detail = f"{shown(value)} is above {column.shown(HUGE)}"
            raise ConfigError(document.complaint(("noise", name), detail))
        spread = _spread(runs, column.quantity) / column.scale
        if value > spread > 0:
            detail = (
                f"{shown(value)} {column.unit} is above {spread:.4g} {column.unit},"
                " all by which that column varies"
            )
            raise ConfigError(document.complaint(("noise", name), detail))
        noise[column.quantity] = value * column.scale
    return noise


def _kinds(
    document: Document, entries: Mapping[str, object], runs: tuple[str, ...]
) -> Mapping[str, Kind]:
    kinds: dict[str, Kind] = {}
    for run, value in entries.items():
        if run not in runs:
            detail = f"the recording has no such run; {did_you_mean(run, runs)}"
            raise ConfigError(document.complaint(("runs", run), detail))
        entry = _mapping(document, ("runs", run), value)
        if "kind" not in entry:
            continue
        kind = str(entry["kind"])
        if kind not in set(Kind):
            detail = f"{shown(kind)} is unknown; {did_you_mean(kind, Kind)}"
            raise ConfigError(document.complaint(("runs", run, "kind"), detail))
        kinds[run] = Kind(kind)
    return kinds


def _spread(runs: Sequence[Run], quantity: str) -> float:
    """Range of a column in all runs; 0 where it is not there, or stays. [SI]."""
    read = [run.columns[quantity] for run in runs if run.has(quantity)]
    known = [column[np.isfinite(column)] for column in read]
    seen = np.concatenate([np.empty(0), *known])
    return float(np.ptp(seen)) if seen.size else 0.0


def _is_number(value: object) -> TypeGuard[float]:
    return isinstance(value, int | float) and not isinstance(value, bool)


def _mapping(
    document: Document, path: tuple[str, ...], value: object
) -> Mapping[str, object]:
    if value is None:
        return {}
    if not isinstance(value, dict):
        detail = f"{shown(value)} is not a mapping of keys to values"
        raise ConfigError(document.complaint(path, detail))
    return value
