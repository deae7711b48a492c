"""Direct matrix input: DMIG matrices that case control adds to stiffness or mass."""

from __future__ import annotations

from typing import Any

import scipy.sparse as sp

from ...core.errors import InputError
from .cards import Fields, to_float
from .grids import Points
from .read import Deck

_SYMMETRIC = 6


def direct_matrices(deck: Deck, points: Points) -> tuple[sp.csr_matrix, sp.csr_matrix]:
    """Sum the matrices named by K2GG and K2PP, and by M2GG and M2PP, over the g-set.

    PARAM CK2, CM2 (GG) and CK3, CM3 (PP) scale them; WTMASS does not.

    Raises
    ------
    InputError
        A name without DMIG, complex or unsymmetric matrices, points that do not exist.
    """
    n = points.n_dof
    totals = []
    for entries in (("k2gg", "CK2", "k2pp", "CK3"), ("m2gg", "CM2", "m2pp", "CM3")):
        total = sp.csr_matrix((n, n))
        for names, scale in zip(entries[::2], entries[1::2], strict=True):
            for name, factor in getattr(deck.case, names):
                matrix = _read(deck, points, name, names.upper())
                total = total + factor * deck.param(scale, 1.0) * matrix
        totals.append(total.tocsr())
    return totals[0], totals[1]


def _read(deck: Deck, points: Points, name: str, asked_by: str) -> sp.csr_matrix:
    cards = [
        (fields, deck.bulk.place_listed("DMIG", k))
        for k, fields in enumerate(deck.bulk.listed("DMIG"))
        if len(fields) > 2 and str(fields[1]).upper() == name
    ]
    headers = [(f, p) for f, p in cards if str(f[2]) == "0"]
    if not headers:
        raise InputError(
            f"{deck.path}: case control asks for {asked_by} = {name}, but the deck has no DMIG "
            f"{name}"
        )
    header, place = headers[0]
    form, kind = (int(str(f)) if f is not None else 0 for f in (*header, None, None)[3:5])
    if kind in (3, 4):
        raise InputError(f"{place}: {name} is complex; only real matrices can be added")
    if form not in (1, 2, _SYMMETRIC):
        raise InputError(f"{place}: {name} has the form {form}; 1 or 6 (symmetric) is expected")
    rows: list[int] = []
    columns: list[int] = []
    values: list[float] = []
    for fields, at in cards:
        if str(fields[2]) != "0":
            _add_column(fields, at, points, rows, columns, values)
    n = points.n_dof
    matrix = sp.coo_matrix((values, (rows, columns)), shape=(n, n)).tocsr()
    if form == _SYMMETRIC:
        matrix = _symmetrised(matrix)
    elif abs(matrix - matrix.T).max() > 1e-9 * abs(matrix).max():
        raise InputError(f"{place}: {name} is not symmetric")
    return matrix


def _add_column(
    fields: Fields,
    place: str,
    points: Points,
    rows: list[int],
    columns: list[int],
    values: list[float],
) -> None:
    """GJ CJ - G1 C1 A1 B1, then G2 C2 A2 B2 from the second line on."""
    padded: list[Any] = [*fields, *[None] * 8]
    try:
        column = points.dof(int(padded[2]), int(padded[3] or 0), place)
        for start in (5, *range(9, len(fields), 4)):
            grid, component, a = padded[start : start + 3]
            if grid is None:
                continue
            rows.append(points.dof(int(grid), int(component or 0), place))
            columns.append(column)
            values.append(to_float(str(a)))
    except (TypeError, ValueError):
        raise InputError(f"{place}: a grid, component or value is missing or wrong") from None


def _symmetrised(matrix: sp.csr_matrix) -> sp.csr_matrix:
    """Fill the other triangle, where it was not given too."""
    diagonal = sp.diags(matrix.diagonal())
    lower, upper = sp.tril(matrix, -1), sp.triu(matrix, 1)
    if lower.nnz and upper.nnz and abs(lower - upper.T).max() <= 1e-12 * abs(matrix).max():
        return matrix
    return (diagonal + lower + lower.T + upper + upper.T).tocsr()
