"""Modes of the test that are no vibration of the structure: it swings on its suspension."""

from __future__ import annotations

import numpy as np

from ..arrays import Bools, Floats
from ..comparison import Placed
from ..correlation import realised
from ..eigen import Eigensolution

_BELOW = 0.5
"""Frequency beside the first elastic one of the model, below which a mode may be a rigid one."""
_FAR_BELOW = 0.15
"""The same, below which it is one whatever its shape: what its sensors do not measure."""
_RIGID = 0.8
"""Share of a shape's square that rigid motions take up, if it is one."""


def elastic(placed: Placed, solution: Eigensolution, motion: Floats) -> Bools:
    """Return which test modes are elastic, (n_test,).

    A mode at 0 Hz is not, nor one well below the first elastic mode of a free model whose shape
    is a motion of the whole, nor one far below it.

    Parameters
    ----------
    placed : Placed
    solution : Eigensolution
        Of the deck.
    motion : (n_dof, n_mode) float
        Its modes on all analysis dofs.
    """
    hz, n = placed.test.frequencies_hz, solution.rigid_body_modes
    moving = hz > 0.0
    if not n or len(solution.eigenvalues) <= n:
        return np.asarray(moving)
    first = np.sqrt(solution.eigenvalues[n]) / (2.0 * np.pi)
    Q, _ = np.linalg.qr(placed.observation.matrix @ motion[:, :n])
    shapes = realised(placed.test.shapes)
    whole = np.sum(shapes**2, axis=0)
    share = np.sum((Q.T @ shapes) ** 2, axis=0) / np.maximum(whole, np.finfo(float).tiny)
    swings = (hz < _FAR_BELOW * first) | ((hz < _BELOW * first) & (share > _RIGID))
    return np.asarray(moving & ~swings)
