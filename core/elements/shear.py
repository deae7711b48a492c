"""Shear panels as Nastran's CSHEAR."""

from __future__ import annotations

import numpy as np

from ..arrays import Floats
from .batch import congruent, transpose
from .normals import warp_map
from .quad4 import AT_CENTRE, AT_NODES, flat, quad4_axes, quad4_mass

_EDGES = ((0, 1), (1, 2), (2, 3), (3, 0))


def shear_panel_stiffness(xyz: Floats, E: Floats, G: Floats, t: Floats) -> Floats:
    """Stiffness of panels that carry shear flow along their edges only, (n, 24, 24).

    The four edge forces in equilibrium with each other are unique up to one factor; the energy
    is that of the panel's shear flow, with the direct stress that goes with it in a
    parallelogram (Garvey 1951): 1 + 4 tan(skew)**2 G / E. Exact for rectangles and
    parallelograms.

    Parameters
    ----------
    xyz : (n, 4, 3) float
        Grid positions, basic frame.
    E, G, t : (n,) float
        Young's modulus, shear modulus, thickness.
    """
    n = len(xyz)
    axes = quad4_axes(xyz)
    local, height = flat(xyz, axes)
    edge = np.stack([local[:, j] - local[:, i] for i, j in _EDGES], axis=1)
    start = local
    # flows q: sum q e = 0 and sum q (x cross e) = 0, scaled to mean 1
    moment = start[..., 0] * edge[..., 1] - start[..., 1] * edge[..., 0]
    rows = np.concatenate([transpose(edge), moment[:, None]], axis=1)
    q = np.linalg.svd(rows)[2][:, 3]
    q = q / (np.array([1.0, -1.0, 1.0, -1.0]) * q).mean(axis=1, keepdims=True)
    f = np.zeros((n, 4, 2))
    for k, (i, j) in enumerate(_EDGES):
        half = 0.5 * q[:, k, None] * edge[:, k]
        f[:, i] += half
        f[:, j] += half
    a = AT_CENTRE @ local
    area = 4.0 * np.linalg.det(a)
    dot = np.einsum("ni,ni->n", a[:, 0], a[:, 1])
    tangent2 = (4.0 * dot / area) ** 2
    squared = 0.5 * (np.abs(q[:, 0] * q[:, 2]) + np.abs(q[:, 1] * q[:, 3]))
    flexibility = area * squared / (G * t) * (1.0 + 4.0 * tangent2 * G / E)
    K = np.zeros((n, 4, 6, 4, 6))
    K[:, :, :2, :, :2] = f[:, :, :, None, None] * (f / flexibility[:, None, None])[:, None, None]
    gradients = np.linalg.inv(AT_NODES @ local[:, None]) @ AT_NODES
    T = np.zeros((n, 4, 6, 4, 6))
    for i in range(4):
        T[:, i, :3, i, :3] = T[:, i, 3:, i, 3:] = axes
    W, _ = warp_map(local, height, gradients)
    return congruent(K.reshape(n, 24, 24), W @ T.reshape(n, 24, 24))


def shear_panel_mass(xyz: Floats, areal_density: Floats, coupled: bool) -> Floats:
    """Mass of shear panels, (n, 24, 24), as of four-node shells."""
    return quad4_mass(xyz, areal_density, coupled)
