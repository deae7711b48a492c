"""Straight bars and rods as Nastran's CBAR, CROD, CONROD and CTUBE."""

import numpy as np

from ...arrays import Floats, Numbers
from ...data.shapes import LINE
from ..batch import arms, congruent, symmetric, transpose, unit
from ..element import Element

_RELEASED = 1e-10


def bar_axes(xa: Floats, xb: Floats, v: Floats) -> Floats:
    """Element axes: x from end A to end B, y towards `v`, plane 1 is x-y.

    Parameters
    ----------
    xa, xb : (n, 3) float
        Ends of the flexible part, basic frame.
    v : (n, 3) float
        Orientation vectors, basic frame, not parallel to the bar (that gives NaN).

    Returns
    -------
    (n, 3, 3) float
        Rows are the unit vectors x, y, z.
    """
    x = unit(xb - xa)
    z = unit(np.cross(x, v))
    return np.stack([x, np.cross(z, x), z], axis=1)


def offset_transform(wa: Floats, wb: Floats) -> Floats:
    """Rigid arms: motions of the two ends from those of the two grids, (n, 12, 12).

    With T of the offsets `wa` and `wb`, (n, 3), from grids to ends, basic frame, a matrix K of
    the ends becomes T^T K T on the grids.
    """
    return arms(np.broadcast_to(np.eye(3), (len(wa), 3, 3)), np.stack([wa, wb], axis=1))


def bar_stiffness(
    xa: Floats,
    xb: Floats,
    v: Floats,
    E: Floats,
    G: Floats,
    A: Floats,
    I1: Floats,
    I2: Floats,
    I12: Floats,
    J: Floats,
    k1: Floats,
    k2: Floats,
    pins_a: Numbers,
    pins_b: Numbers,
) -> Floats:
    """Stiffness of prismatic bars between their ends.

    Parameters
    ----------
    xa, xb, v : (n, 3) float
        End points (offsets already added) and orientation vectors, basic frame.
    E, G, A, I1, I2, I12, J : (n,) float
        Moduli, area, inertias (I1: bending in plane 1, x-y), torsion constant.
    k1, k2 : (n,) float
        Shear area factors in planes 1 and 2; 0: no shear flexibility.
    pins_a, pins_b : (n, 6) bool
        Motions of the element axes that the bar does not transmit to its ends.

    Returns
    -------
    (n, 12, 12) float
        Basic frame; u v w rx ry rz of end A, then of end B.
    """
    n = len(xa)
    L = np.linalg.norm(xb - xa, axis=1)
    K = np.zeros((n, 12, 12))
    add_spring(K, 0, E * A / L)
    add_spring(K, 3, G * J / L)
    EI = np.moveaxis(np.array([[E * I1, E * I12], [E * I12, E * I2]]), -1, 0)
    shear = np.zeros((n, 2, 2))
    for i, k in enumerate((k1, k2)):
        stiff = np.asarray(k * A * G, float)
        flexible = stiff > 0.0
        shear[:, i, i] = np.where(flexible, 1.0 / np.where(flexible, stiff, 1.0), 0.0)
    factor = np.eye(2) + EI @ shear * (12.0 / L**2)[:, None, None]
    antisymmetric = symmetric(np.linalg.solve(factor, EI)) * (12.0 / L)[:, None, None]
    V, R = bending_modes(L)
    K += transpose(V) @ antisymmetric @ V + transpose(R) @ (EI / L[:, None, None]) @ R
    K = release(K, np.concatenate([pins_a, pins_b], axis=1))
    return from_axes(K, xa, xb, v)


def bar_mass(
    xa: Floats,
    xb: Floats,
    v: Floats,
    mass_per_length: Floats,
    coupled: bool,
    spin: Floats | None = None,
) -> Floats:
    """Mass of prismatic bars, (n, 12, 12), basic frame, as Nastran makes it.

    Parameters
    ----------
    xa, xb, v : (n, 3) float
        As for `bar_stiffness`.
    mass_per_length : (n,) float
        rho A + non-structural mass.
    coupled : bool
        Hermite bending and the mean of lumped and consistent mass along the axis (COUPMASS 1);
        otherwise half the mass at each end, translations only.
    spin : (n,) float, optional
        rho (I1 + I2), inertia about the axis (BARMASS 1); with it all along the axis is
        consistent where `coupled`.
    """
    L = np.linalg.norm(xb - xa, axis=1)
    if not coupled:
        M = lumped_ends(np.stack([0.5 * mass_per_length * L] * 2, axis=1))
        if spin is None:
            return M
        M[:, [3, 9], [3, 9]] = (0.5 * spin * L)[:, None]
        return from_axes(M, xa, xb, v)
    M = np.zeros((len(xa), 12, 12))
    own, other = (175.0, 35.0) if spin is None else (140.0, 70.0)
    for i, j, m in ((0, 0, own), (6, 6, own), (0, 6, other), (6, 0, other)):
        M[:, i, j] = m
    for w, r, sign in ((1, 5, 1.0), (2, 4, -1.0)):
        rows = np.array([w, r, w + 6, r + 6])
        M[:, rows[:, None], rows] = _hermite_mass(sign * L)
    M *= (mass_per_length * L / 420.0)[:, None, None]
    if spin is not None:
        for i, j, share in ((3, 3, 3.0), (9, 9, 3.0), (3, 9, 6.0), (9, 3, 6.0)):
            M[:, i, j] = spin * L / share
    return from_axes(M, xa, xb, v)


def rod_stiffness(xyz: Floats, E: Floats, A: Floats, G: Floats, J: Floats) -> Floats:
    """Stiffness of rods, (n, 12, 12): axial E A / L and torsion G J / L, basic frame.

    Parameters
    ----------
    xyz : (n, 2, 3) float
        Ends, basic frame.
    E, A, G, J : (n,) float
        Moduli, area, torsion constant.
    """
    x, L = _along(xyz)
    outer = x[:, :, None] * x[:, None, :]
    K = np.zeros((len(xyz), 2, 6, 2, 6))
    for first, k in ((0, E * A / L), (3, G * J / L)):
        part = slice(first, first + 3)
        block = k[:, None, None] * outer
        K[:, 0, part, 0, part] = K[:, 1, part, 1, part] = block
        K[:, 0, part, 1, part] = K[:, 1, part, 0, part] = -block
    return K.reshape(-1, 12, 12)


def rod_mass(xyz: Floats, mass_per_length: Floats, coupled: bool) -> Floats:
    """Mass of rods, (n, 12, 12), translations only, basic frame.

    Parameters
    ----------
    xyz : (n, 2, 3) float
        Ends, basic frame.
    mass_per_length : (n,) float
        rho A + non-structural mass.
    coupled : bool
        Along the axis the mean of lumped and consistent mass (5/12, 1/12), lumped across it;
        otherwise half the mass at each end.
    """
    x, L = _along(xyz)
    mass = mass_per_length * L
    M = lumped_ends(np.stack([0.5 * mass] * 2, axis=1))
    if coupled:
        twelfth = (mass / 12.0)[:, None, None] * x[:, :, None] * x[:, None, :]
        M[:, 0:3, 0:3] -= twelfth
        M[:, 6:9, 6:9] -= twelfth
        M[:, 0:3, 6:9] += twelfth
        M[:, 6:9, 0:3] += twelfth
    return M


def _along(xyz: Floats) -> tuple[Floats, Floats]:
    """Directions (n, 3) and lengths (n,) of lines."""
    d = xyz[:, 1] - xyz[:, 0]
    L = np.linalg.norm(d, axis=1)
    return d / L[:, None], L


def add_spring(K: Floats, dof: int, k: Floats) -> None:
    """Add a spring between the same local motion of both ends, in place."""
    K[:, dof, dof] += k
    K[:, dof + 6, dof + 6] += k
    K[:, dof, dof + 6] -= k
    K[:, dof + 6, dof] -= k


def bending_modes(L: Floats) -> tuple[Floats, Floats]:
    """Chord rotation less mean end rotation, and difference of end rotations, each (n, 2, 12).

    Rows are planes 1 and 2, columns the local motions of the ends.
    """
    V = np.zeros((len(L), 2, 12))
    R = np.zeros((len(L), 2, 12))
    for plane, (w, r, sign) in enumerate(((1, 5, 1.0), (2, 4, -1.0))):
        V[:, plane, w], V[:, plane, w + 6] = -1.0 / L, 1.0 / L
        V[:, plane, r] = V[:, plane, r + 6] = -0.5 * sign
        R[:, plane, r], R[:, plane, r + 6] = -sign, sign
    return V, R


def release(K: Floats, pins: Numbers) -> Floats:
    """Condense out the released freedoms `pins`, (n, m) bool, of the matrices (n, m, m)."""
    pins = np.asarray(pins, bool)
    diagonal = np.einsum("nii->ni", K).copy()
    K = K.copy()
    for i in np.flatnonzero(pins.any(axis=0)):
        rows = np.flatnonzero(pins[:, i])
        column, pivot = K[rows, :, i], K[rows, i, i]
        stiff = pivot > _RELEASED * diagonal[rows, i]
        scaled = column / np.where(stiff, pivot, np.inf)[:, None]
        K[rows] -= column[:, :, None] * scaled[:, None, :]
        K[rows, :, i] = 0.0
        K[rows, i, :] = 0.0
    return K


def from_axes(K: Floats, xa: Floats, xb: Floats, v: Floats) -> Floats:
    """Turn matrices (n, 12, 12) of two ends from element axes to the basic frame."""
    return congruent(K, arms(bar_axes(xa, xb, v), np.zeros((len(K), 2, 3))))


def lumped_ends(mass: Floats) -> Floats:
    """Masses (n, 2) at the ends, translations only, (n, 12, 12)."""
    M = np.zeros((len(mass), 12, 12))
    for end, first in ((0, 0), (1, 6)):
        for i in range(3):
            M[:, first + i, first + i] = mass[:, end]
    return M


def _hermite_mass(L: Floats) -> Floats:
    """420 / (m L) times the consistent mass of a beam: w, rotation at each end, (n, 4, 4)."""
    one = np.ones_like(L)
    first = [156 * one, 22 * L, 54 * one, -13 * L]
    rest = [4 * L**2, 13 * L, -3 * L**2, 156 * one, -22 * L, 4 * L**2]
    upper = np.stack([*first, *rest], axis=1)
    M = np.zeros((len(L), 4, 4))
    i, j = np.triu_indices(4)
    M[:, i, j] = M[:, j, i] = upper
    return M


BAR = Element(
    name="bar", shape=LINE, freedoms=6, stiffness=bar_stiffness, mass=bar_mass, exact=True
)
ROD = Element(name="rod", shape=LINE, freedoms=6, stiffness=rod_stiffness, mass=rod_mass)
