"""Grid normals of curved shells, and what they and warping do to the motions of a flat element.

A faceted shell without normals is hinged: where two elements meet at an angle, a bending moment
can only pass as a moment about the (almost free) normal of the neighbour. Nastran averages the
normals at a grid (PARAM,SNORM) and lets each element take the rotation about the averaged normal
from its own in-plane rotation, so that this rotation carries nothing.
"""

import numpy as np

from ...arrays import Floats, Ints
from ..batch import transpose, unit

_ALIGNED = 64.0 * np.finfo(float).eps
_FLAT = 1e-12


def grid_normals(corner: Ints, normal: Floats, n_grid: int, limit_deg: float = 20.0) -> Floats:
    """Average the element normals at each grid.

    Parameters
    ----------
    corner : (k,) int
        Grid (row) of each corner of each shell.
    normal : (k, 3) float
        Unit normal of the shell that the corner belongs to, basic frame.
    n_grid : int
        Number of grids.
    limit_deg : float
        Grids where any normal is this far [degrees] or farther from the mean have none.

    Returns
    -------
    (n_grid, 3) float
        Unit normals; NaN at grids without one.
    """
    mean = np.zeros((n_grid, 3))
    np.add.at(mean, corner, normal)
    length = np.linalg.norm(mean, axis=1)
    defined = length > 1e-12
    mean[defined] /= length[defined, None]
    cosine = np.clip(np.einsum("ki,ki->k", mean[corner], normal), -1.0, 1.0)
    defined[corner[cosine <= np.cos(np.radians(limit_deg))]] = False
    mean[~defined] = np.nan
    return mean


def director_slopes(normals: Floats, axes: Floats) -> Floats:
    """Slopes (n_x / n_z, n_y / n_z) of grid normals in element axes, (n, m, 2).

    Parameters
    ----------
    normals : (n, m, 3) float
        Grid normals at the corners, basic frame, either sense; NaN: none.
    axes : (n, 3, 3) float
        Rows are the element axes.
    """
    local = normals @ transpose(axes)
    with np.errstate(divide="ignore", invalid="ignore"):
        slopes = local[..., :2] / local[..., 2:]
    slopes[~np.isfinite(slopes).all(axis=-1)] = 0.0
    slopes[np.hypot(slopes[..., 0], slopes[..., 1]) < _ALIGNED] = 0.0
    return np.asarray(slopes)


def normal_map(slopes: Floats, gradients: Floats) -> Floats:
    """Motions that a flat element uses from the motions of its corners, given grid normals.

    With d = rz - (v,x - u,y) / 2 at the corner and slopes p, q:
    rx -> rx - p d, ry -> ry - q d, rz -> rz + p (rx - w,y) + q (ry + w,x).
    A rigid motion is left as it is, and rotation about the grid normal does no work but against
    the drilling stiffness.

    Parameters
    ----------
    slopes : (n, m, 2) float
        From `director_slopes`.
    gradients : (n, m, 2, m) float
        Derivatives by x and y of the shape functions at each corner.

    Returns
    -------
    (n, 6 m, 6 m) float
    """
    n, m = slopes.shape[:2]
    T = np.tile(np.eye(6 * m), (n, 1, 1)).reshape(n, m, 6, m, 6)
    half = 0.5 * gradients
    for i in range(m):
        p, q = slopes[:, i, 0], slopes[:, i, 1]
        for row, slope in ((3, p), (4, q)):
            T[:, i, row, i, 5] -= slope
            T[:, i, row, :, 0] -= slope[:, None] * half[:, i, 1]
            T[:, i, row, :, 1] += slope[:, None] * half[:, i, 0]
        T[:, i, 5, i, 3] += p
        T[:, i, 5, i, 4] += q
        T[:, i, 5, :, 2] += q[:, None] * gradients[:, i, 0] - p[:, None] * gradients[:, i, 1]
    return T.reshape(n, 6 * m, 6 * m)


def warp_map(local: Floats, height: Floats, gradients: Floats) -> tuple[Floats, Floats]:
    """Motions of the projection of warped quads from the motions of their corners.

    In-plane forces at the projected corners are brought to the grids by transverse forces
    (MacNeal 1978: no moments), nodal moments stand on the tilted corner of the bilinear surface:
    u -> u + h w,x, v -> v + h w,y, rx -> rx + h,x (rz - f), ry -> ry + h,y (rz - f), with f the
    rotation of the diagonal through the corner.

    Parameters
    ----------
    local : (n, 4, 2) float
        Corners on the mean plane.
    height : (n, 4) float
        Heights of the grids above it.
    gradients : (n, 4, 2, 4) float
        Derivatives by x and y of the shape functions at each corner.

    Returns
    -------
    T : (n, 24, 24) float
    tilt : (n, 4, 2) float
        Slopes h,x and h,y at the corners.
    """
    n = len(local)
    T = np.tile(np.eye(24), (n, 1, 1)).reshape(n, 4, 6, 4, 6)
    tilt = np.einsum("nidj,nj->nid", gradients, height)
    for i in range(4):
        a, b = i % 2, i % 2 + 2
        d = local[:, b] - local[:, a]
        d /= (d**2).sum(axis=1, keepdims=True)
        for axis in range(2):
            T[:, i, axis, :, 2] += height[:, i, None] * gradients[:, i, axis]
            slope = tilt[:, i, axis]
            row = T[:, i, 3 + axis]
            row[:, i, 5] += slope
            row[:, b, 0] += slope * d[:, 1]
            row[:, a, 0] -= slope * d[:, 1]
            row[:, b, 1] -= slope * d[:, 0]
            row[:, a, 1] += slope * d[:, 0]
    return T.reshape(n, 24, 24), tilt


def is_warped(local: Floats, height: Floats) -> bool:
    """Whether any of the quads is warped beyond rounding."""
    return bool((np.abs(height).max(axis=1) > _FLAT * np.abs(local).max(axis=(1, 2))).any())


def corner_normals(axes: Floats, m: int) -> Floats:
    """Repeat the normals of the elements for their corners, (n m, 3), for `grid_normals`."""
    return np.repeat(unit(axes[:, 2]), m, axis=0)
