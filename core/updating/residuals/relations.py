"""What is known of parameters beside one another: ratios and sums of their values."""

from __future__ import annotations

import numpy as np

from ...arrays import Floats
from ..updating_numbers import UPDATING
from .declaration import Relation, Residual, Seen, Slopes


def _said(r: Relation, p: Floats) -> tuple[float, Floats]:
    """Return what a relation is at the factors, and its derivative by each."""
    above, below = float(r.above @ p), float(r.below @ p) if r.below.any() else 1.0
    return above / below, np.asarray(r.above / below - above * r.below / below**2)


def _value(seen: Seen) -> Floats:
    known = seen.beside.relations
    off = [(_said(r, seen.factors)[0] - r.value) / r.sigma for r in known]
    return np.reshape(off, (len(known), 1))


def _derivative(seen: Seen, slopes: Slopes) -> Floats:
    at, known = list(slopes.parameters), seen.beside.relations
    moved = [_said(r, seen.factors)[1][at] / r.sigma for r in known]
    return np.reshape(moved, (len(known), 1, len(at)))


RELATIONS = Residual(
    "relations", "relation_sigma", UPDATING.relation, _value, _derivative, stated=True
)
"""Differences of ratios and sums from what is known of them, over their own standard deviations."""
