"""Springs of six components between two grids, or a grid and the ground, as Nastran's CBUSH."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from ..arrays import Floats
from ..data.shapes import LINE, POINT
from .bar import offset_transform
from .batch import congruent
from .element import Element


def bush_stiffness(axes: Floats, k: Floats, arm_a: Floats, arm_b: Floats) -> Floats:
    """Stiffness of bushings (or damping, with damping in place of stiffness).

    Parameters
    ----------
    axes : (n, 3, 3) float
        Rows are the axes of the springs in the basic frame.
    k : (n, 6) float
        Stiffness along and about the axes.
    arm_a, arm_b : (n, 3) float
        From the grids to the place of the springs, basic frame.

    Returns
    -------
    (n, 12, 12) float
        Basic frame; grid A, then grid B. The first six rows and columns are a grounded bushing.
    """
    n = len(axes)
    relative = np.zeros((n, 6, 12))
    for first in (0, 3):
        part = slice(first, first + 3)
        relative[:, part, part] = -axes
        relative[:, part, slice(first + 6, first + 9)] = axes
    K = np.asarray(relative.swapaxes(-1, -2) @ (k[..., None] * relative))
    return congruent(K, offset_transform(arm_a, arm_b))


BUSH = Element(name="bush", shape=LINE, freedoms=6, stiffness=bush_stiffness, material=False)
GROUNDED_BUSH = replace(BUSH, name="grounded_bush", shape=POINT)
