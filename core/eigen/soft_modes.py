"""Modes whose strain energy is next to nothing beside the stiffness that moves with them.

A body on soft supports carries its stiff springs along. Their forces cancel, and what is left of
them by rounding is more than the supports give. So energies are summed without the part that a
rigid motion of the body has in the motion: of its forces those that are rounding are none.
"""

from dataclasses import replace

import numpy as np
import scipy.linalg as sl

from ..arrays import Floats, Numbers
from ..errors import InputError
from .eigen_numbers import EIGEN
from .mechanisms import NEGATIVE, where
from .pencil import Pencil, Spectrum, magnitudes
from .rigid_body_modes import RigidBody


def refined(
    pencil: Pencil, body: RigidBody | None, spectrum: Spectrum
) -> tuple[Spectrum, Numbers, Floats]:
    """Find soft modes again, alike whatever solver found their span.

    Returned are the spectrum with the soft modes by the method of Ritz, which modes have a strain
    energy that is rounding, (n_mode,) bool, and how uncertain each eigenvalue is by the rounding
    of K, relative, (n_mode,) float.

    Raises
    ------
    InputError
        A strain energy is negative.
    """
    X, values = spectrum.vectors, spectrum.values
    size = np.einsum("ij,ij,i->j", X, X, np.abs(pencil.k_diagonal))
    rounding = max(EIGEN.strain, EIGEN.digits * pencil.precision)
    doubt = np.full(len(values), np.inf)
    np.divide(EIGEN.strain * size, values, out=doubt, where=values > 0.0)
    soft = values < np.maximum(EIGEN.soft * size, -EIGEN.near_zero * spectrum.sigma)
    soft[EIGEN.looked_at :] = False
    if not soft.any():
        return spectrum, soft, doubt
    Z = X[:, soft]
    rigid, force = body.part(np.abs(pencil.k_diagonal), Z) if body else (np.zeros_like(Z),) * 2
    W = Z - rigid
    cross = W.T @ force
    energy = rigid.T @ force + cross + cross.T + W.T @ (pencil.K @ W)
    lambda_, turn = sl.eigh((energy + energy.T) / 2.0, Z.T @ (pencil.M @ Z))
    Z, W, rigid, force = Z @ turn, W @ turn, rigid @ turn, force @ turn
    own = np.einsum("ij,ij,i->j", W, W, np.abs(pencil.k_diagonal))
    held = np.where(force != 0.0, np.abs(rigid) * (magnitudes(pencil.K) @ np.abs(rigid)), 0.0)
    whole = own + held.sum(axis=0)
    noise = EIGEN.strain * whole
    below = lambda_ < -max(EIGEN.singular, rounding) * whole
    if below.any():
        raise InputError(NEGATIVE.format(where(None, pencil, Z[:, below])))
    zero = np.zeros(len(values), bool)
    zero[soft] = lambda_ <= EIGEN.strain * own
    doubt[soft] = np.divide(noise, lambda_, out=np.full(len(noise), np.inf), where=lambda_ > 0.0)
    values, X = values.copy(), X.copy()
    values[soft], X[:, soft] = lambda_, Z
    order = np.argsort(values, kind="stable")
    spectrum = replace(spectrum, values=values[order], vectors=X[:, order])
    return spectrum, zero[order], doubt[order]
