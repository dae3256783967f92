"""Tracks to run effects on."""

from collections.abc import Iterator
from dataclasses import fields, replace

import numpy as np

from gripperd.model import Muscle
from gripperd.model.track import Array, Track

STILL = {
    "step": 0.1,
    "command": 0.0,
    "still": 0.0,
    "waiting": 0.0,
    "pressure": 0.0,
    "contraction": 0.0,
    "rate": 0.0,
    "direction": 1.0,
    "came": np.nan,
    "force": 0.0,
    "grip": np.nan,
    "temperature": np.nan,
    "supply_drop": 0.0,
    "ambient": np.nan,
    "cycle": 0.0,
    "repeat": np.nan,
}


def track_of(muscle: Muscle, **columns: Array | float) -> Track:
    """A rig at rest but for the columns given."""
    size = max((np.size(column) for column in columns.values()), default=1)
    filled = {
        name: np.full(size, columns.get(name, default))
        for name, default in ({"time": 0.1 * np.arange(size)} | STILL).items()
    }
    return Track(muscle=muscle, span=(0.0, 500e3), **filled)


def eventful(muscle: Muscle) -> Track:
    """Three inflations with travel both ways, warming up: every column moves."""
    time = np.arange(0.0, 24.0, 0.2)
    phase = 2 * np.pi * time / 8.0
    rate = 0.08 * np.sin(1.7 * phase)
    return track_of(
        muscle,
        time=time,
        step=np.diff(time, prepend=0.0),
        pressure=200e3 * (1 - np.cos(phase)),
        contraction=0.1 + np.cumsum(rate) * 0.2,
        rate=rate,
        direction=np.where(rate < 0, -1.0, 1.0),
        force=300.0 * (1 - np.cos(phase)),
        temperature=293.15 + time,
        cycle=np.floor(time / 8.0),
        repeat=np.floor(time / 8.0),
    )


def samples(track: Track) -> Iterator[Track]:
    """The same track in pieces of one sample."""
    arrays = [
        field.name
        for field in fields(track)
        if isinstance(getattr(track, field.name), np.ndarray)
    ]
    for index in range(track.time.size):
        part = slice(index, index + 1)
        yield replace(track, **{name: getattr(track, name)[part] for name in arrays})
