"""Bricks as Nastran's CHEXA, eight and twenty nodes."""

from __future__ import annotations

import numpy as np

from ..arrays import Floats
from .batch import condense, in_chunks, symmetric, transpose
from .material import strain_transform
from .solid import displacement_gradients, energy, solid_stiffness, strain_operator
from .solid_shapes import HEXA8, HEXA20, gauss_line, hexa8, hexa20

_CHUNK = 128
# shear component -> natural direction along which it keeps its variation
_KEPT = {3: 2, 4: 0, 5: 1}


def _bubbles(p: Floats) -> Floats:
    """Strains of the internal modes at the points, (m, 6, 15).

    Direct strains: x, x y, x z of E_xx and cyclic; shears: x and y of E_xy and cyclic.
    """
    modes = np.zeros((len(p), 6, 15))
    for k in range(3):
        i, j = (k + 1) % 3, (k + 2) % 3
        modes[:, k, 3 * k] = p[:, k]
        modes[:, k, 3 * k + 1] = p[:, k] * p[:, i]
        modes[:, k, 3 * k + 2] = p[:, k] * p[:, j]
        modes[:, 3 + k, 9 + 2 * k] = p[:, k]
        modes[:, 3 + k, 10 + 2 * k] = p[:, i]
    return modes


_AT_CENTRE = hexa8(np.zeros((1, 3)))[1]
_BUBBLES = _bubbles(HEXA8.points)
_OUTER, _INNER = np.arange(24), np.arange(24, 39)


def hexa8_stiffness(xyz: Floats, C: Floats, integration: str = "bubble") -> Floats:
    """Stiffness of eight-node bricks.

    By default 2x2x2 points with reduced shear and bubble functions, Nastran's default: each
    shear is its mean over the two directions that it shears, direct strains are enhanced by
    internal modes that take away the Poisson stiffening. This reproduces the NX and MSC element
    matrix of a cube to rounding; on distorted bricks strains are taken in the basis of the
    Jacobian at the centre, after MacNeal (1987), *The shape sensitivity of isoparametric
    elements*, and Taylor, Beresford, Wilson (1976) for the internal modes.

    Parameters
    ----------
    xyz : (n, 8, 3) float
        Node positions, basic frame.
    C : (n, 6, 6) float
        Elastic matrices, basic frame.
    integration : {"bubble", "reduced", "full"}
        With bubbles and reduced shear, with reduced shear only, or plain isoparametric.

    Returns
    -------
    (n, 24, 24) float
        u v w of node 1, of node 2, ...
    """
    if integration == "full":
        return solid_stiffness(HEXA8, xyz, C)
    with_bubbles = integration == "bubble"

    def matrices(part: slice) -> Floats:
        return _hexa8(xyz[part], C[part], with_bubbles)

    return in_chunks(len(xyz), 24, matrices, _CHUNK)


def _hexa8(xyz: Floats, C: Floats, with_bubbles: bool) -> Floats:
    T, C = centre_basis(xyz, C, _AT_CENTRE)
    _, derivatives = HEXA8.shape(HEXA8.points)
    _, detJ, g = displacement_gradients(xyz, derivatives)
    B = T[:, None] @ strain_operator(g)
    for row, kept in _KEPT.items():
        for side in (-1.0, 1.0):
            at = np.flatnonzero(HEXA8.points[:, kept] * side > 0.0)
            weight = detJ[:, at] / detJ[:, at].sum(axis=1, keepdims=True)
            B[:, at, row] = np.einsum("nm,nmk->nk", weight, B[:, at, row])[:, None]
    if not with_bubbles:
        return energy(B, C, detJ)
    ratio = (np.linalg.det(_AT_CENTRE @ xyz[:, None])[:, 0, None] / detJ)[..., None, None]
    both = np.concatenate([B, _BUBBLES * ratio], axis=3)
    return condense(energy(both, C, detJ), _OUTER, _INNER)


def centre_basis(xyz: Floats, C: Floats, at_centre: Floats) -> tuple[Floats, Floats]:
    """Strains and elastic matrices in the basis of the Jacobian at the centre (unit vectors).

    Returns
    -------
    T : (n, 6, 6) float
        Strains in the basis from Cartesian strains.
    C : (n, 6, 6) float
        Elastic matrices for those strains.
    """
    basis = (at_centre @ xyz[:, None])[:, 0]
    basis = basis / np.linalg.norm(basis, axis=2, keepdims=True)
    T = strain_transform(basis)
    inverse = np.linalg.inv(T)
    return T, symmetric(transpose(inverse) @ C @ inverse)


def _reduction(row: int) -> tuple[Floats, Floats]:
    """Points where a shear of the twenty-node brick is sampled, and their weights at its points.

    2 x 2 points in the directions that it shears, the full three along the other.
    """
    kept = _KEPT[row]
    i, j = (kept + 1) % 3, (kept + 2) % 3
    two, three = gauss_line(2)[0], gauss_line(3)[0]
    samples = np.zeros((12, 3))
    a, b, c = np.meshgrid(two, two, three, indexing="ij")
    samples[:, i], samples[:, j], samples[:, kept] = a.ravel(), b.ravel(), c.ravel()
    p = HEXA20.points[:, None]
    linear = (
        0.25 * (1.0 + 3.0 * p[..., i] * samples[:, i]) * (1.0 + 3.0 * p[..., j] * samples[:, j])
    )
    same = np.isclose(p[..., kept], samples[:, kept])
    return samples, np.where(same, linear, 0.0)


_REDUCTIONS = {row: _reduction(row) for row in _KEPT}


def hexa20_stiffness(xyz: Floats, C: Floats, integration: str = "reduced") -> Floats:
    """Stiffness of twenty-node bricks, (n, 60, 60).

    Parameters
    ----------
    xyz : (n, 20, 3) float
        Node positions, basic frame.
    C : (n, 6, 6) float
        Elastic matrices, basic frame.
    integration : {"reduced", "full", "two"}
        3x3x3 points with shears sampled at 2x2 points of their plane (Nastran's default), plain
        3x3x3, or plain 2x2x2.
    """
    if integration == "full":
        return solid_stiffness(HEXA20, xyz, C)

    def matrices(part: slice) -> Floats:
        if integration == "two":
            _, derivatives = hexa20(HEXA8.points)
            _, detJ, g = displacement_gradients(xyz[part], derivatives)
            return energy(strain_operator(g), C[part], detJ)
        return _hexa20(xyz[part], C[part])

    return in_chunks(len(xyz), 60, matrices, _CHUNK // 2)


def _hexa20(xyz: Floats, C: Floats) -> Floats:
    T, C = centre_basis(xyz, C, hexa20(np.zeros((1, 3)))[1])
    _, derivatives = HEXA20.shape(HEXA20.points)
    _, detJ, g = displacement_gradients(xyz, derivatives)
    B = T[:, None] @ strain_operator(g)
    for row, (samples, weights) in _REDUCTIONS.items():
        _, _, g = displacement_gradients(xyz, hexa20(samples)[1])
        sampled = (T[:, None, row : row + 1] @ strain_operator(g))[:, :, 0]
        B[:, :, row] = weights @ sampled
    return energy(B, C, detJ * HEXA20.weights)
