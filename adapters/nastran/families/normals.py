"""Normals of curved shells at their grids (PARAM,SNORM)."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from ....core.arrays import Floats, Ints
from ....core.elements.shell import corner_normals, grid_normals


def shell_normals(
    corners: Sequence[Ints], axes: Sequence[Floats], n_grid: int, limit_deg: float
) -> list[Floats | None]:
    """Average the normals of all shells at their grids.

    Parameters
    ----------
    corners : sequence of (n, m) int
        Grid rows of the corners, one array a shape.
    axes : sequence of (n, 3, 3) float
        Element axes, same order.
    n_grid : int
        Number of grids.
    limit_deg : float
        PARAM SNORM; zero or less: none.

    Returns
    -------
    list of (n, m, 3) float or None
        Normals at the corners of each shape's elements.
    """
    if limit_deg <= 0.0 or not corners:
        return [None] * len(corners)
    every = np.concatenate([c.reshape(-1) for c in corners])
    normal = np.concatenate(
        [corner_normals(a, c.shape[1]) for a, c in zip(axes, corners, strict=True)]
    )
    normals = grid_normals(every, normal, n_grid, limit_deg)
    return [normals[c] for c in corners]
