"""Antiresonances of driving points."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from scipy.optimize import linear_sum_assignment

from ...arrays import Floats, Ints, Numbers
from ...errors import InputError
from ...reduction.responses import Responding
from ..updating_numbers import UPDATING
from .declaration import Residual, Responses, Seen, Slopes
from .frfs import heard


@dataclass(frozen=True, eq=False)
class _Point:
    """A driving point: zeros of the test, ω (n,), those of the model, ω² and their motions.

    `match` (n,) says which of the model's is each one's partner, −1 none.
    """

    model: Responding
    measured: Floats
    zeros: Floats
    motions: Floats
    match: Ints


def antiresonances(frequencies_hz: Floats, values: Numbers) -> Floats:
    """Return the frequencies of the dips of a response between lines, Hz, (n,).

    A dip lies well below the peaks on both sides. The zero is that of the rational function
    (a₀ + a₁f + a₂f²)/(1 + b₁f + b₂f²) that is nearest to the complex values around it (Levy 1959,
    *Complex-curve fitting*, IRE Transactions on Automatic Control 4, 37); damping moves it off the
    real axis.

    Parameters
    ----------
    frequencies_hz : (n_line,) float
    values : (n_line,) complex
        NaN what was not measured.
    """
    from scipy.signal import find_peaks

    good = np.isfinite(values) & (np.abs(values) > 0.0)
    hz, H = frequencies_hz[good], values[good]
    size = np.log(np.abs(H))
    found = [_zero(hz, H, size, int(k)) for k in find_peaks(-size, prominence=UPDATING.depth)[0]]
    return np.array(found)


def _zero(hz: Floats, H: Numbers, size: Floats, k: int) -> float:
    """Return the zero by the lines around line k, as far as they lie within the depth of a dip."""
    high = np.flatnonzero(size > size[k] + UPDATING.depth)
    left = int(high[high < k].max(initial=0))
    right = int(high[high > k].min(initial=len(hz) - 1))
    near = slice(max(min(left, k - 2), 0), max(right, k + 2) + 1)
    scale = hz[near][-1] - hz[near][0]
    f, y = (hz[near] - hz[k]) / scale, H[near] / np.abs(H[near]).max()
    A = np.stack([np.ones_like(y), f, f**2, -f * y, -(f**2) * y], axis=1)
    a = np.linalg.lstsq(A, y, rcond=None)[0][:3]
    roots = np.roots(a[::-1])
    return float(hz[k] + scale * roots[np.argmin(np.abs(roots))].real)


def _points(seen: Seen) -> Iterator[_Point]:
    told = heard(seen, "antiresonances")
    r = told.measured
    if not r.points:
        raise InputError(
            "the residual 'antiresonances' needs a driving point: a response where and along "
            "which the force acts"
        )
    hz = [q.test_hz for q in seen.pairs]
    low, high = UPDATING.band[0] * min(hz), UPDATING.band[1] * max(hz)
    driven = told.driven
    for out, by in r.points:
        found = _of_test(r, out, by)
        measured = 2.0 * np.pi * found[(found >= low) & (found <= high)]
        zeros, motions = told.model.antiresonances(driven[by])
        yield _Point(told.model, measured, zeros, motions, _match(measured, zeros))


def _of_test(r: Responses, out: int, by: int) -> Floats:
    return antiresonances(r.frequencies_hz, r.values[out, by])


def _match(measured: Floats, zeros: Floats) -> Ints:
    """Return partners one to one, nearest by ratio, within reach."""
    own = np.sqrt(np.maximum(zeros, np.finfo(float).tiny))
    off = np.abs(np.log(measured[:, None] / own[None, :]))
    off = np.minimum(off, UPDATING.antiresonance_reach)
    match = np.full(len(measured), -1)
    rows, columns = linear_sum_assignment(off)
    near = off[rows, columns] < UPDATING.antiresonance_reach
    match[rows[near]] = columns[near]
    return match


def _value(seen: Seen) -> Floats:
    """(μ_a − μ_t)/(2 μ_t), μ = ω²; what is due beyond reach for a zero without a partner."""
    parts = [np.zeros(0)]
    for p in _points(seen):
        off = (p.zeros[p.match] / p.measured**2 - 1.0) / 2.0
        parts.append(np.where(p.match < 0, UPDATING.antiresonance_reach, off))
    return np.asarray(np.concatenate(parts)[:, None])


def _derivative(seen: Seen, slopes: Slopes) -> Floats:
    parts = [np.zeros((0, len(slopes.parameters)))]
    for p in _points(seen):
        moved = p.model.antiresonance_slopes(
            p.zeros[p.match], p.motions[:, p.match], slopes.parameters
        )
        moved = moved / (2.0 * p.measured[:, None] ** 2)
        parts.append(np.where(p.match[:, None] < 0, 0.0, moved))
    return np.asarray(np.concatenate(parts)[:, None, :])


ANTIRESONANCES = Residual(
    "antiresonances",
    "antiresonance_sigma",
    UPDATING.antiresonance,
    _value,
    _derivative,
    hears=True,
)
"""Relative differences of the antiresonances of driving points."""
