"""Springs, bushings and masses at grids, as CELASi, CBUSH, CMASSi, CONM2."""

from dataclasses import replace

import numpy as np

from ...arrays import Floats, skew
from ...data.shapes import LINE, POINT
from ..batch import congruent
from ..element import Element
from ..lines.bar import offset_transform

_PAIR = np.array([[1.0, -1.0], [-1.0, 1.0]])


def spring_stiffness(k: Floats, ends: int) -> Floats:
    """Stiffness (or mass) `k`, (n,), between two degrees of freedom, or one and the ground.

    Returns
    -------
    (n, ends, ends) float
    """
    return np.asarray(k[:, None, None] * (_PAIR if ends == 2 else np.ones((1, 1))))


def rigid_mass(mass: Floats, arm: Floats, inertia: Floats) -> Floats:
    """Mass of rigid bodies at grids, (n, 6, 6), basic frame.

    `arm` (n, 3) leads from the grid to the centre of gravity, `inertia` (n, 3, 3) is the tensor
    about it.
    """
    S = skew(arm)
    M = np.zeros((len(mass), 6, 6))
    M[:, :3, :3] = mass[:, None, None] * np.eye(3)
    M[:, :3, 3:] = -mass[:, None, None] * S
    M[:, 3:, :3] = mass[:, None, None] * S
    M[:, 3:, 3:] = inertia - mass[:, None, None] * (S @ S)
    return M


def _nothing(mass: Floats, *_: object) -> Floats:
    return np.zeros((len(mass), 6, 6))


SPRING = Element(name="spring", shape=None, freedoms=1, stiffness=spring_stiffness, material=False)
MASS = Element(
    name="mass", shape=POINT, freedoms=6, stiffness=_nothing, mass=rigid_mass, material=False
)


def bush_stiffness(axes: Floats, k: Floats, arm_a: Floats, arm_b: Floats) -> Floats:
    """Stiffness of bushings (or damping, with damping in place of stiffness).

    Parameters
    ----------
    axes : (n, 3, 3) float
        Rows are the axes of the springs in the basic frame.
    k : (n, 6) float
        Stiffness along and about the axes.
    arm_a, arm_b : (n, 3) float
        From the grids to the place of the springs, basic frame.

    Returns
    -------
    (n, 12, 12) float
        Basic frame; grid A, then grid B. The first six rows and columns are a grounded bushing.
    """
    n = len(axes)
    relative = np.zeros((n, 6, 12))
    for first in (0, 3):
        part = slice(first, first + 3)
        relative[:, part, part] = -axes
        relative[:, part, slice(first + 6, first + 9)] = axes
    K = np.asarray(relative.swapaxes(-1, -2) @ (k[..., None] * relative))
    return congruent(K, offset_transform(arm_a, arm_b))


def general_stiffness(K: Floats, S: Floats) -> Floats:
    """Stiffness K (n, m, m) against the difference of m motions and S (n, m, k) times k others.

    Returns
    -------
    (n, m + k, m + k) float
    """
    difference = np.concatenate([np.broadcast_to(np.eye(K.shape[1]), K.shape), -S], axis=2)
    return np.asarray(difference.swapaxes(1, 2) @ K @ difference)


GENERAL = Element(
    name="general", shape=None, freedoms=1, stiffness=general_stiffness, material=False
)
BUSH = Element(name="bush", shape=LINE, freedoms=6, stiffness=bush_stiffness, material=False)
GROUNDED_BUSH = replace(BUSH, name="grounded_bush", shape=POINT)
