"""Homogeneous plates and volumes, for the tests of elements."""

import numpy as np

from trueup.core.elements.surfaces.section import ShellSection


def isotropic_section(E, nu, G, t, bending_ratio=1.0, shear_ratio=0.833333):
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
    )


def volume(solid, xyz):
    """Volumes, (n,); negative: inside out."""
    return solid.mass(xyz, np.ones(len(xyz)), True)[:, ::3, ::3].sum(axis=(1, 2))
