"""Axes that belong to a structure, not to the frame in which a deck describes it."""

import numpy as np

from ...arrays import Floats
from .reduction_numbers import REDUCTION


def own_axes(xyz: Floats) -> Floats:
    """Return the principal axes of points (n, 3), one a row, that of the largest extent first.

    They point to where the points reach further out (third moment). Where a structure is as long
    along several, or as far either way, it does not tell them apart, and basic axes do.
    """
    away = xyz - xyz.mean(axis=0)
    moments, vectors = np.linalg.eigh(away.T @ away)
    apart = np.diff(moments[::-1]) < -REDUCTION.alike * moments[-1]
    group = np.append(0, np.cumsum(apart))[::-1]
    axes = []
    for k in range(group.max() + 1):
        span = vectors[:, group == k] @ vectors[:, group == k].T
        for _ in range(np.count_nonzero(group == k)):
            v = span[:, np.argmax(np.round(np.diag(span) / REDUCTION.alike))]
            v = v / np.linalg.norm(v)
            span = span - np.outer(v, v)
            out = (away @ v) ** 3
            axes.append(-v if out.sum() < -REDUCTION.alike * np.abs(out).sum() else v)
    return np.array(axes)
