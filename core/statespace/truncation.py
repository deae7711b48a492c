"""Modes that are kept, what the others contribute as statics, and what is still missing."""

from __future__ import annotations

import numpy as np
import scipy.linalg
import scipy.sparse as sp

from ..arrays import Floats, Numbers
from ..eigen.normal_modes import Eigensolution
from ..numerics.factorisation import factorise
from .statespace_numbers import STATESPACE


def residual_modes(
    K: sp.csr_matrix, M: sp.csr_matrix, kept: Eigensolution, forces: Floats
) -> tuple[Floats, Floats]:
    """Modes of the motions under `forces` that the kept modes lack: residual vectors.

    In the band they answer as the residual flexibility does, but have velocities and accelerations
    as well, and outputs need no feed-through of displacement.

    Dickens, Nakagawa, Wittbrodt (1997), *A critique of mode acceleration and modal truncation
    augmentation methods for modal response analysis*, Computers & Structures 62(6), 985.

    Parameters
    ----------
    K, M : (n, n) sparse
    kept : Eigensolution
        With its factor.
    forces : (n, m) float

    Returns
    -------
    eigenvalues : (r,) float
        (rad/s)², above those of the kept modes.
    vectors : (n, r) float
        Mass-normalised and orthogonal to the kept modes, r at most m.
    """
    factor = kept.factor
    assert factor is not None
    X = kept.vectors
    others = forces - M @ (X @ (X.T @ forces))
    R = np.zeros(forces.shape)
    for _ in range(STATESPACE.sweeps):  # K R = others by the factor of K - sigma M
        R = factor.solve(np.asfortranarray(others - kept.sigma * (M @ R))).reshape(forces.shape)
        R = R - X @ (X.T @ (M @ R))
    whole = np.asarray(factor.solve(np.asfortranarray(forces))).reshape(forces.shape)
    whole = np.sqrt(np.einsum("ij,ij->j", whole, M @ whole))
    size = np.sqrt(np.maximum(np.einsum("ij,ij->j", R, M @ R), 0.0))
    R = R[:, size > STATESPACE.contained * whole] / size[size > STATESPACE.contained * whole]
    values, turns = np.linalg.eigh(R.T @ (M @ R))
    apart = values > STATESPACE.dependent
    R = R @ (turns[:, apart] / np.sqrt(values[apart]))
    if not R.shape[1]:
        return np.zeros(0), R
    R = R - X @ (X.T @ (M @ R))
    values, turns = scipy.linalg.eigh(R.T @ (K @ R), R.T @ (M @ R))
    return values, R @ turns


def receptance_at(
    K: sp.csr_matrix,
    M: sp.csr_matrix,
    forces: Floats,
    rows: Numbers | sp.spmatrix,
    hz: float,
) -> Floats:
    """Return the receptance of the undamped model at one frequency, (n_row, n_force)."""
    A = sp.csr_matrix(K - (2.0 * np.pi * hz) ** 2 * M)
    x = np.asarray(factorise(A, False).solve(np.asfortranarray(forces)))
    return np.asarray(rows @ x.reshape(forces.shape))


def relative_error(difference: Floats, receptance: Numbers) -> float:
    """Return the largest difference over the median of its receptance in the band.

    Receptances that are next to nothing beside the largest of their column or row do not count
    more than those at the floor of the table of numbers.

    Parameters
    ----------
    difference : (n, m) float
    receptance : (n, m, n_line) complex
    """
    usual = np.median(np.abs(receptance), axis=2)
    loud = usual.max(axis=0, keepdims=True) * usual.max(axis=1, keepdims=True)
    scale = np.maximum(usual, STATESPACE.silent * np.sqrt(loud))
    return float(np.max(np.abs(difference)[scale > 0.0] / scale[scale > 0.0], initial=0.0))
