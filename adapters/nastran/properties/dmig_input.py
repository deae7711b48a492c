"""Direct matrix input: DMIG matrices that case control adds to stiffness or mass."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from ....core.errors import Place
from ..deck.card_definition import Card
from ..deck.read_deck import Deck
from .grids import Points

if TYPE_CHECKING:
    import scipy.sparse as sp

CARDS = (
    Card("DMIG", "NAME:x! GJ:i! CJ:i=0 TIN:i=0 [G>nodes:i C>components:i=0 A>values:ir B>b:ir]"),
)
"""The header has the column's number 0, its form in CJ."""

_SYMMETRIC = 6


def direct_matrices(deck: Deck, points: Points) -> tuple[sp.csr_matrix, sp.csr_matrix]:
    """Sum the matrices named by K2GG and by M2GG, over the g-set.

    PARAM CK2 and CM2 scale them; WTMASS does not. K2PP and M2PP are for response analyses and do
    not enter normal modes.

    Raises
    ------
    InputError
        A name without DMIG, complex or unsymmetric matrices, points that do not exist.
    """
    return _named(deck, points, "K2GG", "CK2"), _named(deck, points, "M2GG", "CM2")


def external_matrices(deck: Deck, points: Points) -> tuple[sp.csr_matrix, sp.csr_matrix]:
    """Sum stiffness and mass of external superelements, over the g-set.

    Raises
    ------
    InputError
        Points that do not exist.
    """
    import scipy.sparse as sp  # slow to import, and not needed to read a deck

    n = points.n_dof
    totals = [sp.csr_matrix((n, n)), sp.csr_matrix((n, n))]
    for part in deck.external:
        place = Place(deck.path)
        at = [points.dof(grid, component, place) for grid, component in part.points]
        T = sp.coo_matrix((np.ones(len(at)), (at, range(len(at)))), shape=(n, len(at))).tocsr()
        for k, matrix in enumerate((part.stiffness, part.mass)):
            totals[k] = (totals[k] + T @ matrix @ T.T).tocsr()
    return totals[0], totals[1]


def direct_damping(deck: Deck, points: Points) -> tuple[sp.csr_matrix, sp.csr_matrix]:
    """Sum the matrices named by B2GG and by K42GG: viscous and structural damping, over the g-set.

    PARAM CB2 and CK42 scale them.

    Raises
    ------
    InputError
        As `direct_matrices`.
    """
    return _named(deck, points, "B2GG", "CB2"), _named(deck, points, "K42GG", "CK42")


def _named(deck: Deck, points: Points, command: str, scale: str) -> sp.csr_matrix:
    """Sum the matrices that a command names, over the g-set."""
    import scipy.sparse as sp

    total = sp.csr_matrix((points.n_dof, points.n_dof))
    for name, factor in getattr(deck.case, command.lower()):
        matrix = _read(deck, points, name, command)
        total = total + factor * deck.param(scale, 1.0) * matrix
    return total.tocsr()


def _read(deck: Deck, points: Points, name: str, asked_by: str) -> sp.csr_matrix:
    import scipy.sparse as sp

    cards = [(card, place) for card, place in deck.bulk.placed("DMIG") if card.name == name]
    headers = [(card, p) for card, p in cards if card.gj == 0]
    if not headers:
        raise Place(deck.path).error(
            f"case control asks for {asked_by} = {name}, but the deck has no DMIG {name}"
        )
    header, place = headers[0]
    form, kind = header.cj, header.tin
    if kind in (3, 4):
        raise place.error(f"{name} is complex; only real matrices can be added")
    if form not in (1, 2, _SYMMETRIC):
        raise place.error(f"{name} has the form {form}; 1 or 6 (symmetric) is expected")
    rows: list[int] = []
    columns: list[int] = []
    values: list[float] = []
    for card, at in cards:
        if card.gj != 0:
            column = points.dof(card.gj, card.cj, at)
            for grid, component, a in zip(card.nodes, card.components, card.values, strict=True):
                if grid is None or a is None:
                    raise at.error("a grid or a value is missing")
                rows.append(points.dof(grid, component, at))
                columns.append(column)
                values.append(a)
    n = points.n_dof
    matrix = sp.coo_matrix((values, (rows, columns)), shape=(n, n)).tocsr()
    if form == _SYMMETRIC:
        matrix = _symmetrised(matrix)
    elif abs(matrix - matrix.T).max() > 1e-9 * abs(matrix).max():
        raise place.error(f"{name} is not symmetric")
    return matrix


def _symmetrised(matrix: sp.csr_matrix) -> sp.csr_matrix:
    """Fill the other triangle, where it was not given too."""
    import scipy.sparse as sp

    lower, upper = sp.tril(matrix, -1), sp.triu(matrix, 1)
    whole = lower.nnz and abs(lower - upper.T).max() <= 1e-12 * abs(matrix).max()
    return matrix if whole else (matrix + lower.T + upper.T).tocsr()
