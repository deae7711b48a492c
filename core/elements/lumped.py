"""Springs between single degrees of freedom, and masses at grids, as CELASi, CMASSi, CONM2."""

from __future__ import annotations

import numpy as np

from ..arrays import Floats
from ..data.shapes import POINT
from .batch import skew
from .element import Element

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

    Parameters
    ----------
    mass : (n,) float
    arm : (n, 3) float
        From the grid to the centre of gravity.
    inertia : (n, 3, 3) float
        Tensor about the centre of gravity.
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
