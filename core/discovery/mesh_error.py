"""The error of a mesh as one more parameter of the model.

Shells with their mass lumped at the grids vibrate too slowly, the more so the fewer elements a
wave has; consistent masses, and what the stiffness of the element gets wrong, act alike. So the
mass matrix may move by θ times what separates the lumped mass from the consistent one: θ = 0 is
the deck, θ = 1 consistent mass, and a finer mesh lies somewhere about them. Unlike a factor on
the frequencies this follows the wave number of every mode and mixes modes as a finer mesh would.
"""

from __future__ import annotations

import numpy as np

from ..arrays import Floats
from .structure import Members, Structure

_SHARES = {
    "quad": np.array([[4, 2, 1, 2], [2, 4, 2, 1], [1, 2, 4, 2], [2, 1, 2, 4]]) / 36.0,
    "tria": (np.ones((3, 3)) + np.eye(3)) / 12.0,
}
"""Consistent mass of the linear interpolation, of an element of unit mass."""


def lumping(structure: Structure, vectors: Floats) -> Floats:
    """Return lumped minus consistent mass of all shells on a basis, (r, r).

    Parameters
    ----------
    structure : Structure
    vectors : (n_free, r) float
    """
    motion = np.asarray(structure.displacement @ vectors)
    total = np.zeros((vectors.shape[1],) * 2)
    for m in structure.members:
        share = _SHARES.get(m.shape)
        if share is None or m.block.width != 6 or m.corners.shape[1] != len(share):
            continue
        mass = _lumped(structure, m)
        values, R = np.linalg.eigh(np.eye(len(share)) / len(share) - share)
        S = np.sqrt(np.maximum(values, 0.0))[:, None] * R.T
        at = m.coordinates(np.arange(len(m.ids))).reshape(len(m.ids), -1, 6)[:, :, :3]
        u = np.einsum("ab,ebcr->eacr", S, motion[at]) * np.sqrt(mass)[:, None, None, None]
        x = u.reshape(-1, vectors.shape[1])
        total += x.T @ x
    return total


def _lumped(structure: Structure, m: Members) -> Floats:
    """Masses of the elements of one card whose mass is lumped, 0 where it is not, (n,)."""
    _, M = m.matrices(np.arange(len(m.ids)), np.ones(len(structure.model.parameters)))
    if M is None:
        return np.zeros(len(m.ids))
    along = M[:, ::6, ::6]
    diagonal = np.einsum("eii->e", along)
    whole = along.sum(axis=(1, 2))
    return np.asarray(np.where(np.isclose(diagonal, whole), whole, 0.0))
