"""Wedges as Nastran's CPENTA, six and fifteen nodes."""

import numpy as np

from ...arrays import Floats
from ...data.shapes import PENTA, TRIA
from ..batch import transpose, unit
from ..quadrature import gauss_line, gauss_tria, gauss_wedge
from .solid import Solid, area_coordinates, energy, in_basis, stacked_edges, strains, with_bubbles

_SIX, _TWENTY_ONE = gauss_wedge(3, 2), gauss_wedge(7, 3)


def penta6(p: Floats) -> tuple[Floats, Floats]:
    """Shape functions of the wedge: area coordinates times linear along the axis."""
    L, dL = area_coordinates(p)
    z = p[:, 2:3]
    low, high = 0.5 * (1.0 - z), 0.5 * (1.0 + z)
    N = np.concatenate([L * low, L * high], axis=1)
    dN = np.empty((len(p), 3, 6))
    dN[:, :2] = np.concatenate([dL * low[:, None], dL * high[:, None]], axis=2)
    dN[:, 2] = np.concatenate([-0.5 * L, 0.5 * L], axis=1)
    return N, dN


def penta15(p: Floats) -> tuple[Floats, Floats]:
    """Serendipity shape functions of the 15-node wedge."""
    L, dL = area_coordinates(p)
    z = p[:, 2:3]
    N, dN = np.empty((len(p), 15)), np.zeros((len(p), 3, 15))
    edges = np.array(TRIA.sides)
    La, Lb = L[:, edges[:, 0]], L[:, edges[:, 1]]
    dab = dL[:, :, edges[:, 0]] * Lb[:, None] + dL[:, :, edges[:, 1]] * La[:, None]
    for corner, edge, sign in ((slice(0, 3), slice(6, 9), -1.0), (slice(3, 6), slice(12, 15), 1.0)):
        f = 1.0 + sign * z
        N[:, corner] = 0.5 * L * ((2.0 * L - 1.0) * f - (1.0 - z**2))
        dN[:, :2, corner] = 0.5 * dL * ((4.0 * L - 1.0) * f - (1.0 - z**2))[:, None]
        dN[:, 2, corner] = 0.5 * L * ((2.0 * L - 1.0) * sign + 2.0 * z)
        N[:, edge] = 2.0 * La * Lb * f
        dN[:, :2, edge] = 2.0 * dab * f[:, None]
        dN[:, 2, edge] = 2.0 * La * Lb * sign
    N[:, 9:12] = L * (1.0 - z**2)
    dN[:, :2, 9:12] = dL * (1.0 - z**2)[:, None]
    dN[:, 2, 9:12] = -2.0 * L * z
    return N, dN


_AT_CENTRE = penta6(np.array([[1.0 / 3.0, 1.0 / 3.0, 0.0]]))[1][0]
# middles of the three faces, edges 1-2, 2-3, 3-1
_FACES = np.array([[0.5, 0.0, 0.0], [0.5, 0.5, 0.0], [0.0, 0.5, 0.0]])


def _penta6(xyz: Floats, C: Floats, integration: str) -> Floats:
    """Stiffness of six-node wedges, with bubbles and reduced shear or with the latter only.

    3 x 2 points with reduced shear and bubble functions are Nastran's default. Shear across the
    triangle is fixed by the strains g along the middles of its three edges: g = t . gamma + q, and
    gamma + q t_k at the k-th point, t being the edge directions; internal modes are quadratic
    along the axis, and L1 L2 + L2 L3 + L3 L1 in the plane. This law was identified from NX and
    MSC Nastran, whose matrices of right isosceles wedges it reproduces to rounding.
    """
    n = len(xyz)
    basis, T, C = _middle_basis(xyz, C)
    B, detJ = strains(xyz, penta6, _SIX[0])
    B = T[:, None] @ B
    corner = 0.5 * (xyz[:, :3] + xyz[:, 3:]) @ transpose(basis)[:, :, :2]
    t = unit(np.stack([corner[:, j] - corner[:, i] for i, j in TRIA.sides], axis=1))
    at_faces = T[:, None] @ strains(xyz, penta6, _FACES)[0]
    shear = at_faces[:, :, [5, 4]]  # zx, yz
    edge = np.einsum("nkd,nkdj->nkj", t, shear)
    field = np.linalg.solve(np.concatenate([t, np.ones((n, 3, 1))], axis=2), edge)
    for point in range(6):
        k = point % 3
        B[:, point, 5] = field[:, 0] + t[:, k, 0, None] * field[:, 2]
        B[:, point, 4] = field[:, 1] + t[:, k, 1, None] * field[:, 2]

    weight = detJ * _SIX[1]
    if integration == "reduced":
        return energy(B, C, weight)
    ratio = np.linalg.det(_AT_CENTRE @ xyz)[:, None] / detJ
    return with_bubbles(B, _bubbles(corner) * ratio[..., None, None], C, weight)


def _middle_basis(xyz: Floats, C: Floats) -> tuple[Floats, Floats, Floats]:
    """Basis of the middle triangle (x along edge 1-2, y in its plane) and of the axis."""
    J = _AT_CENTRE @ xyz
    x = unit(J[:, 0])
    normal = unit(np.cross(J[:, 0], J[:, 1]))
    basis = np.stack([x, np.cross(normal, x), unit(J[:, 2])], axis=1)
    return basis, *in_basis(C, basis)


def _bubbles(corner: Floats) -> Floats:
    """Strains of the internal modes at the points, (n, 6, 6, 3), from the middle triangle."""
    modes = np.zeros((len(corner), 6, 6, 3))
    p = _SIX[0]
    L = area_coordinates(p)[0]
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
    p = _TWENTY_ONE[0]
    nodal = (
        2.0 * area_coordinates(p)[0] - 1.0 / 3.0
    )  # linear functions that are one at a sample, zero at the others
    axial = 0.5 * (1.0 + 3.0 * p[:, 2:3] * line)
    weights = np.concatenate([nodal * axial[:, k : k + 1] for k in range(2)], axis=1)
    return samples, weights


_SAMPLES, _WEIGHTS = _samples()


def _penta15(xyz: Floats, C: Floats, _integration: str) -> Floats:
    """Stiffness of fifteen-node wedges, shears across the triangle sampled at 3 x 2 points."""
    _, T, C = _middle_basis(xyz[:, :6], C)
    B, detJ = strains(xyz, penta15, _TWENTY_ONE[0])
    B = T[:, None] @ B
    sampled = T[:, None, 4:6] @ strains(xyz, penta15, _SAMPLES)[0]
    B[:, :, 4:6] = np.einsum("ps,nsrk->nprk", _WEIGHTS, sampled)
    return energy(B, C, detJ * _TWENTY_ONE[1])


PENTA6 = Solid(
    name="penta6",
    shape=PENTA,
    interpolation=penta6,
    rules={"full": _SIX},
    mass_rule=gauss_wedge(7, 2),
    kernel=_penta6,
    integrations=("bubble", "reduced", "full"),
)
PENTA15 = Solid(
    name="penta15",
    unknown="reduced shear",
    shape=PENTA,
    edges=stacked_edges(3),
    interpolation=penta15,
    rules={"full": _TWENTY_ONE, "two": _SIX},
    mass_rule=_TWENTY_ONE,
    kernel=_penta15,
    integrations=("reduced", "full", "two"),
)
