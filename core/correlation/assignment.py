"""Optimal one-to-one assignment of test modes."""

from __future__ import annotations

import numpy as np
from scipy.optimize import linear_sum_assignment

from ..arrays import Bools, Floats


def assign(score: Floats, allowed: Bools) -> tuple[tuple[int, int], ...]:
    """One-to-one assignment of rows to columns that maximises the summed score.

    Parameters
    ----------
    score : (n_row, n_col) float
        For modes: the MAC.
    allowed : (n_row, n_col) bool
        Pairs that may be formed at all; the assignment forms as many of these as add to the
        sum and never another.

    Returns
    -------
    tuple of (row, column)
        By rising row.

    References
    ----------
    Kuhn (1955), the Hungarian method, in scipy's implementation.
    """
    if score.size == 0:
        return ()
    gain = np.where(allowed, np.maximum(score, 0.0), 0.0)
    rows, cols = linear_sum_assignment(gain, maximize=True)
    return tuple((int(r), int(c)) for r, c in zip(rows, cols, strict=True) if allowed[r, c])
