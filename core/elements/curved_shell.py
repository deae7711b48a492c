"""Second-order curved shells as Nastran's CQUAD8 and CTRIA6."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from ..arrays import Floats, Ints
from .batch import arms, congruent, in_chunks, skew, symmetric, transpose, unit
from .lumping import to_middle_nodes
from .section import ShellSection
from .solid_shapes import gauss_tria
from .transverse_shear import finite_shear

_G = 1.0 / np.sqrt(3.0)
_CORNERS = np.array([[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]])
_MIDDLES = np.array([[0.0, -1.0], [1.0, 0.0], [0.0, 1.0], [-1.0, 0.0]])
# share of the direct strain that two points do not see, found in MSC Nastran's forces
_HOURGLASS = 0.25
_TRIA_RESIDUAL = 1.0 / 24.0
_CHUNK = 1024

Shape = Callable[[Floats], tuple[Floats, Floats]]


def quad8_shape(p: Floats) -> tuple[Floats, Floats]:
    """Serendipity shape functions (m, 8) and derivatives (m, 2, 8) at points (m, 2)."""
    N, dN = np.empty((len(p), 8)), np.empty((len(p), 2, 8))
    a, b = _CORNERS.T
    x, y = p[:, 0:1], p[:, 1:2]
    u, v = 1.0 + a * x, 1.0 + b * y
    N[:, :4] = u * v * (a * x + b * y - 1.0) / 4.0
    dN[:, 0, :4] = a * v * (2.0 * a * x + b * y) / 4.0
    dN[:, 1, :4] = b * u * (2.0 * b * y + a * x) / 4.0
    for k, (a, b) in enumerate(_MIDDLES):
        if a == 0.0:
            N[:, 4 + k] = 0.5 * ((1.0 - x**2) * (1.0 + b * y))[:, 0]
            dN[:, 0, 4 + k], dN[:, 1, 4 + k] = (-x * (1 + b * y))[:, 0], (b * (1 - x**2) / 2)[:, 0]
        else:
            N[:, 4 + k] = 0.5 * ((1.0 - y**2) * (1.0 + a * x))[:, 0]
            dN[:, 0, 4 + k], dN[:, 1, 4 + k] = (a * (1 - y**2) / 2)[:, 0], (-y * (1 + a * x))[:, 0]
    return N, dN


def tria6_shape(p: Floats) -> tuple[Floats, Floats]:
    """Quadratic shape functions (m, 6) and derivatives (m, 2, 6) at points (m, 2)."""
    L = np.column_stack([1.0 - p.sum(axis=1), p])
    d = np.array([[-1.0, 1.0, 0.0], [-1.0, 0.0, 1.0]])
    i, j = np.array([0, 1, 2]), np.array([1, 2, 0])
    N = np.concatenate([L * (2.0 * L - 1.0), 4.0 * L[:, i] * L[:, j]], axis=1)
    middle = 4.0 * (d[:, i] * L[:, None, j] + d[:, j] * L[:, None, i])
    return N, np.concatenate([d * (4.0 * L - 1.0)[:, None], middle], axis=2)


@dataclass(frozen=True, eq=False)
class _Rule:
    shape: Shape
    nodes: Floats
    centre: Floats
    points: Floats
    weights: Floats


_QUAD = _Rule(
    quad8_shape,
    np.concatenate([_CORNERS, _MIDDLES]),
    np.zeros((1, 2)),
    _G * _CORNERS,
    np.ones(4),
)
_TRIANGLE = np.array([[0, 0], [1, 0], [0, 1], [0.5, 0], [0.5, 0.5], [0, 0.5]])
_TRIA = _Rule(tria6_shape, _TRIANGLE, np.full((1, 2), 1 / 3), *gauss_tria(3))

QUAD8_EDGES: Ints = np.array([[0, 1], [1, 2], [2, 3], [3, 0]])
TRIA6_EDGES: Ints = np.array([[0, 1], [1, 2], [2, 0]])


def quad8_axes(xyz: Floats) -> Floats:
    """Element axes at the centre, (n, 3, 3): x along xi, z normal."""
    return _frame(xyz, _QUAD.shape(_QUAD.centre)[1])[:, 0]


def tria6_axes(xyz: Floats) -> Floats:
    """Element axes at the centre, (n, 3, 3): x along the edge 1-2, z normal."""
    return _frame(xyz, _TRIA.shape(_TRIA.centre)[1])[:, 0]


def quad8_stiffness(xyz: Floats, section: ShellSection, offset: Floats | float = 0.0) -> Floats:
    """Stiffness of eight-node curved shells, (n, 48, 48).

    2 x 2 points; what they do not see of the direct strains is held by a quarter of its
    stiffness, which with the rest is MSC Nastran's membrane exactly. Its law of transverse shear
    is not identified: with the plain one here the energies of a thick square are 1 to 15 % above
    MSC's, and thin plates and cylinders converge fast. There is no stiffness about the normals of
    the surface at the nodes.

    Parameters
    ----------
    xyz : (n, 8, 3) float
        Corners, then middle nodes, basic frame; see `fill_middle_nodes` for missing ones.
    section : ShellSection
        In the axes at each point: x along xi, z normal.
    offset : (n,) float
        From the nodes to the middle surface, along the normals of the surface at the nodes.
    """
    return _offset_stiffness(_QUAD, _quad8, xyz, section, offset)


def tria6_stiffness(xyz: Floats, section: ShellSection, offset: Floats | float = 0.0) -> Floats:
    """Stiffness of six-node curved shells, (n, 36, 36).

    Three points; the membrane is MSC Nastran's, transverse shear at the points with a residual
    bending flexibility A / (12 D) is an approximation (energies of a thick triangle 6 % below to
    28 % above MSC's). There is no stiffness about the normals of the surface at the nodes.

    Parameters as for `quad8_stiffness`, `xyz` (n, 6, 3).
    """
    return _offset_stiffness(_TRIA, _tria6, xyz, section, offset)


def _offset_stiffness(
    rule: _Rule,
    stiffness: Callable[[Floats, ShellSection], Floats],
    xyz: Floats,
    section: ShellSection,
    offset: Floats | float,
) -> Floats:
    """Stiffness of the shifted surface, carried to the nodes by rigid arms."""
    n, nodes = xyz.shape[:2]
    offset = np.broadcast_to(np.asarray(offset, float), (n,))

    def matrices(part: slice) -> Floats:
        at, z = xyz[part], offset[part]
        if not z.any():
            return stiffness(at, section.take(part))
        arm = z[:, None, None] * _frame(at, rule.shape(rule.nodes)[1])[:, :, 2]
        basic = np.broadcast_to(np.eye(3), (len(at), 3, 3))
        return congruent(stiffness(at + arm, section.take(part)), arms(basic, arm))

    return in_chunks(n, 6 * nodes, matrices, _CHUNK)


def quad8_mass(xyz: Floats, areal_density: Floats, coupled: bool) -> Floats:
    """Mass of eight-node shells, (n, 48, 48), translations only; see `tria6_mass`."""
    x, w = np.polynomial.legendre.leggauss(3)
    points = np.stack(np.meshgrid(x, x, indexing="ij"), axis=-1).reshape(-1, 2)
    return _mass(quad8_shape, points, np.outer(w, w).ravel(), 4, xyz, areal_density, coupled)


def tria6_mass(xyz: Floats, areal_density: Floats, coupled: bool) -> Floats:
    """Mass of six-node shells, (n, 36, 36), translations only.

    Parameters
    ----------
    xyz : (n, 6, 3) float
        Corners, then middle nodes.
    areal_density : (n,) float
        Mass per area.
    coupled : bool
        Consistent mass; otherwise all of it at the middle nodes, as MSC does (see
        `lumping.to_middle_nodes`).
    """
    return _mass(tria6_shape, *gauss_tria(7), 3, xyz, areal_density, coupled)


def _mass(
    shape: Shape,
    points: Floats,
    weights: Floats,
    corners: int,
    xyz: Floats,
    areal_density: Floats,
    coupled: bool,
) -> Floats:
    N, dN = shape(points)
    J = dN @ xyz[:, None]
    area = np.linalg.norm(np.cross(J[:, :, 0], J[:, :, 1]), axis=2)
    weight = area * weights * areal_density[:, None]
    if coupled:
        m = transpose(N * weight[..., None]) @ N
    else:
        share = to_middle_nodes(weight @ N, xyz, corners)
        m = share[:, :, None] * np.eye(N.shape[1])
    M = np.zeros((len(xyz), N.shape[1], 6, N.shape[1], 6))
    for k in range(3):
        M[:, :, k, :, k] = m
    return M.reshape(len(xyz), 6 * N.shape[1], -1)


def _frame(xyz: Floats, dN: Floats) -> Floats:
    J = dN @ xyz[:, None]
    z = unit(np.cross(J[:, :, 0], J[:, :, 1]))
    x = unit(J[:, :, 0])
    return np.stack([x, np.cross(z, x), z], axis=2)


@dataclass(frozen=True, eq=False)
class _Kinematics:
    """What the strains at some points need: surface gradients and the directors of the nodes."""

    frame: Floats
    area: Floats
    J: Floats
    gradient: Floats
    tilt: Floats
    directors: Floats


def _at(rule: _Rule, xyz: Floats, points: Floats) -> tuple[Floats, _Kinematics]:
    """Shape functions and kinematics; `tilt` gives the change of the directors, theta x n."""
    N, dN = rule.shape(points)
    directors = _frame(xyz, rule.shape(rule.nodes)[1])[:, :, 2]
    frame = _frame(xyz, dN)
    J = dN @ xyz[:, None]
    plane = J @ transpose(frame)[..., :2]
    return N, _Kinematics(
        frame, np.linalg.det(plane), J, np.linalg.inv(plane) @ dN, -skew(directors), directors
    )


def _strains(rule: _Rule, xyz: Floats, points: Floats) -> tuple[Floats, Floats, Floats]:
    """Membrane strains and curvatures, each (n, m, 3, k, 6), and the areas (n, m)."""
    N, k = _at(rule, xyz, points)
    n, m, nodes = len(xyz), len(points), N.shape[1]
    e, c = np.zeros((n, m, 3, nodes, 6)), np.zeros((n, m, 3, nodes, 6))
    g, x, y = k.gradient, k.frame[:, :, 0], k.frame[:, :, 1]
    tx = np.einsum("npa,nkab->npkb", x, k.tilt)
    ty = np.einsum("npa,nkab->npkb", y, k.tilt)
    bend = g @ k.directors[:, None]  # how the directors turn along x and y
    pairs = (((0, 0),), ((1, 1),), ((1, 0), (0, 1)))  # derivative along, component
    for row, terms in enumerate(pairs):
        for d, a in terms:
            axis, turn = ((x, tx), (y, ty))[a]
            e[:, :, row, :, :3] += g[:, :, d, :, None] * axis[:, :, None]
            c[:, :, row, :, 3:] += g[:, :, d, :, None] * turn
            c[:, :, row, :, :3] += g[:, :, d, :, None] * bend[:, :, a, None]
    return e, c, k.area


def _covariant_shear(rule: _Rule, xyz: Floats, points: Floats, direction: int) -> Floats:
    """Shear between a natural direction and the normal at points, (n, m, k, 6)."""
    N, k = _at(rule, xyz, points)
    _, dN = rule.shape(points)
    n, m, nodes = len(xyz), len(points), N.shape[1]
    out = np.zeros((n, m, nodes, 6))
    out[..., :3] = dN[:, direction, :, None] * (N @ k.directors)[:, :, None]
    tangent = k.J[:, :, direction]
    out[..., 3:] = N[:, :, None] * np.einsum("npa,nkab->npkb", tangent, k.tilt)
    return out


def _natural_to_plane(k: _Kinematics) -> Floats:
    """Physical shears from covariant ones, (n, m, 2, 2)."""
    return np.asarray(np.linalg.inv(k.J @ transpose(k.frame)[..., :2]))


def _integral(B: Floats, C: Floats, D: Floats, weight: Floats) -> Floats:
    n, rows = len(B), B.shape[1] * B.shape[2]
    CD = (C[:, None] @ D.reshape(*D.shape[:3], -1)) * weight[..., None, None]
    return np.asarray(transpose(B.reshape(n, rows, -1)) @ CD.reshape(n, rows, -1))


def _plane_energy(section: ShellSection, e: Floats, c: Floats, weight: Floats) -> Floats:
    K = _integral(e, section.A, e, weight) + _integral(c, section.D, c, weight)
    if section.B.any():
        Kc = _integral(e, section.B, c, weight)
        K = K + Kc + transpose(Kc)
    return K


def _quad8(xyz: Floats, section: ShellSection) -> Floats:
    e, c, area = _strains(_QUAD, xyz, _QUAD.points)
    K = _plane_energy(section, e, c, area)
    K += _hourglass(section, xyz, area.sum(axis=1))
    shear = _shear(_QUAD, xyz)
    S = _bending_only(section, finite_shear(section, np.sqrt(area.sum(axis=1))))
    return symmetric(K + _integral(shear, S, shear, area))


def _shear(rule: _Rule, xyz: Floats) -> Floats:
    """Transverse shear strains at the points of a rule, (n, m, 2, k, 6)."""
    _, k = _at(rule, xyz, rule.points)
    natural = [_covariant_shear(rule, xyz, rule.points, d) for d in (0, 1)]
    return np.asarray(
        np.einsum("npab,npbkd->npakd", _natural_to_plane(k), np.stack(natural, axis=2))
    )


def _hourglass(section: ShellSection, xyz: Floats, area: Floats) -> Floats:
    """Direct strains that vary as eta**2 along xi and as xi**2 along eta."""
    h = np.sqrt(0.6)
    total = np.zeros((len(xyz), 48, 48))
    for row, line in ((0, [[0, h], [0, 0], [0, -h]]), (1, [[h, 0], [0, 0], [-h, 0]])):
        e, c, _ = _strains(_QUAD, xyz, np.array(line))
        curved = np.array([1.0, -2.0, 1.0]) / (2.0 * h**2)
        for strain, C in ((e, section.A), (c, section.D)):
            b = np.einsum("p,npkd->nkd", curved, strain[:, :, row]).reshape(len(xyz), 48)
            k = _HOURGLASS * 4.0 / 45.0 * area * C[:, row, row]
            total += k[:, None, None] * b[:, :, None] * b[:, None, :]
    return total


def _tria6(xyz: Floats, section: ShellSection) -> Floats:
    e, c, area = _strains(_TRIA, xyz, _TRIA.points)
    weight = area * _TRIA.weights
    K = _plane_energy(section, e, c, weight)
    shear = _shear(_TRIA, xyz)
    total = weight.sum(axis=1)
    S = _bending_only(section, finite_shear(section, np.sqrt(total)))
    bends = S.any(axis=(1, 2))
    D = np.where(bends, 0.5 * (section.D[:, 0, 0] + section.D[:, 1, 1]), 1.0)
    S = np.where(bends[:, None, None], S, np.eye(2))
    residual = (2.0 * _TRIA_RESIDUAL * total / D)[:, None, None] * np.eye(2)
    S = np.linalg.inv(np.linalg.inv(S) + residual) * bends[:, None, None]
    return symmetric(K + _integral(shear, S, shear, weight))


def _bending_only(section: ShellSection, S: Floats) -> Floats:
    """No transverse shear where there is no bending."""
    return np.where((section.D[:, 0, 0] > 0.0)[:, None, None], S, 0.0)
