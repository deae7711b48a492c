"""Sections of bodies of revolution in the x-z plane: x is the radius, z the axis.

They move along x and z alike all round (no bending, no torsion). Stiffness and mass are those of
the whole ring. Strains stand in the order radial, circumferential, axial, shear.
"""

from collections.abc import Callable
from dataclasses import dataclass
from functools import partial

import numpy as np

from ...arrays import Bools, Floats
from ...data.shapes import QUAD, TRIA, Shape
from ..batch import in_chunks, transpose
from ..element import Element
from ..middle_nodes import lumped, serendipity
from ..quadrature import gauss_line, gauss_tria
from ..volumes.solid import area_coordinates
from .curved_shell import tria6_shape

_CORNERS = np.array([[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]])
_NO_AREA = 1e-9


@dataclass(frozen=True, eq=False)
class _Rule:
    interpolation: Callable[[Floats], tuple[Floats, Floats]]
    points: Floats
    weights: Floats


def _square(n: int) -> tuple[Floats, Floats]:
    x, w = gauss_line(n)
    return np.stack(np.meshgrid(x, x, indexing="ij"), axis=-1).reshape(-1, 2), np.outer(
        w, w
    ).ravel()


def _quad4(p: Floats) -> tuple[Floats, Floats]:
    f = 1.0 + _CORNERS * p[:, None]
    dN = np.stack([_CORNERS[:, 0] * f[..., 1], _CORNERS[:, 1] * f[..., 0]], axis=1)
    return 0.25 * f.prod(axis=2), 0.25 * dN


def _placed(rule: _Rule, xyz: Floats) -> tuple[Floats, Floats, Floats, Floats]:
    """Shape functions, gradients by x and z, radii and volumes at the points."""
    N, dN = rule.interpolation(rule.points)
    J = dN @ xyz[:, None][..., [0, 2]]
    radius = xyz[:, :, 0] @ N.T
    volume = 2.0 * np.pi * radius * np.abs(np.linalg.det(J)) * rule.weights
    return N, np.linalg.inv(J) @ dN, radius, volume


def _stiffness(rule: _Rule, xyz: Floats, C: Floats) -> Floats:
    """Stiffness of rings, (n, 3 k, 3 k), from elastic matrices (n, 4, 4)."""
    k = xyz.shape[1]

    def matrices(part: slice) -> Floats:
        N, g, radius, volume = _placed(rule, xyz[part])
        B = np.zeros((*radius.shape, 4, k, 3))
        B[..., 0, :, 0] = B[..., 3, :, 2] = g[..., 0, :]
        B[..., 1, :, 0] = N / radius[..., None]
        B[..., 2, :, 2] = B[..., 3, :, 0] = g[..., 1, :]
        B = B.reshape(*radius.shape, 4, 3 * k)
        CB = C[part, None] @ B * volume[..., None, None]
        return np.asarray((transpose(B) @ CB).sum(axis=1))

    return in_chunks(len(xyz), 3 * k, matrices)


def _mass(rule: _Rule, xyz: Floats, density: Floats, coupled: bool) -> Floats:
    """Mass of rings, (n, 3 k, 3 k), none about the axis."""
    N, _, _, volume = _placed(rule, xyz)
    m = transpose(N * (volume * density[:, None])[..., None]) @ N
    m = lumped(m, xyz, None, coupled)
    n, k = m.shape[:2]
    M = np.zeros((n, k, 3, k, 3))
    M[:, :, 0, :, 0] = M[:, :, 2, :, 2] = m
    return M.reshape(n, 3 * k, 3 * k)


def _sound(rule: _Rule, xyz: Floats) -> Bools:
    """Rings that have an area and are not folded, (n,)."""
    size = np.ptp(xyz, axis=1).max(axis=1)
    dN = rule.interpolation(rule.points)[1]
    area = np.linalg.det(dN @ xyz[:, None][..., [0, 2]])
    one_way = (area > _NO_AREA * size[:, None] ** 2).all(axis=1)
    other_way = (area < -_NO_AREA * size[:, None] ** 2).all(axis=1)
    return np.asarray(one_way | other_way)


def _element(name: str, shape: Shape, rule: _Rule, middle: bool) -> Element:
    return Element(
        name=name,
        shape=shape,
        freedoms=3,
        edges=np.array(shape.sides) if middle else np.zeros((0, 2), np.int64),
        stiffness=partial(_stiffness, rule),
        mass=partial(_mass, rule),
        sound=partial(_sound, rule),
        material=False,
        unknown="integration and lumped mass",
    )


TRIAX3 = _element("triax3", TRIA, _Rule(lambda p: area_coordinates(p), *gauss_tria(3)), False)
TRIAX6 = _element("triax6", TRIA, _Rule(tria6_shape, *gauss_tria(7)), True)
QUADX4 = _element("quadx4", QUAD, _Rule(_quad4, *_square(2)), False)
QUADX8 = _element(
    "quadx8", QUAD, _Rule(partial(serendipity, _CORNERS, np.array(QUAD.sides)), *_square(3)), True
)
