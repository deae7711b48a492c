"""What was known of the parameters before the test."""

from __future__ import annotations

import numpy as np

from ...arrays import Floats
from ..updating_numbers import UPDATING
from .declaration import Residual, Seen, Slopes


def _weights(seen: Seen) -> Floats:
    return np.sqrt([q.weight for q in seen.model.parameters])


def _value(seen: Seen) -> Floats:
    """(p − 1) √w of every parameter: those that stay at the deck's value cost nothing."""
    return np.asarray(((seen.factors - 1.0) * _weights(seen))[:, None])


def _derivative(seen: Seen, slopes: Slopes) -> Floats:
    moved = np.eye(len(seen.factors))[:, list(slopes.parameters)]
    return np.asarray((moved * _weights(seen)[:, None])[:, None, :])


PRIOR = Residual("prior", "prior_sigma", UPDATING.prior, _value, _derivative, believes_sigmas=True)
"""Difference of each factor from 1; σ is what the deck's values are believed to."""
