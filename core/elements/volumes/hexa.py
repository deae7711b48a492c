"""Bricks as Nastran's CHEXA, eight and twenty nodes."""

import numpy as np

from ...arrays import Floats
from ...data.shapes import HEXA
from ..batch import unit
from ..middle_nodes import serendipity
from ..quadrature import gauss_hexa, gauss_line
from .solid import Solid, energy, in_basis, stacked_edges, strains, with_bubbles

SQUARE = np.array([[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]])
_HEXA = np.column_stack([np.tile(SQUARE, (2, 1)), np.repeat([-1.0, 1.0], 4)])
_EDGES = stacked_edges(4)
_TWO, _THREE = gauss_hexa(2), gauss_hexa(3)
# shear component -> natural direction along which it keeps its variation
_KEPT = {3: 2, 4: 0, 5: 1}


def hexa8(p: Floats) -> tuple[Floats, Floats]:
    """Trilinear shape functions."""
    f = 1.0 + _HEXA * p[:, None, :]
    N = f.prod(axis=2) / 8.0
    d = [_HEXA[:, k] * f[:, :, k - 2] * f[:, :, k - 1] / 8.0 for k in range(3)]
    return N, np.stack(d, axis=1)


def hexa20(p: Floats) -> tuple[Floats, Floats]:
    """Serendipity shape functions of the 20-node brick."""
    return serendipity(_HEXA, _EDGES, p)


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
_BUBBLES = _bubbles(_TWO[0])


def _hexa8(xyz: Floats, C: Floats, integration: str) -> Floats:
    """Stiffness of eight-node bricks, with bubbles and reduced shear or with the latter only.

    2x2x2 points with reduced shear and bubble functions are Nastran's default: each shear is its
    mean over the two directions that it shears, direct strains are enhanced by internal modes
    that take away the Poisson stiffening. This reproduces the NX and MSC element matrix of a cube
    to rounding; on distorted bricks strains are taken in the basis of the Jacobian at the centre,
    after MacNeal (1987), *The shape sensitivity of isoparametric elements*, and Taylor,
    Beresford, Wilson (1976) for the internal modes.
    """
    T, C = _in_centre_basis(xyz, C, _AT_CENTRE)
    points = _TWO[0]
    B, detJ = strains(xyz, hexa8, points)
    B = T[:, None] @ B
    for row, kept in _KEPT.items():
        for side in (-1.0, 1.0):
            at = np.flatnonzero(points[:, kept] * side > 0.0)
            weight = detJ[:, at] / detJ[:, at].sum(axis=1, keepdims=True)
            B[:, at, row] = np.einsum("nm,nmk->nk", weight, B[:, at, row])[:, None]
    if integration == "reduced":
        return energy(B, C, detJ)
    ratio = (np.linalg.det(_AT_CENTRE @ xyz[:, None])[:, 0, None] / detJ)[..., None, None]
    return with_bubbles(B, _BUBBLES * ratio, C, detJ)


def _in_centre_basis(xyz: Floats, C: Floats, at_centre: Floats) -> tuple[Floats, Floats]:
    """Strains and elastic matrices in the basis of the Jacobian at the centre (unit vectors)."""
    return in_basis(C, unit((at_centre @ xyz[:, None])[:, 0]))


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
    p = _THREE[0][:, None]
    linear = (
        0.25 * (1.0 + 3.0 * p[..., i] * samples[:, i]) * (1.0 + 3.0 * p[..., j] * samples[:, j])
    )
    same = np.isclose(p[..., kept], samples[:, kept])
    return samples, np.where(same, linear, 0.0)


_REDUCTIONS = {row: _reduction(row) for row in _KEPT}


def _hexa20(xyz: Floats, C: Floats, _integration: str) -> Floats:
    """Stiffness of twenty-node bricks, shears sampled at 2x2 points of their plane."""
    T, C = _in_centre_basis(xyz, C, hexa20(np.zeros((1, 3)))[1])
    points, point_weights = _THREE
    B, detJ = strains(xyz, hexa20, points)
    B = T[:, None] @ B
    for row, (samples, weights) in _REDUCTIONS.items():
        sampled = T[:, None, row : row + 1] @ strains(xyz, hexa20, samples)[0]
        B[:, :, row] = weights @ sampled[:, :, 0]
    return energy(B, C, detJ * point_weights)


HEXA8 = Solid(
    name="hexa8",
    shape=HEXA,
    interpolation=hexa8,
    rules={"full": _TWO},
    mass_rule=_TWO,
    kernel=_hexa8,
    integrations=("bubble", "reduced", "full"),
)
HEXA20 = Solid(
    name="hexa20",
    unknown="reduced shear",
    shape=HEXA,
    edges=_EDGES,
    interpolation=hexa20,
    rules={"full": _THREE, "two": _TWO},
    mass_rule=_THREE,
    kernel=_hexa20,
    integrations=("reduced", "full", "two"),
)
