"""Which poles stay where they are while the model order rises."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy.optimize import linear_sum_assignment

from ...arrays import Bools, Floats, Ints, Numbers
from .plscf import PoleSet
from .pole_numbers import POLES


@dataclass(frozen=True, eq=False)
class Candidate:
    """A root that was found again and again over the model orders.

    Parameters
    ----------
    pole : complex
        In rad/s.
    participation : (n_input,) complex
        NaN at inputs that took no part.
    length : int
        Number of orders it was found at.
    """

    pole: complex
    participation: Numbers
    length: int


@dataclass(frozen=True, eq=False)
class Chart:
    """The stabilisation diagram: one row per pole of any order.

    Parameters
    ----------
    order : (n_point,) int
    frequency_hz : (n_point,) float
    damping : (n_point,) float
    level : (n_point,) int
        0 for a pole that continues none of the next lower orders, 1 for one that does, 2 where
        its damping stays too, 3 where damping and participation stay.
    """

    order: Ints
    frequency_hz: Floats
    damping: Floats
    level: Ints

    @property
    def stable(self) -> Bools:
        """Whether the pole continues one of the next lower orders, (n_point,)."""
        return np.asarray(self.level > 0)


def stabilise(
    sets: Sequence[PoleSet], low: float, high: float
) -> tuple[tuple[Candidate, ...], Chart]:
    """Follow poles over rising orders, one to one, and keep those that stabilise.

    Parameters
    ----------
    sets : sequence of PoleSet
        By rising order.
    low, high : float
        Poles outside this band [Hz] are left out.

    Returns
    -------
    candidates : tuple of Candidate
        By rising frequency; a track that lived for at least a quarter of the orders (and four).
    chart : Chart
    """
    tracks: list[_Track] = []
    rows: list[tuple[int, float, float, int]] = []
    for s in sets:
        s = _plausible(s, low, high)
        level = _extend(tracks, s)
        magnitude = np.abs(s.values)
        for k in range(len(magnitude)):
            hz, zeta = magnitude[k] / (2.0 * np.pi), -s.values[k].real / magnitude[k]
            rows.append((s.order, float(hz), float(zeta), int(level[k])))
    enough = max(POLES.track_least, len(sets) // POLES.track_least)
    found = [t.candidate() for t in tracks if len(t.poles) >= enough]
    found.sort(key=lambda c: abs(c.pole))
    table = np.array(rows, dtype=float).reshape(-1, 4)
    order, level = table[:, 0].astype(np.int64), table[:, 3].astype(np.int64)
    return tuple(found), Chart(order, table[:, 1], table[:, 2], level)


class _Track:
    """Poles of successive orders taken for the same root; grows while orders are read."""

    def __init__(self, order: int, pole: complex, participation: Numbers) -> None:
        self.order = order
        self.poles = [pole]
        self.participations = [participation]

    def add(self, order: int, pole: complex, participation: Numbers) -> None:
        self.order = order
        self.poles.append(pole)
        self.participations.append(participation)

    def candidate(self) -> Candidate:
        poles = np.array(self.poles[-POLES.track_members :])
        pole = complex(np.median(poles.real), np.median(poles.imag))
        w = np.array(self.participations[-POLES.track_members :])
        u, _, _ = np.linalg.svd(w.T, full_matrices=False)
        return Candidate(pole, u[:, 0], len(self.poles))


def _plausible(s: PoleSet, low: float, high: float) -> PoleSet:
    magnitude = np.abs(s.values)
    damping = -s.values.real / magnitude
    hz = magnitude / (2.0 * np.pi)
    keep = (damping > 0.0) & (damping < POLES.damping_most) & (hz >= low) & (hz <= high)
    return PoleSet(s.order, s.values[keep], s.participation[keep])


def _extend(tracks: list[_Track], s: PoleSet) -> Ints:
    """Join the poles of one order to the tracks; return how well each did, see `Chart`."""
    level = np.zeros(len(s.values), dtype=np.int64)
    alive = [t for t in tracks if s.order - t.order <= POLES.track_patience]
    if alive and len(s.values):
        distance = _distance(
            np.array([t.poles[-1] for t in alive]),
            np.array([t.participations[-1] for t in alive]),
            s.values,
            s.participation,
        )
        pairs = linear_sum_assignment(np.minimum(distance, POLES.track_reach))
        for a, b in zip(*pairs, strict=True):
            if distance[a, b] < POLES.track_reach:
                level[b] = _level(alive[a], complex(s.values[b]), s.participation[b])
                alive[a].add(s.order, complex(s.values[b]), s.participation[b])
    for k in np.flatnonzero(level == 0):
        tracks.append(_Track(s.order, complex(s.values[k]), s.participation[k]))
    return level


def _level(track: _Track, pole: complex, participation: Numbers) -> int:
    last = track.poles[-1]
    before, now = -last.real / abs(last), -pole.real / abs(pole)
    if abs(now - before) > POLES.damping_stays * before:
        return 1
    mac = abs(np.vdot(track.participations[-1], participation)) ** 2
    return 3 if mac >= POLES.participation_stays else 2


def _distance(a: Numbers, wa: Numbers, b: Numbers, wb: Numbers) -> Floats:
    """Distance of poles in half bandwidths, plus half of what their participations differ.

    A change of the damping by 30 % or of the frequency by 0.3 half bandwidths alone stays within
    0.3; participations may turn within a pair of equal poles, so they count less.
    """
    width = np.minimum(np.abs(a.real)[:, None], np.abs(b.real)[None, :])
    apart = np.abs(a[:, None] - b[None, :]) / np.maximum(width, POLES.width_least)
    mac = np.abs(wa.conj() @ wb.T) ** 2
    return np.asarray(2.0 * apart + 0.5 * (1.0 - mac))
