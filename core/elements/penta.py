"""Wedges as Nastran's CPENTA, six and fifteen nodes."""

from __future__ import annotations

import numpy as np

from ..arrays import Floats
from .batch import condense, in_chunks, symmetric, transpose, unit
from .material import strain_transform
from .solid import displacement_gradients, energy, solid_stiffness, strain_operator
from .solid_shapes import PENTA6, PENTA15, gauss_line, gauss_tria, penta6, penta15

_CHUNK = 128
_AT_CENTRE = penta6(np.array([[1.0 / 3.0, 1.0 / 3.0, 0.0]]))[1][0]
# middles of the three faces, edges 1-2, 2-3, 3-1
_FACES = np.array([[0.5, 0.0, 0.0], [0.5, 0.5, 0.0], [0.0, 0.5, 0.0]])
_EDGES = ((0, 1), (1, 2), (2, 0))
_OUTER, _INNER = np.arange(18), np.arange(18, 21)


def penta6_stiffness(xyz: Floats, C: Floats, integration: str = "bubble") -> Floats:
    """Stiffness of six-node wedges.

    By default 3 x 2 points with reduced shear and bubble functions, Nastran's default. Shear
    across the triangle is fixed by the strains g along the middles of its three edges:
    g = t . gamma + q, and gamma + q t_k at the k-th point, t being the edge directions; internal
    modes are quadratic along the axis, and L1 L2 + L2 L3 + L3 L1 in the plane. This law was
    identified from NX and MSC Nastran, whose matrices of right isosceles wedges it reproduces to
    rounding.

    Parameters
    ----------
    xyz : (n, 6, 3) float
        Node positions, basic frame.
    C : (n, 6, 6) float
        Elastic matrices, basic frame.
    integration : {"bubble", "reduced", "full"}
        With bubbles and reduced shear, with reduced shear only, or plain isoparametric.

    Returns
    -------
    (n, 18, 18) float
        u v w of node 1, of node 2, ...
    """
    if integration == "full":
        return solid_stiffness(PENTA6, xyz, C)
    with_bubbles = integration == "bubble"

    def matrices(part: slice) -> Floats:
        return _penta6(xyz[part], C[part], with_bubbles)

    return in_chunks(len(xyz), 18, matrices, _CHUNK)


def _penta6(xyz: Floats, C: Floats, with_bubbles: bool) -> Floats:
    n = len(xyz)
    basis, T, C = _middle_basis(xyz, C)
    _, derivatives = PENTA6.shape(PENTA6.points)
    _, detJ, g = displacement_gradients(xyz, derivatives)
    B = T[:, None] @ strain_operator(g)

    corner = 0.5 * (xyz[:, :3] + xyz[:, 3:]) @ transpose(basis)[:, :, :2]
    t = unit(np.stack([corner[:, j] - corner[:, i] for i, j in _EDGES], axis=1))
    _, _, g = displacement_gradients(xyz, penta6(_FACES)[1])
    at_faces = T[:, None] @ strain_operator(g)
    shear = at_faces[:, :, [5, 4]]  # zx, yz
    edge = np.einsum("nkd,nkdj->nkj", t, shear)
    field = np.linalg.solve(np.concatenate([t, np.ones((n, 3, 1))], axis=2), edge)
    for point in range(6):
        k = point % 3
        B[:, point, 5] = field[:, 0] + t[:, k, 0, None] * field[:, 2]
        B[:, point, 4] = field[:, 1] + t[:, k, 1, None] * field[:, 2]

    weight = detJ * PENTA6.weights
    if not with_bubbles:
        return energy(B, C, weight)
    J0 = _AT_CENTRE @ xyz
    ratio = np.linalg.det(J0)[:, None] / detJ
    both = np.concatenate([B, _bubbles(corner) * ratio[..., None, None]], axis=3)
    return condense(energy(both, C, weight), _OUTER, _INNER)


def _middle_basis(xyz: Floats, C: Floats) -> tuple[Floats, Floats, Floats]:
    """Basis of the middle triangle (x along edge 1-2, y in its plane) and of the axis."""
    J = _AT_CENTRE @ xyz
    x = unit(J[:, 0])
    normal = unit(np.cross(J[:, 0], J[:, 1]))
    basis = np.stack([x, np.cross(normal, x), unit(J[:, 2])], axis=1)
    T = strain_transform(basis)
    inverse = np.linalg.inv(T)
    return basis, T, symmetric(transpose(inverse) @ C @ inverse)


def _bubbles(corner: Floats) -> Floats:
    """Strains of the internal modes at the points, (n, 6, 6, 3), from the middle triangle."""
    modes = np.zeros((len(corner), 6, 6, 3))
    p = PENTA6.points
    L = np.column_stack([1.0 - p[:, 0] - p[:, 1], p[:, 0], p[:, 1]])
    edge = np.stack([corner[:, k - 1] - corner[:, k - 2] for k in range(3)], axis=1)
    area2 = edge[:, 0, 0] * edge[:, 1, 1] - edge[:, 0, 1] * edge[:, 1, 0]
    gradient = np.stack([-edge[..., 1], edge[..., 0]], axis=2) / area2[:, None, None]
    slope = -(L @ gradient)
    modes[:, :, 2, 0] = p[:, 2]
    modes[:, :, 0, 1] = modes[:, :, 3, 2] = slope[..., 0]
    modes[:, :, 1, 2] = modes[:, :, 3, 1] = slope[..., 1]
    return modes


def _samples() -> tuple[Floats, Floats]:
    """Points where transverse shears of the fifteen-node wedge are sampled, and weights."""
    tria, line = gauss_tria(3)[0], gauss_line(2)[0]
    samples = np.concatenate([np.column_stack([tria, np.full(3, z)]) for z in line])
    p = PENTA15.points
    L = np.column_stack([1.0 - p[:, 0] - p[:, 1], p[:, 0], p[:, 1]])
    nodal = 2.0 * L - 1.0 / 3.0  # linear functions that are one at a sample, zero at the others
    axial = 0.5 * (1.0 + 3.0 * p[:, 2:3] * line)
    weights = np.concatenate([nodal * axial[:, k : k + 1] for k in range(2)], axis=1)
    return samples, weights


_SAMPLES, _WEIGHTS = _samples()


def penta15_stiffness(xyz: Floats, C: Floats, integration: str = "reduced") -> Floats:
    """Stiffness of fifteen-node wedges, (n, 45, 45).

    Parameters
    ----------
    xyz : (n, 15, 3) float
        Node positions, basic frame.
    C : (n, 6, 6) float
        Elastic matrices, basic frame.
    integration : {"reduced", "full", "two"}
        7 x 3 points with the shears across the triangle sampled at 3 x 2 points, plain 7 x 3, or
        plain 3 x 2.
    """
    if integration == "full":
        return solid_stiffness(PENTA15, xyz, C)

    def matrices(part: slice) -> Floats:
        if integration == "two":
            _, derivatives = penta15(PENTA6.points)
            _, detJ, g = displacement_gradients(xyz[part], derivatives)
            return energy(strain_operator(g), C[part], detJ * PENTA6.weights)
        return _penta15(xyz[part], C[part])

    return in_chunks(len(xyz), 45, matrices, _CHUNK // 2)


def _penta15(xyz: Floats, C: Floats) -> Floats:
    _, T, C = _middle_basis(xyz[:, :6], C)
    _, derivatives = PENTA15.shape(PENTA15.points)
    _, detJ, g = displacement_gradients(xyz, derivatives)
    B = T[:, None] @ strain_operator(g)
    _, _, g = displacement_gradients(xyz, penta15(_SAMPLES)[1])
    sampled = T[:, None, 4:6] @ strain_operator(g)
    B[:, :, 4:6] = np.einsum("ps,nsrk->nprk", _WEIGHTS, sampled)
    return energy(B, C, detJ * PENTA15.weights)
