"""Connectors between surface patches, as CWELD and CFAST."""

from typing import NamedTuple

import numpy as np

from ...arrays import Floats
from ..batch import congruent
from ..element import Element

_CORNERS = np.array([[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]])
_ROUNDS = 30
_SETTLED = 1e-12


class Foot(NamedTuple):
    """Where a connector meets a patch of three or four grids."""

    point: Floats  # (3,) on the patch
    normal: Floats  # (3,)
    motion: Floats  # (6, 3 k): translations and rotations there from the translations of the grids
    outside: float  # how far the point lies beyond the edges, in natural coordinates


def foot(xyz: Floats, point: Floats) -> Foot:
    """Drop a point onto a patch and follow the patch there.

    Translations are those of the bilinear (of a triangle: linear) surface, rotations those of
    its slopes as a Kirchhoff shell has them; about the normal it turns by half of the curl.

    Parameters
    ----------
    xyz : (k, 3) float
        Corners of the patch, three or four.
    point : (3,) float
    """
    at = np.zeros(2) if len(xyz) == 4 else np.full(2, 1.0 / 3.0)
    for _ in range(_ROUNDS):
        N, dN = _shape(at, len(xyz))
        step = np.linalg.lstsq((dN @ xyz).T, point - N @ xyz, rcond=None)[0]
        at = np.clip(at + step, -5.0, 5.0)
        if np.abs(step).max() < _SETTLED:
            break
    N, dN = _shape(at, len(xyz))
    J = dN @ xyz
    z = np.cross(J[0], J[1])
    z /= np.linalg.norm(z)
    x = J[0] / np.linalg.norm(J[0])
    y = np.cross(z, x)
    plane = np.stack([x, y])
    along_x, along_y = np.linalg.inv(J @ plane.T) @ dN
    turn = np.einsum("k,a,b->akb", along_y, x, z) - np.einsum("k,a,b->akb", along_x, y, z)
    turn += 0.5 * np.einsum("k,a,b->akb", along_x, z, y)
    turn -= 0.5 * np.einsum("k,a,b->akb", along_y, z, x)
    motion = np.concatenate([np.kron(N, np.eye(3)), turn.reshape(3, -1)])
    return Foot(N @ xyz, z, motion, _outside(at, len(xyz)))


def _shape(at: Floats, corners: int) -> tuple[Floats, Floats]:
    if corners == 3:
        return np.array([1.0 - at.sum(), *at]), np.array([[-1.0, 1.0, 0.0], [-1.0, 0.0, 1.0]])
    f = 1.0 + _CORNERS * at
    return f.prod(axis=1) / 4.0, (_CORNERS * f[:, ::-1]).T / 4.0


def _outside(at: Floats, corners: int) -> float:
    beyond = [-at.min(), at.sum() - 1.0] if corners == 3 else [np.abs(at).max() - 1.0]
    return float(max(beyond))


def patch_stiffness(ends: Floats, motion: Floats) -> Floats:
    """Stiffness by the translations of the grids from that of the two ends, (n, 3 k, 3 k).

    `ends` is (n, 12, 12) with six motions of end A, then of end B; `motion` (n, 12, 3 k).
    """
    return congruent(ends, motion)


PATCH_CONNECTOR = Element(
    name="patch_connector", shape=None, freedoms=3, stiffness=patch_stiffness, material=False
)
