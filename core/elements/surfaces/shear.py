"""Shear panels as Nastran's CSHEAR."""

from dataclasses import replace

import numpy as np

from ...arrays import Floats
from ...data.shapes import QUAD
from ..batch import arms, congruent, transpose
from ..lines.bar import rod_stiffness
from .normals import warp_map
from .quad4 import AT_CENTRE, AT_NODES, QUAD4, flat, quad4_axes


def shear_panel_stiffness(
    xyz: Floats, E: Floats, G: Floats, t: Floats, f1: Floats | float = 0.0, f2: Floats | float = 0.0
) -> Floats:
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
    f1, f2 : (n,) float
        Of the panel's direct stiffness, along sides 1-2 and 3-4, and along the others (PSHEAR).
    """
    n = len(xyz)
    axes = quad4_axes(xyz)
    local, height = flat(xyz, axes)
    edge = np.stack([local[:, j] - local[:, i] for i, j in QUAD.sides], axis=1)
    # flows q: sum q e = 0 and sum q (x cross e) = 0, scaled to mean 1
    moment = local[..., 0] * edge[..., 1] - local[..., 1] * edge[..., 0]
    rows = np.concatenate([transpose(edge), moment[:, None]], axis=1)
    q = np.linalg.svd(rows)[2][:, 3]
    q = q / (np.array([1.0, -1.0, 1.0, -1.0]) * q).mean(axis=1, keepdims=True)
    f = np.zeros((n, 4, 2))
    for k, (i, j) in enumerate(QUAD.sides):
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
    W, _ = warp_map(local, height, gradients)
    K = congruent(K.reshape(n, 24, 24), W @ arms(axes, np.zeros((n, 4, 3))))
    return K + _rods(xyz, E, t, f1, f2) if np.any(f1) or np.any(f2) else K


def _rods(xyz: Floats, E: Floats, t: Floats, f1: Floats | float, f2: Floats | float) -> Floats:
    """Rods along the sides that stand for the panel's direct stiffness.

    Their areas are F t (panel area) / (sum of the two sides' lengths), or F t**2 / 2 where F is
    above 1.01 (Quick Reference Guide, PSHEAR).
    """
    sides = [xyz[:, j] - xyz[:, i] for i, j in QUAD.sides]
    length = np.stack([np.linalg.norm(s, axis=1) for s in sides], axis=1)
    area = 0.5 * np.linalg.norm(np.cross(xyz[:, 2] - xyz[:, 0], xyz[:, 3] - xyz[:, 1]), axis=1)
    K = np.zeros((len(xyz), 4, 6, 4, 6))
    for k, side in enumerate(QUAD.sides):
        f = np.asarray(f1 if k % 2 == 0 else f2)
        wide = f * t * area / (length[:, k] + length[:, (k + 2) % 4])
        A = np.where(f > 1.01, 0.5 * f * t**2, wide)
        rod = rod_stiffness(xyz[:, side], E, A, 0.0 * E, 0.0 * E).reshape(-1, 2, 6, 2, 6)
        for a, p in enumerate(side):
            for b, q in enumerate(side):
                K[:, p, :, q] += rod[:, a, :, b]
    return K.reshape(-1, 24, 24)


SHEAR_PANEL = replace(QUAD4, name="shear_panel", stiffness=shear_panel_stiffness)
