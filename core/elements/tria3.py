"""Three-node shell as Nastran's CTRIA3."""

from __future__ import annotations

import numpy as np

from ..arrays import Floats
from .batch import arms, congruent, in_chunks, transpose, unit
from .normals import director_slopes, normal_map
from .quad4 import edge_shear_operator
from .section import ShellSection
from .transverse_shear import bending_scale, finite_shear, residual_flexibility

_EDGES = ((0, 1), (1, 2), (2, 0))
_NODE = 6 * np.arange(3)
_MEMBRANE = np.concatenate([_NODE, _NODE + 1])
_BENDING = np.concatenate([_NODE + 4, _NODE + 3])  # beta_x = ry, beta_y = -rx
_SIGN = np.repeat([1.0, -1.0], 3)
_CONSISTENT = (np.ones((3, 3)) + np.eye(3)) / 12.0


def tria3_axes(xyz: Floats) -> Floats:
    """Element axes as Nastran's: x from node 1 to node 2, z normal.

    Parameters
    ----------
    xyz : (n, 3, 3) float

    Returns
    -------
    (n, 3, 3) float
        Rows are the unit vectors x, y, z in the basic frame.
    """
    x = unit(xyz[:, 1] - xyz[:, 0])
    z = unit(np.cross(x, xyz[:, 2] - xyz[:, 0]))
    return np.stack([x, np.cross(z, x), z], axis=1)


def tria3_area(xyz: Floats) -> Floats:
    """Areas, (n,)."""
    normal = np.cross(xyz[:, 1] - xyz[:, 0], xyz[:, 2] - xyz[:, 0])
    return np.asarray(0.5 * np.linalg.norm(normal, axis=1))


def tria3_stiffness(
    xyz: Floats,
    section: ShellSection,
    k6rot: float = 100.0,
    offset: Floats | float = 0.0,
    normals: Floats | None = None,
) -> Floats:
    """Stiffness of three-node shells.

    Constant membrane strain and curvature; transverse shear assumed constant along each edge
    with the flexibility t Z t^T + tr(Z) / 2 between unit edge strains, where t are the edge
    directions and Z = 1 / (G ts) + Z_b holds MacNeal's residual bending flexibility. This law
    was identified from NX Nastran's element matrices, which it reproduces to rounding for right
    isosceles triangles of three thicknesses.

    Parameters
    ----------
    xyz : (n, 3, 3) float
        Grid positions, basic frame.
    section : ShellSection
        Of each element, in element axes (`tria3_axes`).
    k6rot : float
        Factor on the stiffness about the normal, 1e-6 G t 2A.
    offset : (n,) float
        Distance of the reference surface from the grids along the element normal.
    normals : (n, 3, 3) float, optional
        Grid normals at the corners, basic frame, NaN where a grid has none (`grid_normals`).

    Returns
    -------
    (n, 18, 18) float
        Basic frame; u v w rx ry rz of node 1, of node 2, ...
    """
    n = len(xyz)
    offset = np.broadcast_to(np.asarray(offset, float), (n,))

    def matrices(part: slice) -> Floats:
        at = None if normals is None else normals[part]
        return _stiffness(xyz[part], section.take(part), k6rot, offset[part], at)

    return in_chunks(n, 18, matrices)


def tria3_mass(xyz: Floats, areal_density: Floats, coupled: bool) -> Floats:
    """Mass of three-node shells, (n, 18, 18), translations only.

    Parameters
    ----------
    xyz : (n, 3, 3) float
        Grid positions, basic frame.
    areal_density : (n,) float
        Mass per area, rho t + non-structural mass.
    coupled : bool
        Consistent mass of the linear shape functions; otherwise a third of the mass a grid.
    """
    mass = areal_density * tria3_area(xyz)
    m = mass[:, None, None] * (_CONSISTENT if coupled else np.eye(3) / 3.0)
    M = np.zeros((len(xyz), 3, 6, 3, 6))
    for k in range(3):
        M[:, :, k, :, k] = m
    return M.reshape(-1, 18, 18)


def _stiffness(
    xyz: Floats, section: ShellSection, k6rot: float, offset: Floats, normals: Floats | None
) -> Floats:
    n = len(xyz)
    axes = tria3_axes(xyz)
    local = ((xyz - xyz[:, :1]) @ transpose(axes))[:, :, :2]
    edge = np.stack([local[:, j] - local[:, i] for i, j in _EDGES], axis=1)
    area = tria3_area(xyz)
    # gradients of the shape functions: the opposite edge turned by a right angle, over 2 A
    opposite = edge[:, [1, 2, 0]] / (2.0 * area)[:, None, None]
    g = np.stack([-opposite[:, :, 1], opposite[:, :, 0]], axis=1)
    K = np.zeros((n, 18, 18))
    _add_plane(K, section, g, area)
    _add_shear(K, section, edge, area)
    _add_drilling(K, section.drilling * k6rot * 1e-6 * 2.0 * area, g)
    arm = np.zeros((n, 3, 3))
    arm[:, :, 2] = offset[:, None]
    T = arms(axes, arm)
    if normals is not None:
        slopes = director_slopes(normals, axes)
        if slopes.any():
            T = normal_map(slopes, np.broadcast_to(g[:, None], (n, 3, 2, 3))) @ T
    return congruent(K, T)


def _add_plane(K: Floats, section: ShellSection, g: Floats, area: Floats) -> None:
    B = np.zeros((len(K), 3, 6))
    B[:, 0, :3] = B[:, 2, 3:] = g[:, 0]
    B[:, 1, 3:] = B[:, 2, :3] = g[:, 1]
    weighted = transpose(B * area[:, None, None])
    K[:, _MEMBRANE[:, None], _MEMBRANE] += weighted @ section.A @ B
    K[:, _BENDING[:, None], _BENDING] += (weighted @ section.D @ B) * np.outer(_SIGN, _SIGN)
    if section.B.any():
        Kc = (weighted @ section.B @ B) * _SIGN
        K[:, _MEMBRANE[:, None], _BENDING] += Kc
        K[:, _BENDING[:, None], _MEMBRANE] += transpose(Kc)


def _add_shear(K: Floats, section: ShellSection, edge: Floats, area: Floats) -> None:
    scale = bending_scale(section.D)
    bends = scale.all(axis=1)
    S = finite_shear(section, np.sqrt(area))
    S = np.where(bends[:, None, None], S, np.eye(2))
    Z = np.linalg.inv(S) + residual_flexibility(edge, scale)
    length = np.linalg.norm(edge, axis=2)
    uniform = 0.5 * np.einsum("nii->n", Z)[:, None, None]
    F = edge @ Z @ transpose(edge) + uniform * (length[:, :, None] * length[:, None, :])
    C = np.linalg.inv(F) * area[:, None, None]
    C[~bends] = 0.0
    V = edge_shear_operator(edge, _EDGES, 3)
    plate = np.concatenate([_NODE + 2, _NODE + 3, _NODE + 4])
    K[:, plate[:, None], plate] += transpose(V) @ C @ V


def _add_drilling(K: Floats, stiffness: Floats, g: Floats) -> None:
    """Penalty on the difference of each grid's rotation and that of the plane."""
    r = np.zeros((len(K), 3, 9))
    r[:, :, :3] = 0.5 * g[:, None, 1]
    r[:, :, 3:6] = -0.5 * g[:, None, 0]
    r[:, np.arange(3), 6 + np.arange(3)] = 1.0
    rows = np.concatenate([_NODE, _NODE + 1, _NODE + 5])
    K[:, rows[:, None], rows] += transpose(r * stiffness[:, None, None]) @ r
