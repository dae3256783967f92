"""Levels: the columns of one sweep without their noise."""

from collections.abc import Mapping

import numpy as np
from scipy.optimize import isotonic_regression

from gripperd.diagnose.noise.model import Noise
from gripperd.diagnose.noise.smoothing import (
    LEAP,
    OF_LENGTH,
    STIFFNESSES,
    Smooth,
    smooth,
)
from gripperd.diagnose.readings.followed import followed
from gripperd.diagnose.readings.leap import leaps
from gripperd.diagnose.readings.legs import borne_out, legs_of
from gripperd.diagnose.readings.length import as_unsure, at_its_mean
from gripperd.diagnose.readings.recording import Run
from gripperd.diagnose.readings.rest import at_rest
from gripperd.diagnose.readings.spring import on_spring
from gripperd.diagnose.readings.travel import (
    JAWS,
    SURE,
    contracting,
    leaning,
    reversal,
    travel,
)
from gripperd.model.track import Array

SMOOTHED = (
    "pressure", "contraction", "force", "opening", "grip", "temperature", "supply",
    "ambient",
)  # fmt: skip
QUICK = 0.04
"""Time in which a regulator may have followed a step: 10 to 60 ms at the outlet. [s]"""
SUPPLE = 1e4
"""A length is measured well: its corners matter more than its noise."""
MOVES = 5e-5
"""Change of current that is a new command: 0.3 % of the span. [A]"""
AGAIN = 2
"""Turns that are no way there and back."""
LEAST = 20
"""Samples that a plane is laid through."""


def levels(
    sweep: Run, noises: Mapping[str, Noise], length: Noise, *, on_stairs: bool = False
) -> dict[str, Smooth]:
    """Take the noise off every column that effects look at.

    Parameters
    ----------
    sweep
        Without a pause.
    noises
        Of each measured column, by its name.
    length
        Noise of the contraction, as far as it wanders.
    on_stairs
        Whether the pressure goes in stairs that no trend can follow.

    Returns
    -------
    Columns by name; ``length`` is the contraction with its corners sharp.
    """
    time = sweep.columns["time"]
    found = {
        name: smooth(
            time,
            sweep.columns[name],
            noises[name].slow_variance,
            tried=_tried(name),
        )
        for name in SMOOTHED
        if sweep.has(name)
    }
    if "pressure" in found:
        plain = found["pressure"]
        found["pressure"] = _regulated(sweep, plain, noises, on_stairs=on_stairs)
    if "contraction" in found:
        found["length"] = _length(sweep, noises, length)
        way = _unswung(sweep, _not_past(sweep, found["contraction"]))
        if "pressure" in found:
            way = on_spring(sweep, way, found["pressure"])
        found["contraction"] = _steady(sweep, as_unsure(way, length))
        if not found["contraction"].rate.any():
            found["length"] = at_its_mean(found["contraction"])
            if "pressure" in found and not sweep.has("current"):
                found["pressure"] = _unturned(found["pressure"])
    if {"pressure", "contraction", "force"} <= found.keys():
        found["force"] = _beside_pressure(sweep, found, noises)
    return found


def _tried(name: str) -> Array:
    return OF_LENGTH if name in ("contraction", "current") else STIFFNESSES


def _length(sweep: Run, noises: Mapping[str, Noise], length: Noise) -> Smooth:
    """Contraction whose corners stay sharp, at the price of some noise."""
    noise = noises["contraction"]
    time, contraction = sweep.columns["time"], sweep.columns["contraction"]
    found = smooth(time, contraction, noise.slow_variance, SUPPLE, tried=OF_LENGTH)
    # No trend is further off than the reading that it follows.
    doubt = np.minimum(found.doubt, noise.std)
    return found._replace(doubt=doubt, lasting=length.lasting)


def _steady(sweep: Run, known: Smooth) -> Smooth:
    """Take the wiggles out: there is no travel below the least, and none back.

    What remembers would take each wiggle for a reversal. Between reversals the column
    becomes the nearest monotone one (isotonic regression).
    """
    value = known.value
    if not np.isfinite(value).all():
        return known
    signs, turned = _travelled(sweep, known)
    if not signs.any():
        still = at_rest(sweep.columns["contraction"], known)
        return known._replace(value=still, rate=0.0 * value)
    out = _one_way(value, signs)
    if (before := signs == 0).any():
        out[before] = value[before].mean()
    return known._replace(value=out, unsure=turned != signs)


def _travelled(sweep: Run, known: Smooth) -> tuple[Array, Array]:
    """Sign of the travel that the readings bear out, and of that which the trend has.

    0 throughout if there is none.

    What yields in the jaws lets the muscle go to and fro by less than a trend may
    wander. It does so again and again, and a test stand has no jaws.
    """
    column, turned = sweep.columns["contraction"], contracting(known)
    signs = borne_out(turned, column, known.variance)
    if signs.any() or not sweep.has("opening"):
        return signs, turned
    turned = contracting(known, JAWS)
    signs = borne_out(turned, column, known.variance)
    turns = np.count_nonzero(np.diff(signs[signs != 0]))
    return (signs if turns >= AGAIN else np.zeros_like(signs)), turned


def _unturned(known: Smooth) -> Smooth:
    """Pressure where nothing travels, without the wiggles that turn friction round.

    Noise that lasts wanders in the rests of a staircase further than friction sticks.
    """
    value = known.value
    if not (known.spread > 0 and np.isfinite(value).all()):
        return known
    return known._replace(value=_one_way(value, travel(value, SURE * known.spread)))


def _one_way(value: Array, signs: Array) -> Array:
    """Nearest column that is monotone between reversals; where signs are 0, its own."""
    out = value.copy()
    for piece in legs_of(signs):
        increasing = bool(signs[piece.start] > 0)
        out[piece] = isotonic_regression(value[piece], increasing=increasing).x
    return out


def leaping(sweep: Run, name: str, plain: Smooth) -> Smooth:
    """Column that may leap, where nothing tells of its steps, if that is likelier.

    A trend that is supple enough for a step leaves the noise in the rests beside it.
    """
    column, time = sweep.columns[name], sweep.columns["time"]
    leapt = smooth(time, column, plain.variance, leap=LEAP, tried=_tried(name))
    likelier = leapt.likelihood > plain.likelihood
    return leapt if leapt.leapt and likelier else plain


def bending(sweep: Run, name: str, plain: Smooth) -> Smooth:
    """Column that may be stiff between corners and supple at them, if likelier.

    What is cut off a corner of a staircase is missing in the force as well, many times
    its noise, and looks as if one of the two came late.
    """
    column, time = sweep.columns[name], sweep.columns["time"]
    bent = smooth(time, column, plain.variance, bends=True, tried=_tried(name))
    if bent.likelihood <= plain.likelihood:
        return plain
    # Between its corners it is known better than at them, where it may turn round.
    return bent._replace(spread=max(bent.spread, plain.spread))


def breaking(sweep: Run, name: str, plain: Smooth) -> Smooth:
    """Column that goes straight on from corner to corner, if that is likelier.

    What a trend cuts off the corners of a cycle, or leaves of the noise in its holds,
    comes back in every one: the force seems to go with the pressure once more.
    """
    column, time = sweep.columns[name], sweep.columns["time"]
    broken = smooth(time, column, plain.variance, breaks=True, tried=_tried(name))
    if broken.likelihood <= plain.likelihood:
        return plain
    return broken._replace(spread=max(broken.spread, plain.spread))


def _not_past(sweep: Run, plain: Smooth) -> Smooth:
    """Contraction that goes straight on from corner to corner, if it goes less far so.

    A trend goes past the end of a way that is held: friction would seem to turn round.
    """
    bent = bending(sweep, "contraction", plain)
    broken = breaking(sweep, "contraction", bent)
    return broken if np.ptp(bent.value) > np.ptp(broken.value) else bent


def _unswung(sweep: Run, plain: Smooth) -> Smooth:
    """Contraction that may leap, if it goes but one way when it does.

    A trend goes further than a step of a free muscle, and comes back. A load may swing
    in earnest: then it is no leap.
    """
    known = leaping(sweep, "contraction", plain)
    least = reversal(known.spread)
    for row in known.leapt:
        ways = np.diff(known.value[row.start - 1 : row.stop])
        back = min(np.sum(ways[ways > 0]), -np.sum(ways[ways < 0]))
        if back > least:
            return plain
    return known


def _regulated(
    sweep: Run, plain: Smooth, noises: Mapping[str, Noise], *, on_stairs: bool
) -> Smooth:
    """Pressure with the corners of its command; if none was read, with its own."""
    if sweep.has("current"):
        return _beside_command(sweep, plain, noises, on_stairs=on_stairs)
    bent = bending(sweep, "pressure", leaping(sweep, "pressure", plain))
    return breaking(sweep, "pressure", bent)


def _beside_command(
    sweep: Run, plain: Smooth, noises: Mapping[str, Noise], *, on_stairs: bool
) -> Smooth:
    """Pressure as a regulator makes it of the command, plus a smooth difference.

    The command has corners that no trend can follow, and no noise. Taken when likelier
    than a trend alone.
    """
    current, pressure = sweep.columns["current"], sweep.columns["pressure"]
    good = np.isfinite(current) & np.isfinite(pressure)
    if not np.isfinite(current).all() or good.sum() < 8 or np.ptp(current) < MOVES:
        return plain
    slope, level = np.polyfit(current[good], pressure[good], 1)
    command = level + slope * current
    time, variance = sweep.columns["time"], noises["pressure"].slow_variance
    step = np.diff(time, prepend=time[0])
    # Samples so far apart tell nothing of how it went at a leap, but a trend would.
    unknown = leaps(command, float(np.ptp(command)), step) & (step > QUICK)
    pressure = np.where(unknown, np.nan, pressure)
    best = smooth(time, pressure, variance) if unknown.any() else plain
    for made, price in followed(command, step, pressure):
        beside = smooth(time, pressure - made, variance)
        likelihood = beside.likelihood - price
        if likelihood > best.likelihood:
            value, rate = beside.value + made, beside.rate + np.gradient(made, time)
            best = beside._replace(value=value, rate=rate, likelihood=likelihood)
    if on_stairs:
        stepped = smooth(time, pressure, variance, bends=True, tried=OF_LENGTH)
        best = max(best, stepped, key=lambda one: one.likelihood)
    return best


def _beside_pressure(
    sweep: Run, known: Mapping[str, Smooth], noises: Mapping[str, Noise]
) -> Smooth:
    """Force as pressure and contraction make it, plus a smooth difference.

    Within one sweep a twisted plane for each way is close enough; it has the corners
    that no trend can follow. Taken when likelier than a trend alone.
    """
    time, force = sweep.columns["time"], sweep.columns["force"]
    pressure, contraction = known["pressure"].value, known["contraction"].value
    rubbing = leaning(pressure)
    plane = np.column_stack([
        np.ones_like(time), pressure, contraction, pressure * contraction,
        rubbing, rubbing * pressure,
    ])  # fmt: skip
    plane /= np.maximum(np.abs(plane).max(axis=0), 1e-300)
    good = np.isfinite(force) & np.isfinite(plane).all(axis=1)
    if not np.isfinite(plane).all() or good.sum() < LEAST:
        return known["force"]
    followed = plane @ np.linalg.lstsq(plane[good], force[good], rcond=1e-6)[0]
    variance = noises["force"].slow_variance
    beside = smooth(time, force - followed, variance)
    if beside.likelihood <= known["force"].likelihood:
        return known["force"]
    rate = beside.rate + np.gradient(followed, time)
    return beside._replace(value=beside.value + followed, rate=rate)
