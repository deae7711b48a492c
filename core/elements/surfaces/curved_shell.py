"""Second-order curved shells as Nastran's CQUAD8 and CTRIA6."""

from collections.abc import Callable
from dataclasses import dataclass
from functools import partial

import numpy as np

from ...arrays import Floats, skew
from ...data.shapes import QUAD, TRIA
from ..batch import arms, congruent, symmetric, translations, transpose, unit
from ..element import Element
from ..middle_nodes import lumped, quadratic, serendipity
from ..quadrature import gauss_tria
from ..volumes.solid import area_coordinates
from .quad4 import quad4_sound
from .section import ShellSection, finite_shear, shell_stiffness
from .tria3 import tria3_sound

_G = 1.0 / np.sqrt(3.0)
_CORNERS = np.array([[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]])
# share of the direct strain that two points do not see, found in MSC Nastran's forces
_HOURGLASS = 0.25
_TRIA_RESIDUAL = 1.0 / 24.0
_CHUNK = 1024


def tria6_shape(p: Floats) -> tuple[Floats, Floats]:
    """Quadratic shape functions (m, 6) and derivatives (m, 2, 6) at points (m, 2)."""
    return quadratic(*area_coordinates(p), np.array(TRIA.sides))


@dataclass(frozen=True, eq=False)
class _Rule:
    shape: Callable[[Floats], tuple[Floats, Floats]]
    nodes: Floats
    centre: Floats
    points: Floats
    weights: Floats


_SIDES = np.array(QUAD.sides)
_QUAD = _Rule(
    partial(serendipity, _CORNERS, _SIDES),
    np.concatenate([_CORNERS, _CORNERS[_SIDES].mean(axis=1)]),
    np.zeros((1, 2)),
    _G * _CORNERS,
    np.ones(4),
)
_TRIANGLE = np.array([[0, 0], [1, 0], [0, 1], [0.5, 0], [0.5, 0.5], [0, 0.5]])
_TRIA = _Rule(tria6_shape, _TRIANGLE, np.full((1, 2), 1 / 3), *gauss_tria(3))


def _axes(rule: _Rule, xyz: Floats) -> Floats:
    """Element axes at the centre, (n, 3, 3): x along xi (of the triangle: edge 1-2), z normal."""
    return _frame(xyz, rule.shape(rule.centre)[1])[:, 0]


def _mass(
    rule: _Rule,
    points: Floats,
    weights: Floats,
    xyz: Floats,
    areal_density: Floats,
    coupled: bool,
    there: Floats | None = None,
) -> Floats:
    """Mass of second-order shells, (n, 6 k, 6 k), translations only; see `middle_nodes.lumped`."""
    N, dN = rule.shape(points)
    J = dN @ xyz[:, None]
    area = np.linalg.norm(np.cross(J[:, :, 0], J[:, :, 1]), axis=2)
    weight = area * weights * areal_density[:, None]
    m = transpose(N * weight[..., None]) @ N
    return translations(lumped(m, xyz, there, coupled), 6)


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
    """Stiffness of eight-node curved shells.

    2 x 2 points; what they do not see of the direct strains is held by a quarter of its
    stiffness, which with the rest is MSC Nastran's membrane exactly. Its law of transverse shear
    is not identified: with the plain one here the energies of a thick square are 1 to 15 % above
    MSC's, and thin plates and cylinders converge fast.
    """
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
    to_plane = np.linalg.inv(k.J @ transpose(k.frame)[..., :2])
    return np.asarray(np.einsum("npab,npbkd->npakd", to_plane, np.stack(natural, axis=2)))


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
    """Stiffness of six-node curved shells.

    Three points; the membrane is MSC Nastran's, transverse shear at the points with a residual
    bending flexibility A / (12 D) is an approximation (energies of a thick triangle 6 % below to
    28 % above MSC's).
    """
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


def _offset(
    rule: _Rule,
    stiffness: Callable[[Floats, ShellSection], Floats],
    xyz: Floats,
    section: ShellSection,
    _k6rot: float,
    offset: Floats,
    _normals: Floats | None,
) -> Floats:
    """Stiffness of the shifted surface, carried to the nodes by rigid arms.

    The offsets stand on the normals of the surface at the nodes, about which there is no
    stiffness; normals averaged over elements are not for curved shells.
    """
    if not offset.any():
        return stiffness(xyz, section)
    arm = offset[:, None, None] * _frame(xyz, rule.shape(rule.nodes)[1])[:, :, 2]
    basic = np.broadcast_to(np.eye(3), (len(xyz), 3, 3))
    return congruent(stiffness(xyz + arm, section), arms(basic, arm))


_X, _W = np.polynomial.legendre.leggauss(3)
_NINE = np.stack(np.meshgrid(_X, _X, indexing="ij"), axis=-1).reshape(-1, 2)

QUAD8 = Element(
    name="quad8",
    unknown="transverse shear",
    shape=QUAD,
    freedoms=6,
    edges=_SIDES,
    stiffness=shell_stiffness(partial(_offset, _QUAD, _quad8), _CHUNK),
    mass=partial(_mass, _QUAD, _NINE, np.outer(_W, _W).ravel()),
    axes=partial(_axes, _QUAD),
    sound=quad4_sound,
)
TRIA6 = Element(
    name="tria6",
    unknown="transverse shear",
    shape=TRIA,
    freedoms=6,
    edges=np.array(TRIA.sides),
    stiffness=shell_stiffness(partial(_offset, _TRIA, _tria6), _CHUNK),
    mass=partial(_mass, _TRIA, *gauss_tria(7)),
    axes=partial(_axes, _TRIA),
    sound=tria3_sound,
)
