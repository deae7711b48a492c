"""The two residuals of the source paper on plain arrays."""

from __future__ import annotations

import numpy as np

from trueup.core.correlation.mode_pairing import Pair
from trueup.core.updating.residuals import Linearisation, Seen, Slopes
from trueup.core.updating.residuals.frequencies import FREQUENCIES
from trueup.core.updating.residuals.shapes import SHAPES


def eigenvalue_residuals(pairs, eigenvalues, slopes, sigma) -> Linearisation:
    none = np.zeros((0, len(pairs)))
    seen = Seen(None, None, tuple(pairs), eigenvalues, none, none)
    return FREQUENCIES.linearised(seen, Slopes((0,), slopes, None), sigma)


def shape_residuals(analysis, slopes, test, sigma) -> Linearisation:
    n = analysis.shape[1]
    seen = Seen(None, None, (Pair(0, 0, 1.0, 1.0, 1.0),) * n, np.ones(n), analysis, test)
    return SHAPES.linearised(seen, Slopes((0,), np.zeros((n, 1)), slopes), sigma)
