"""Stiffness of a shell per unit length: what an element needs to know of its property."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..arrays import Floats, Numbers, frozen, require_shape
from .batch import symmetric, transpose


@dataclass(frozen=True, eq=False)
class ShellSection:
    """Force and moment resultants per strain and curvature, in the *element* axes.

    With strain(z) = strain + z curvature, z along the element normal, and
    curvature = (d ry/dx, -d rx/dy, d ry/dy - d rx/dx):
    N = A strain + B curvature, M = B strain + D curvature, Q = S gamma.

    Parameters
    ----------
    A, B, D : (n, 3, 3) float
        Membrane, coupling and bending stiffness (classical laminate theory: integrals of
        Q dz, Q z dz and Q z**2 dz). Zero A or D: no membrane, or no bending and shear.
    S : (n, 2, 2) float
        Transverse shear stiffness; infinite on the diagonal: rigid in shear.
    drilling : (n,) float
        Reference stiffness G t for the rotation about the normal.
    """

    A: Floats
    B: Floats
    D: Floats
    S: Floats
    drilling: Floats

    def __post_init__(self) -> None:
        n = len(np.asarray(self.drilling))
        for name, shape in (("A", (3, 3)), ("B", (3, 3)), ("D", (3, 3)), ("S", (2, 2))):
            object.__setattr__(self, name, frozen(getattr(self, name), np.float64))
            require_shape(getattr(self, name), (n, *shape), f"shell stiffness {name}")
        object.__setattr__(self, "drilling", frozen(self.drilling, np.float64))
        require_shape(self.drilling, (n,), "drilling stiffness")

    def __len__(self) -> int:
        return len(self.drilling)

    def take(self, rows: slice | Numbers) -> ShellSection:
        """Return the sections of the given elements (slice, indices or mask)."""
        return ShellSection(
            self.A[rows], self.B[rows], self.D[rows], self.S[rows], self.drilling[rows]
        )


def isotropic_section(
    E: Floats,
    nu: Floats,
    G: Floats,
    t: Floats,
    bending_ratio: Floats | float = 1.0,
    shear_ratio: Floats | float = 0.833333,
) -> ShellSection:
    """Section of a homogeneous isotropic plate, all arguments (n,) or scalar.

    In-plane shear follows from E and nu, transverse shear from G, as NX Nastran does it.

    Parameters
    ----------
    E, nu, G : float
        Young's modulus, Poisson's ratio, modulus of transverse shear.
    t : float
        Thickness.
    bending_ratio : float
        12 I / t**3, bending inertia relative to the homogeneous plate; 0: no bending.
    shear_ratio : float
        ts / t; infinite: rigid in transverse shear.
    """
    E, nu, G, t, ratio, shear = np.broadcast_arrays(
        *(np.atleast_1d(np.asarray(a, float)) for a in (E, nu, G, t, bending_ratio, shear_ratio))
    )
    n = len(E)
    Q = np.zeros((n, 3, 3))
    Q[:, 0, 0] = Q[:, 1, 1] = E / (1.0 - nu**2)
    Q[:, 0, 1] = Q[:, 1, 0] = nu * Q[:, 0, 0]
    Q[:, 2, 2] = E / (2.0 * (1.0 + nu))
    S = np.zeros((n, 2, 2))
    S[:, 0, 0] = S[:, 1, 1] = G * shear * t
    return ShellSection(
        A=Q * t[:, None, None],
        B=np.zeros((n, 3, 3)),
        D=Q * (ratio * t**3 / 12.0)[:, None, None],
        S=S,
        drilling=Q[:, 2, 2] * t,
    )


def rotate_section(section: ShellSection, angle: Floats) -> ShellSection:
    """Turn a section from material axes to element axes.

    Parameters
    ----------
    section : ShellSection
        In material axes.
    angle : (n,) float
        Angle [rad] of the material x axis from the element x axis, positive about the normal.
    """
    angle = np.broadcast_to(np.asarray(angle, float), section.drilling.shape)
    c, s = np.cos(angle), np.sin(angle)
    # strains along the material axes from those along the element axes
    T = np.empty((len(section), 3, 3))
    T[:, 0] = np.stack([c * c, s * s, s * c], axis=1)
    T[:, 1] = np.stack([s * s, c * c, -s * c], axis=1)
    T[:, 2] = np.stack([-2.0 * s * c, 2.0 * s * c, c * c - s * s], axis=1)
    R = np.empty((len(section), 2, 2))
    R[:, 0] = np.stack([c, s], axis=1)
    R[:, 1] = np.stack([-s, c], axis=1)
    rigid = np.isinf(section.S).any(axis=(1, 2))
    S = np.where(rigid[:, None, None], np.eye(2), section.S)
    S = symmetric(transpose(R) @ S @ R)
    S[rigid] = section.S[rigid]
    return ShellSection(
        A=symmetric(transpose(T) @ section.A @ T),
        B=symmetric(transpose(T) @ section.B @ T),
        D=symmetric(transpose(T) @ section.D @ T),
        S=S,
        drilling=section.drilling,
    )
