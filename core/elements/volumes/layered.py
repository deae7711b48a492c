"""Bricks and wedges of plies, one on the other along a natural axis."""

import numpy as np

from ...arrays import Floats, Ints
from ...data.shapes import HEXA, TRIA
from ..batch import condense, in_chunks, symmetric, transpose, unit
from ..quadrature import gauss_line, gauss_tria
from .solid import Solid, in_basis, strains

_ALONG = np.array([0, 1, 3])
"""Strains that are continuous from ply to ply: xx, yy, xy, z being the stack."""
_ACROSS = np.array([2, 4, 5])
"""Those whose stresses are: zz, yz, zx."""
_CENTRE = {True: np.zeros((1, 3)), False: np.array([[1.0 / 3.0, 1.0 / 3.0, 0.0]])}
_FACES = np.array([[0.5, 0.0, 0.0], [0.5, 0.5, 0.0], [0.0, 0.5, 0.0]])
"""Middles of the upright faces of a wedge, edges 1-2, 2-3, 3-1."""
_CHUNK = 64


def layered_stiffness(solid: Solid, xyz: Floats, C: Floats, share: Floats, axis: int) -> Floats:
    """Stiffness of laminated solids, (n, 3 k, 3 k).

    Elements without middle nodes: across the stack the stresses zz, yz, zx are one for all plies
    and do the work of the mean strains; along it every ply has the strains of the place (plane
    stress). zx, yz and xy are means over the directions that they shear, and xx, yy are enhanced
    by internal modes, as in the brick of one material. Elements with middle nodes are integrated
    ply by ply as they are.

    Parameters
    ----------
    solid : Solid
        A brick, or a wedge with its `axis` 2.
    xyz : (n, k, 3) float
        Node positions, basic frame.
    C : (n, p, 6, 6) float
        Elastic matrices of the plies, basic frame, in the order of the natural coordinate.
    share : (p,) float
        Of the thickness; sums to one.
    axis : {0, 1, 2}
        Natural axis of the stack.
    """
    points, weights, plies = _points(solid, share, axis)
    quadratic = len(solid.edges) > 0

    def matrices(part: slice) -> Floats:
        x, c = xyz[part], C[part]
        g, m = weights.shape
        B, detJ = strains(x, solid.interpolation, points.reshape(-1, 3))
        detJ = detJ.reshape(-1, g, m)
        volume = detJ * weights
        B = B.reshape(len(x), g, m, 6, -1)
        if quadratic:
            K = transpose(B) @ c[:, None, plies] @ B * volume[..., None, None]
            return symmetric(K.sum(axis=(1, 2)))
        J = (solid.interpolation(_CENTRE[solid.shape is HEXA])[1] @ x[:, None])[:, 0]
        z = (axis + 2) % 3
        basis = _basis(J[:, (axis + 1) % 3], J[:, z])
        T, c = in_basis(c.reshape(-1, 6, 6), np.repeat(basis, len(share), axis=0))
        B, c = T[:: len(share), None, None] @ B, c.reshape(-1, len(share), 6, 6)
        if solid.shape is HEXA:
            B = _reduced(B, volume, points[:, 0, [(axis + 1) % 3, z]])
            modes = _modes(points, axis) * (np.linalg.det(J)[:, None, None] / detJ)[..., None, None]
            B = np.concatenate([B, modes], axis=4)
        else:
            B = _by_edges(solid, x, B, basis, T[:: len(share), None])
        return _mixed(B, c, volume, plies, 3 * solid.nodes)

    return in_chunks(len(xyz), 3 * solid.nodes, matrices, _CHUNK)


def _points(solid: Solid, share: Floats, axis: int) -> tuple[Floats, Floats, Ints]:
    """Points (g, m, 3) and weights (g, m): g in the plane, m along the stack; ply of each m."""
    more = len(solid.edges) > 0
    if solid.shape is HEXA:
        x, w = gauss_line(3 if more else 2)
        plane = np.stack(np.meshgrid(x, x, indexing="ij"), axis=-1).reshape(-1, 2)
        area = np.outer(w, w).ravel()
    else:
        plane, area = gauss_tria(7 if more else 3)
    x, w = gauss_line(2)
    middle = -1.0 + 2.0 * (np.cumsum(share) - 0.5 * share)
    zeta, line = (middle[:, None] + share[:, None] * x).ravel(), np.outer(share, w).ravel()
    points = np.empty((len(plane), len(zeta), 3))
    points[..., (axis + 1) % 3] = plane[:, None, 0]
    points[..., (axis + 2) % 3] = plane[:, None, 1]
    points[..., axis] = zeta
    return points, np.outer(area, line), np.repeat(np.arange(len(share)), 2)


def _basis(a: Floats, b: Floats) -> Floats:
    """Axes with z across the plane of a and b, x along a, (n, 3, 3)."""
    x, z = unit(a), unit(np.cross(a, b))
    return np.stack([x, np.cross(z, x), z], axis=1)


def _mixed(B: Floats, C: Floats, volume: Floats, plies: Ints, outer: int) -> Floats:
    """Stiffness with continuous stresses across the stack; freedoms from `outer` on condensed.

    With strains e along and the stresses s across, ply by ply, those across are S (s - C_ae e),
    S = C_aa^-1; their mean is that of the nodes, which gives s.
    """
    weight = (volume / volume.sum(axis=2, keepdims=True))[..., None, None]
    S = np.linalg.inv(C[:, :, _ACROSS[:, None], _ACROSS])
    follow = S @ C[:, :, _ACROSS[:, None], _ALONG]
    plane = C[:, :, _ALONG[:, None], _ALONG] - C[:, :, _ALONG[:, None], _ACROSS] @ follow
    along, across = B[..., _ALONG, :], B[..., _ACROSS, :]
    K = transpose(along) @ plane[:, None, plies] @ along * volume[..., None, None]
    mean = ((across + follow[:, None, plies] @ along) * weight).sum(axis=2)
    stiff = np.linalg.inv((S[:, None, plies] * weight).sum(axis=2))
    through = transpose(mean) @ stiff @ mean * volume.sum(axis=2)[..., None, None]
    K = symmetric(K.sum(axis=(1, 2)) + through.sum(axis=1))
    every = np.arange(K.shape[1])
    return condense(K, every[:outer], every[outer:]) if len(every) > outer else K


def _reduced(B: Floats, volume: Floats, at: Floats) -> Floats:
    """Shears as means over the directions in the plane that they shear: zx x, yz y, xy both."""
    B = B.copy()
    for row, group in ((5, at[:, 1]), (4, at[:, 0]), (3, np.zeros(len(at)))):
        shear = B[:, :, :, row]
        for value in np.unique(group):
            rows = np.flatnonzero(group == value)
            w = volume[:, rows] / volume[:, rows].sum(axis=1, keepdims=True)
            shear[:, rows] = np.einsum("ngm,ngmk->nmk", w, shear[:, rows])[:, None]
    return B


def _by_edges(solid: Solid, xyz: Floats, B: Floats, basis: Floats, T: Floats) -> Floats:
    """Shears zx, yz of a wedge from those along its edges, as in the wedge of one material."""
    corner = 0.5 * (xyz[:, :3] + xyz[:, 3:]) @ transpose(basis)[:, :, :2]
    t = unit(np.stack([corner[:, j] - corner[:, i] for i, j in TRIA.sides], axis=1))
    shear = (T @ strains(xyz, solid.interpolation, _FACES)[0])[:, :, [5, 4]]
    edge = np.einsum("nkd,nkdj->nkj", t, shear)
    field = np.linalg.solve(np.concatenate([t, np.ones((len(xyz), 3, 1))], axis=2), edge)
    B = B.copy()
    for row, d in ((5, 0), (4, 1)):
        B[:, :, :, row] = (field[:, None, d] + t[:, :, d, None] * field[:, None, 2])[:, :, None]
    return B


def _modes(points: Floats, axis: int) -> Floats:
    """Return internal strains xx: x, x y, x z; yy: y, y z, y x, (g, m, 6, 6)."""
    x, y, z = (points[..., (axis + k) % 3] for k in (1, 2, 0))
    modes = np.zeros((*points.shape[:2], 6, 6))
    for k, values in enumerate((x, x * y, x * z)):
        modes[..., 0, k] = values
    for k, values in enumerate((y, y * z, y * x), 3):
        modes[..., 1, k] = values
    return modes
