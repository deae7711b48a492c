"""Mass and centre of gravity as the rigid-body mass matrix (6, 6) about a point tells them."""

import numpy as np

from ..arrays import Floats

_ALIKE = 1e-4


def mass_axis(R: Floats) -> int:
    """Return the translation that moves most: where masses act along some axes only, it has all."""
    return int(np.argmax(np.diag(R)[:3]))


def mass_moments(R: Floats) -> tuple[Floats, Floats]:
    """Return moments of mass and the masses they are of, each (3,): two axes tell a coordinate.

    M[0, 4] = m_x z, M[0, 5] = -m_x y, M[1, 3] = -m_y z, ...
    """
    S, m = R[:3, 3:], np.diag(R)[:3]
    moments = np.array([S[1, 2] - S[2, 1], S[2, 0] - S[0, 2], S[0, 1] - S[1, 0]])
    return moments, np.array([m[1] + m[2], m[2] + m[0], m[0] + m[1]])


def centre_of_mass(R: Floats) -> Floats:
    """Return the centre of gravity from the point that `R` is about, (3,); 0 where none is told."""
    moments, masses = mass_moments(R)
    return np.asarray(np.divide(moments, masses, out=np.zeros(3), where=masses > 0.0))


def differs_by_axis(R: Floats) -> str | None:
    """Say that a model has other masses along other axes; None where it has not."""
    m = np.diag(R)[:3]
    if np.ptp(m) <= _ALIKE * m.max():
        return None
    x, y, z = m
    return f"masses along x, y and z are {x:.5g}, {y:.5g} and {z:.5g}; the largest is told as mass"
