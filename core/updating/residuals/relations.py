"""What is known of parameters beside one another: ratios and sums of their values."""

from __future__ import annotations

import numpy as np

from ...arrays import Floats
from ...errors import InputError
from ..updating_numbers import UPDATING
from .declaration import Relation, Residual, Seen, Slopes


def _each(seen: Seen) -> tuple[Relation, ...]:
    if not seen.beside.relations:
        raise InputError(
            "the residual 'relations' needs what is known of parameters: give relations, such as "
            "'skin / web = 2 ± 0.1'"
        )
    return seen.beside.relations


def _said(r: Relation, p: Floats) -> tuple[float, Floats]:
    """Return what a relation is at the factors, and its derivative by each."""
    above, below = float(r.above @ p), float(r.below @ p) if r.below.any() else 1.0
    return above / below, np.asarray(r.above / below - above * r.below / below**2)


def _value(seen: Seen) -> Floats:
    off = [(_said(r, seen.factors)[0] - r.value) / r.sigma for r in _each(seen)]
    return np.array(off)[:, None]


def _derivative(seen: Seen, slopes: Slopes) -> Floats:
    moved = [_said(r, seen.factors)[1][list(slopes.parameters)] / r.sigma for r in _each(seen)]
    return np.array(moved)[:, None, :]


RELATIONS = Residual("relations", "relation_sigma", UPDATING.relation, _value, _derivative)
"""Differences of ratios and sums from what is known of them, over their own standard deviations."""
