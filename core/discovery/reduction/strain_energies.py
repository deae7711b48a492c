"""How known parameters change what elements hold in the deck's modes."""

from collections.abc import Sequence

import numpy as np

from ...arrays import Floats, Ints
from ...assembly.element_assembly import CHUNK
from .elements_and_supports import Members, Structure
from .reduction_numbers import REDUCTION

Energies = Sequence[Floats]


def strain_energies(structure: Structure, modes: Floats, eigenvalues: Floats) -> Energies:
    """Return the energy of each element in some modes, and its derivatives by ln p.

    Modal strain energy (Johnson and Kienholz 1982, AIAA Journal 20, 1284): each mode counts by the
    energy of an element as a share of that of the whole. A stiffness that
    is made of several parts (membrane and bending of a shell, one by the thickness, one by its
    cube) follows a parameter by the mean of their exponents in these modes.

    Parameters
    ----------
    structure : Structure
    modes : (n_free, n_mode) float
    eigenvalues : (n_mode,) float
        Those of modes that strain nothing are left out.

    Returns
    -------
    sequence of (n_element, 1 + n_parameter) float
        For each card of the structure; zeros where an element has no stiffness.
    """
    strained = eigenvalues > REDUCTION.strained * eigenvalues.max(initial=0.0)
    unit = modes[:, strained] / np.sqrt(eigenvalues[strained])
    motion = np.asarray(structure.displacement @ unit)
    return [_of_card(structure, m, motion) for m in structure.members]


def _of_card(structure: Structure, m: Members, motion: Floats) -> Floats:
    deck = structure.model.deck_point
    out = np.zeros((len(m.ids), 1 + len(deck)))
    for first in range(0, len(m.ids), CHUNK):
        rows = np.arange(first, min(first + CHUNK, len(m.ids)))
        out[rows, 0] = _energy(m, rows, m.stiffness(rows, deck), motion)
        for q in range(len(deck)):
            concerned = [k for k, on in enumerate(m.block.depends) if q in on]
            moved = rows[np.isin(m.block.depends_of[rows], concerned)]
            if len(moved):
                out[moved, 1 + q] = _energy(m, moved, m.slope(moved, deck, q), motion)
    return out


def _energy(m: Members, rows: Ints, K: Floats, motion: Floats) -> Floats:
    """Return the energy of some elements with matrices K, summed over the motions, (n,)."""
    U = motion[m.coordinates(rows)]
    return np.asarray(np.sum(U * np.matmul(K, U), axis=(1, 2)))
