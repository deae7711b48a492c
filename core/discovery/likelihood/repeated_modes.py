"""Modes of one frequency: any vectors of their plane are modes, so those the test found are taken.

Which ones a solver gives follows from rounding. What looks at single vectors, a slope or the length
at the sensors, must not.
"""

from itertools import pairwise

import numpy as np

from ...arrays import Bools, Floats, Ints
from .likelihood_numbers import LIKELIHOOD


def turned_to_test(vectors: Floats, values: Floats, cross: Floats, match: Ints) -> Floats:
    """Return vectors (r, n) of repeated eigenvalues (n,) turned to the shapes that match them.

    By the orthogonal matrix nearest to what the test's shapes are on them (Schönemann 1966), so
    that they stay modes; `cross` (n_test, m) are products of test shapes with the first m at the
    sensors, `match` (n_test,) the mode of each.
    """
    values = values[: cross.shape[1] + 1]  # what is repeated beyond these no shape matches
    ends = [0, *(np.flatnonzero(_apart(values)) + 1).tolist(), len(values)]
    out = vectors
    for first, end in pairwise(ends):
        tests = np.flatnonzero((match >= first) & (match < end)) if end - first > 1 else ()
        if not len(tests) or end > cross.shape[1]:
            continue
        group = np.arange(first, end)
        U, _, Vt = np.linalg.svd(cross[np.ix_(tests, group)].T)
        R, n = np.empty_like(U), len(tests)
        own = match[tests] - first
        R[:, own] = U[:, :n] @ Vt
        R[:, np.setdiff1d(group - first, own)] = U[:, n:]
        out = vectors.copy() if out is vectors else out
        out[:, group] = vectors[:, group] @ R
    return out


def _apart(values: Floats) -> Bools:
    return np.asarray(np.diff(values) > LIKELIHOOD.repeated * np.abs(values[1:]))


def in_pairs(values: Floats) -> bool:
    """Whether most of ascending eigenvalues (n,) have another so near that the two turn freely.

    As those of round structures do.
    """
    near = np.diff(values) < LIKELIHOOD.mixing * values[1:]
    return bool(np.mean(np.append(near, False) | np.append(False, near)) > LIKELIHOOD.paired)


def none_cut(values: Floats, number: int) -> int:
    """Return so many of eigenvalues (n,), or as many more as are repeated ones of the last."""
    apart = _apart(values)
    while 0 < number < len(values) and not apart[number - 1]:
        number += 1
    return number
