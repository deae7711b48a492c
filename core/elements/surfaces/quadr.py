"""Shells with rotation about the normal as Nastran's CQUADR and CTRIAR."""

from dataclasses import replace

import numpy as np

from ...arrays import Floats
from ...data.shapes import QUAD, TRIA
from ..batch import condense, congruent, transpose
from .quad4 import (
    AT_CENTRE,
    AT_GAUSS,
    BUBBLES,
    ETA,
    QUAD4,
    XI,
    add_shear,
    corner_motions,
    flat,
    quad4_axes,
)
from .section import ShellSection, finite_shear, shell_stiffness, strip_stiffness
from .tria3 import TRIA3, add_edge_shears, triangle

# found in MSC Nastran's grid point forces of a square and of a right isosceles triangle
_UNIFORM = 0.75  # residual bending flexibility of the quad, relative to the CQUAD4's
_LINEAR_SPIN = 0.225  # stiffness against linear differences of rotation, relative to G
_ALTERNATING_SPIN = 1e-3  # and against rotations of alternating sign
_TRIA_SPIN = 0.1  # the triangle's stiffness against the mean difference of rotation
_TRIA_BENDING = 0.75  # its in-plane bending by the rotations, relative to Allman's

_NODE4, _NODE3 = 6 * np.arange(4), 6 * np.arange(3)
_KEPT = np.array([0, 1, 2, 3, 6, 7, 8, 9, 12, 13, 14, 15])
_INNER = np.array([4, 5, 10, 11])
_TRIA_POINTS = np.array([[4.0, 1.0, 1.0], [1.0, 4.0, 1.0], [1.0, 1.0, 4.0]]) / 6.0


def _mean_strain(local: Floats, edges: tuple[tuple[int, int], ...], area: Floats) -> Floats:
    """Mean strains from rotations by edges bent to parabolas (Allman 1984), (n, 3, m)."""
    B = np.zeros((len(local), 3, local.shape[1]))
    for i, j in edges:
        d = local[:, j] - local[:, i]
        x, y = d[:, 1], -d[:, 0]
        strain = np.stack([x * x, y * y, 2.0 * x * y], axis=1) / (12.0 * area)[:, None]
        B[:, :, j] += strain
        B[:, :, i] -= strain
    return B


def _quadr(
    xyz: Floats, section: ShellSection, _k6rot: float, offset: Floats, normals: Floats | None
) -> Floats:
    """Stiffness of four-node shells with rotation about the normal.

    The membrane is the CQUAD4's with Allman's (1984) mean strains from the rotations; the
    rotations are held to that of the plane by G times their mean difference squared (Hughes,
    Brezzi 1989) and a part of their linear difference. Bending has MacNeal's (1978) twist.
    Identified from MSC Nastran's grid point forces of a square.
    """
    axes = quad4_axes(xyz)
    local, height = flat(xyz, axes)
    J = AT_GAUSS @ local[:, None]
    detJ, inverse = np.linalg.det(J), np.linalg.inv(J)
    K = np.zeros((len(xyz), 24, 24))
    _add_quad_plane(K, section, local, detJ, inverse)
    add_shear(K, section, local, detJ, _UNIFORM, 0.0)
    _add_quad_spin(K, section.drilling, local, detJ.sum(axis=1))
    return congruent(K, corner_motions(axes, local, height, offset, normals))


def _add_quad_plane(
    K: Floats, section: ShellSection, local: Floats, detJ: Floats, inverse: Floats
) -> None:
    n = len(K)
    g = inverse @ AT_GAUSS
    centre = AT_CENTRE @ local
    ratio = (np.linalg.det(centre)[:, None] / detJ)[..., None, None]
    inner = (np.linalg.inv(centre)[:, None] @ BUBBLES) * ratio
    m = np.zeros((n, 4, 3, 16))
    for first, gradient in ((0, g), (4, inner)):
        k = slice(first, first + gradient.shape[-1])
        shifted = slice(first + 6, first + 6 + gradient.shape[-1])
        m[:, :, 0, k] = m[:, :, 2, shifted] = gradient[:, :, 0]
        m[:, :, 1, shifted] = m[:, :, 2, k] = gradient[:, :, 1]
    m[..., 12:] = _mean_strain(local, QUAD.sides, detJ.sum(axis=1))[:, None]
    b = np.zeros((n, 4, 3, 8))
    gc = (np.linalg.inv(centre) @ AT_CENTRE)[:, None]
    twist = 2.0 * g - gc
    b[:, :, 0, :4], b[:, :, 1, 4:] = g[:, :, 0], -g[:, :, 1]
    b[:, :, 2, :4], b[:, :, 2, 4:] = twist[:, :, 1], -twist[:, :, 0]

    def integral(left: Floats, C: Floats, right: Floats) -> Floats:
        weighted = (left * detJ[..., None, None]).reshape(n, 12, -1)
        return transpose(weighted) @ (C[:, None] @ right).reshape(n, 12, -1)

    Km, Kb = integral(m, section.A, m), integral(b, section.D, b)
    Kc = integral(m, section.B, b)
    both = condense(
        np.block([[Km, Kc], [transpose(Kc), Kb]]),
        np.concatenate([_KEPT, np.arange(16, 24)]),
        _INNER,
    )
    rows = np.concatenate([_NODE4 + d for d in (0, 1, 5, 4, 3)])
    K[:, rows[:, None], rows] += both


def _add_quad_spin(K: Floats, stiffness: Floats, local: Floats, area: Floats) -> None:
    """Differences between the rotations of the grids and that of the plane."""
    n = len(K)
    g = np.linalg.inv(AT_CENTRE @ local) @ AT_CENTRE
    mean = np.zeros((n, 12))
    mean[:, :4], mean[:, 4:8], mean[:, 8:] = 0.5 * g[:, 1], -0.5 * g[:, 0], 0.25
    # rotation that the bilinear part of the displacement stands for, linear in xi and eta
    a = AT_CENTRE @ local
    p, q = a[:, 0], a[:, 1]
    mixed = p[:, 0] * q[:, 1] + q[:, 0] * p[:, 1]
    M = np.empty((n, 2, 2))
    M[:, 0, 0], M[:, 0, 1] = -mixed, -p[:, 1] * q[:, 1]
    M[:, 1, 0], M[:, 1, 1] = p[:, 0] * q[:, 0], mixed
    slope = a @ np.linalg.inv(M)  # along xi and eta, from the two components
    pattern = XI * ETA
    # without what linear displacements put into it (Flanagan, Belytschko 1981)
    hourglass = 0.25 * (pattern - np.einsum("i,nid,ndj->nj", pattern, local, g))[:, None]
    linear = np.zeros((n, 2, 12))
    linear[:, :, :4] = -slope[:, :, :1] * hourglass
    linear[:, :, 4:8] = -slope[:, :, 1:] * hourglass
    linear[:, 0, 8:], linear[:, 1, 8:] = 0.25 * XI, 0.25 * ETA
    weight = (stiffness * area)[:, None, None]
    spin = mean[:, :, None] * mean[:, None, :]
    spin = spin + _LINEAR_SPIN / 3.0 * transpose(linear) @ linear
    alternating = np.concatenate([np.zeros(8), 0.25 * pattern])
    spin = spin + _ALTERNATING_SPIN * np.outer(alternating, alternating)
    rows = np.concatenate([_NODE4, _NODE4 + 1, _NODE4 + 5])
    K[:, rows[:, None], rows] += weight * spin


def _triar(
    xyz: Floats, section: ShellSection, _k6rot: float, offset: Floats, normals: Floats | None
) -> Floats:
    """Stiffness of three-node shells with rotation about the normal.

    Mean membrane strains as in `_quadr`, exactly as in MSC Nastran; the small stiffness against
    unequal rotations is an approximation to its (16 % off on a right isosceles triangle).
    """
    t = triangle(xyz)
    K = np.zeros((len(xyz), 18, 18))
    _add_tria_plane(K, section, t.local, t.g, t.area)
    _add_tria_shear(K, section, t.edge, t.area)
    return congruent(K, t.corner_motions(offset, normals))


def _add_tria_plane(
    K: Floats, section: ShellSection, local: Floats, g: Floats, area: Floats
) -> None:
    n = len(K)
    m = np.zeros((n, 3, 9))
    m[:, 0, :3] = m[:, 2, 3:6] = g[:, 0]
    m[:, 1, 3:6] = m[:, 2, :3] = g[:, 1]
    m[:, :, 6:] = _mean_strain(local, TRIA.sides, area)
    b = np.zeros((n, 3, 6))
    b[:, 0, :3], b[:, 1, 3:] = g[:, 0], -g[:, 1]
    b[:, 2, :3], b[:, 2, 3:] = g[:, 1], -g[:, 0]
    scale = area[:, None, None]
    Km = transpose(m) @ section.A @ m * scale
    Kb = transpose(b) @ section.D @ b * scale
    Kc = transpose(m) @ section.B @ b * scale

    mean = np.zeros((n, 9))
    mean[:, :3], mean[:, 3:6], mean[:, 6:] = 0.5 * g[:, 1], -0.5 * g[:, 0], 1.0 / 3.0
    weight = (_TRIA_SPIN * section.drilling * area)[:, None, None]
    Km += weight * mean[:, :, None] * mean[:, None, :]
    Km[:, 6:, 6:] += _bending_by_rotations(section.A, local, g, m[:, :, 6:], area)

    rows = np.concatenate([_NODE3, _NODE3 + 1, _NODE3 + 5])
    cols = np.concatenate([_NODE3 + 4, _NODE3 + 3])
    K[:, rows[:, None], rows] += Km
    K[:, cols[:, None], cols] += Kb
    K[:, rows[:, None], cols] += Kc
    K[:, cols[:, None], rows] += transpose(Kc)


def _bending_by_rotations(
    A: Floats, local: Floats, g: Floats, mean: Floats, area: Floats
) -> Floats:
    """Energy of the direct strains of Allman's edges about their mean, Poisson relieved."""
    compliance = np.linalg.inv(np.where(A.any(axis=(1, 2))[:, None, None], A, np.eye(3)))
    E = np.stack([1.0 / compliance[:, 0, 0], 1.0 / compliance[:, 1, 1]], axis=1)
    E[~A.any(axis=(1, 2))] = 0.0
    total = np.zeros((len(A), 3, 3))
    for L in _TRIA_POINTS:
        B = np.zeros((len(A), 2, 3))
        for i, j in TRIA.sides:
            d = local[:, j] - local[:, i]
            normal = np.stack([d[:, 1], -d[:, 0]], axis=1)
            strain = 0.5 * normal * (g[:, :, i] * L[j] + g[:, :, j] * L[i])
            B[:, :, j] += strain
            B[:, :, i] -= strain
        B -= mean[:, :2]
        total += transpose(B * E[:, :, None]) @ B
    return np.asarray(_TRIA_BENDING * (area / 3.0)[:, None, None] * total)


def _add_tria_shear(K: Floats, section: ShellSection, edge: Floats, area: Floats) -> None:
    """As the CTRIA3's, with residual flexibilities A / 12 D and, uniform, A / 2 D."""
    D1, D2 = strip_stiffness(section.D, edge[:, 0])
    bends = (D1 > 0.0) & (D2 > 0.0)
    flexibility = np.where(bends, 1.0 / np.sqrt(np.where(bends, D1 * D2, 1.0)), 0.0)
    S = np.where(bends[:, None, None], finite_shear(section, np.sqrt(area)), np.eye(2))
    Zs = np.linalg.inv(S)
    Z = Zs + (area * flexibility / 12.0)[:, None, None] * np.eye(2)
    uniform = 0.5 * np.einsum("nii->n", Zs) + 0.5 * area * flexibility
    add_edge_shears(K, edge, area * bends, Z, uniform)


QUADR = replace(QUAD4, name="quadr", stiffness=shell_stiffness(_quadr))
TRIAR = replace(
    TRIA3,
    name="triar",
    stiffness=shell_stiffness(_triar),
    unknown="unequal rotations about the normal",
)
