"""Isoparametric solids: stiffness by quadrature, lumped and consistent mass."""

from __future__ import annotations

import numpy as np

from ..arrays import Floats
from .batch import in_chunks, symmetric, transpose
from .lumping import to_middle_nodes
from .solid_shapes import (
    HEXA8,
    HEXA20,
    PENTA6,
    PENTA15,
    PYRAMID5,
    PYRAMID13,
    TETRA4,
    TETRA10,
    Solid,
)

_CHUNK = 128


def displacement_gradients(xyz: Floats, derivatives: Floats) -> tuple[Floats, Floats, Floats]:
    """Jacobians (n, m, 3, 3), their determinants (n, m), and gradients (n, m, 3, k) of the shapes.

    Parameters
    ----------
    xyz : (n, k, 3) float
        Node positions.
    derivatives : (m, 3, k) float
        Of the shape functions, by the natural coordinates, at m points.
    """
    J = derivatives @ xyz[:, None]
    return J, np.linalg.det(J), np.linalg.inv(J) @ derivatives


def strain_operator(g: Floats) -> Floats:
    """Strains xx, yy, zz, xy, yz, zx from u v w of each node, (..., 6, 3 k)."""
    B = np.zeros((*g.shape[:-2], 6, 3 * g.shape[-1]))
    x, y, z = g[..., 0, :], g[..., 1, :], g[..., 2, :]
    B[..., 0, 0::3] = B[..., 3, 1::3] = B[..., 5, 2::3] = x
    B[..., 1, 1::3] = B[..., 3, 0::3] = B[..., 4, 2::3] = y
    B[..., 2, 2::3] = B[..., 4, 1::3] = B[..., 5, 0::3] = z
    return B


def energy(B: Floats, C: Floats, weight: Floats) -> Floats:
    """Sum over points of B^T C B weight: (n, m, 6, k), (n, 6, 6), (n, m) -> (n, k, k)."""
    n, m, _, k = B.shape
    CB = (C[:, None] @ B) * weight[..., None, None]
    return symmetric(transpose(B.reshape(n, m * 6, k)) @ CB.reshape(n, m * 6, k))


def solid_stiffness(solid: Solid, xyz: Floats, C: Floats) -> Floats:
    """Stiffness by the element's own quadrature, (n, 3 k, 3 k); see the named functions."""

    def matrices(part: slice) -> Floats:
        _, derivatives = solid.shape(solid.points)
        _, detJ, g = displacement_gradients(xyz[part], derivatives)
        return energy(strain_operator(g), C[part], detJ * solid.weights)

    return in_chunks(len(xyz), 3 * solid.nodes, matrices, _CHUNK)


def solid_mass(solid: Solid, xyz: Floats, density: Floats, coupled: bool) -> Floats:
    """Mass of solids, (n, 3 k, 3 k).

    Parameters
    ----------
    solid : Solid
        Which element.
    xyz : (n, k, 3) float
        Node positions, basic frame.
    density : (n,) float
    coupled : bool
        Consistent mass; otherwise lumped by row sums, where there are middle nodes all of it at
        these (see `lumping.to_middle_nodes`).
    """
    k = solid.nodes

    def matrices(part: slice) -> Floats:
        N, derivatives = solid.shape(solid.mass_points)
        detJ = np.linalg.det(derivatives @ xyz[part][:, None])
        weight = detJ * solid.mass_weights * density[part, None]
        m = transpose(N[None] * weight[..., None]) @ N
        if not coupled:
            share = m.sum(axis=2)
            if len(solid.edges):
                share = to_middle_nodes(share, xyz[part], k - len(solid.edges))
            m = share[:, :, None] * np.eye(k)
        M = np.zeros((len(m), k, 3, k, 3))
        for i in range(3):
            M[:, :, i, :, i] = m
        return M.reshape(-1, 3 * k, 3 * k)

    return in_chunks(len(xyz), 3 * k, matrices, _CHUNK)


def solid_volume(solid: Solid, xyz: Floats) -> Floats:
    """Volumes, (n,); negative: inside out."""
    _, derivatives = solid.shape(solid.mass_points)
    return np.asarray(np.linalg.det(derivatives @ xyz[:, None]) @ solid.mass_weights)


def tetra4_stiffness(xyz: Floats, C: Floats) -> Floats:
    """Stiffness of four-node tetrahedra, constant strain, (n, 12, 12).

    `xyz` (n, 4, 3), `C` (n, 6, 6) in the basic frame; u v w of node 1, of node 2, ...
    """
    return solid_stiffness(TETRA4, xyz, C)


def tetra10_stiffness(xyz: Floats, C: Floats) -> Floats:
    """Stiffness of ten-node tetrahedra, (n, 30, 30).

    Five points, exact for straight edges; on a curved one this is MSC Nastran's matrix to seven
    digits.
    """
    return solid_stiffness(TETRA10, xyz, C)


def pyramid5_stiffness(xyz: Floats, C: Floats) -> Floats:
    """Stiffness of five-node pyramids, (n, 15, 15)."""
    return solid_stiffness(PYRAMID5, xyz, C)


def pyramid13_stiffness(xyz: Floats, C: Floats) -> Floats:
    """Stiffness of thirteen-node pyramids, (n, 39, 39)."""
    return solid_stiffness(PYRAMID13, xyz, C)


def hexa8_mass(xyz: Floats, density: Floats, coupled: bool) -> Floats:
    """Mass of eight-node bricks, (n, 24, 24)."""
    return solid_mass(HEXA8, xyz, density, coupled)


def hexa20_mass(xyz: Floats, density: Floats, coupled: bool) -> Floats:
    """Mass of twenty-node bricks, (n, 60, 60)."""
    return solid_mass(HEXA20, xyz, density, coupled)


def penta6_mass(xyz: Floats, density: Floats, coupled: bool) -> Floats:
    """Mass of six-node wedges, (n, 18, 18)."""
    return solid_mass(PENTA6, xyz, density, coupled)


def penta15_mass(xyz: Floats, density: Floats, coupled: bool) -> Floats:
    """Mass of fifteen-node wedges, (n, 45, 45)."""
    return solid_mass(PENTA15, xyz, density, coupled)


def tetra4_mass(xyz: Floats, density: Floats, coupled: bool) -> Floats:
    """Mass of four-node tetrahedra, (n, 12, 12)."""
    return solid_mass(TETRA4, xyz, density, coupled)


def tetra10_mass(xyz: Floats, density: Floats, coupled: bool) -> Floats:
    """Mass of ten-node tetrahedra, (n, 30, 30)."""
    return solid_mass(TETRA10, xyz, density, coupled)


def pyramid5_mass(xyz: Floats, density: Floats, coupled: bool) -> Floats:
    """Mass of five-node pyramids, (n, 15, 15)."""
    return solid_mass(PYRAMID5, xyz, density, coupled)


def pyramid13_mass(xyz: Floats, density: Floats, coupled: bool) -> Floats:
    """Mass of thirteen-node pyramids, (n, 39, 39)."""
    return solid_mass(PYRAMID13, xyz, density, coupled)
