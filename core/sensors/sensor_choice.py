"""Where to put sensors and exciters so that a test tells the modes of a model apart."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from ..arrays import Floats, Ints
from ..errors import InputError
from .placement_numbers import PLACEMENT


def effective_independence(shapes: Floats, count: int, wanted: Sequence[int] = ()) -> Ints:
    """Choose `count` of the rows of shapes (n_candidate, n_mode) that keep the modes independent.

    Rows that add least to det(ΦᵀΦ) are left out, one by one once there are few, until `count` are
    left; `wanted` rows stay. Rising order.

    Raises
    ------
    InputError
        Fewer sensors than modes, or than are wanted; modes that the candidates do not tell apart.

    References
    ----------
    Kammer (1991), Sensor placement for on-orbit modal identification and correlation of large
    space structures, J. Guidance 14(2).
    """
    n, m = shapes.shape
    if count < m or count < len(wanted):
        raise InputError(
            f"{count} sensors are fewer than {m} modes need, or than the {len(wanted)} wanted"
        )
    kept = np.arange(n)
    fixed = np.isin(kept, wanted)
    unit = shapes / np.maximum(np.linalg.norm(shapes, axis=0), np.finfo(float).tiny)
    while len(kept) > count:
        q, r = np.linalg.qr(unit[kept])
        pivots = np.abs(np.diag(r))
        if pivots.min() <= PLACEMENT.dependent * pivots.max():
            raise InputError("the candidates do not tell all of the modes apart; give more of them")
        share = np.where(fixed[kept], np.inf, np.sum(q**2, axis=1))
        spare = len(kept) - count
        drop = max(1, min(spare, int(PLACEMENT.at_once * len(kept))))
        drop = drop if len(kept) > PLACEMENT.one_by_one else 1
        kept = np.delete(kept, np.argsort(share, kind="stable")[:drop])
    return np.asarray(kept)


def least_off_diagonal(shapes: Floats, count: int, wanted: Sequence[int] = ()) -> Ints:
    """Choose rows by which the largest MAC of two different modes is least, one after another.

    Begins with as many rows as modes, chosen by `effective_independence`; of equal ones the row
    that moves most comes first. Rising order.

    References
    ----------
    Carne, Dohrmann (1995), A modal test design strategy for model correlation, IMAC XIII.
    """
    m = shapes.shape[1]
    start = max(m, len(wanted))
    if len(shapes) > max(PLACEMENT.pool, count):
        pool = effective_independence(shapes, max(PLACEMENT.pool, count), wanted)
        inside = np.flatnonzero(np.isin(pool, wanted)).tolist()
        return np.asarray(pool[least_off_diagonal(shapes[pool], count, inside)])
    chosen = effective_independence(shapes, start, wanted).tolist()
    if count < start:
        raise InputError(f"{count} sensors are fewer than the {start} that are needed")
    own = np.einsum("nj,nk->njk", shapes, shapes)
    whole = own[chosen].sum(axis=0)
    while len(chosen) < count:
        sums = whole + own
        size = np.einsum("njj->nj", sums)
        macs = sums**2 / (size[:, :, None] * size[:, None, :])
        macs[:, np.arange(m), np.arange(m)] = 0.0
        worst = macs.max(axis=(1, 2))
        worst[chosen] = np.inf
        best = int(np.argmin(worst))
        chosen.append(best)
        whole = whole + own[best]
    return np.sort(np.array(chosen))


def drive_points(shapes: Floats, frequencies_hz: Floats, count: int) -> tuple[Ints, Floats]:
    """Choose `count` rows that excite all modes, and the share of each mode they reach.

    The drive-point residue of mode j at a place i is φ_ij² / (2 ω_j) for unit modal mass; its share
    is that over the largest of any place. Rows are taken one after another so that the least
    excited mode is excited most. Returns rows (count,) and shares (count, n_mode).
    """
    residue = shapes**2 / (2.0 * (2.0 * np.pi * frequencies_hz))
    share = residue / np.maximum(residue.max(axis=0), np.finfo(float).tiny)
    reached, rows = np.zeros(shapes.shape[1]), list[int]()
    for _ in range(min(count, len(shapes))):
        together = np.maximum(share, reached)
        merit = together.min(axis=1) + PLACEMENT.slight * together.mean(axis=1)
        merit[rows] = -np.inf
        rows.append(int(np.argmax(merit)))
        reached = np.maximum(reached, share[rows[-1]])
    return np.array(rows, np.int64), share[rows]
