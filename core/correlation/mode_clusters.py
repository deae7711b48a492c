"""Close or repeated modes, treated as one subspace."""

from __future__ import annotations

import numpy as np

from ..arrays import Floats


def clusters_by_bandwidth(frequencies_hz: Floats, width: float) -> tuple[tuple[int, ...], ...]:
    """Group neighbouring frequencies so that no group spans more than a relative bandwidth.

    The closest neighbours are joined first (complete linkage), so a chain of evenly spaced
    modes is not swallowed whole and a true pair is never split to serve a looser one.

    Parameters
    ----------
    frequencies_hz : (n_mode,) float
        In any order; zeros (rigid-body modes) and NaN are left out.
    width : float
        Largest (f_last − f_first) / f_last within a group; 0 joins nothing.

    Returns
    -------
    tuple of tuple of int
        Mode indices, each used once, groups and members by rising frequency; groups of one
        included.
    """
    f = np.asarray(frequencies_hz, dtype=float)
    order = [int(i) for i in np.argsort(f, kind="stable") if np.isfinite(f[i]) and f[i] > 0.0]
    groups = [[i] for i in order]
    while len(groups) > 1 and width > 0.0:
        first = np.array([f[g[0]] for g in groups])
        last = np.array([f[g[-1]] for g in groups])
        span = (last[1:] - first[:-1]) / last[1:]
        k = int(np.argmin(span))
        if span[k] > width:
            break
        groups[k : k + 2] = [groups[k] + groups[k + 1]]
    return tuple(tuple(g) for g in groups)
