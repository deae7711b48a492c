"""Constraints of a deck: SPC, permanent constraints, MPC and rigid elements."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np
import scipy.sparse as sp

from ...core.constraints import Equations
from ...core.errors import InputError
from .cards import Card
from .grids import Points
from .read import Deck
from .rigid import RIGID, Rows


@dataclass(frozen=True, eq=False)
class Constraints:
    """What holds the g-set.

    Parameters
    ----------
    equations : Equations
        MPC and rigid elements.
    fixed : (n_dof,) bool
        SPC and permanent constraints.
    notes : tuple of str
        Sets that case control asks for and the deck does not have.
    """

    equations: Equations
    fixed: Any
    notes: tuple[str, ...] = ()


class _Set(NamedTuple):
    """Cards of one kind that a set number selects, with where they stand."""

    card: Card
    place: str
    range: bool  # with THRU: grids missing in the range are passed over, as in Nastran


def read_constraints(deck: Deck, points: Points) -> Constraints:
    """Collect the constraints that the case control section selects, and the rigid elements.

    A set that does not exist constrains nothing and is noted, as in Nastran (its warning 2053).

    Raises
    ------
    InputError
        A grid or component that does not exist; an equation without its first coefficient.
    """
    notes: list[str] = []
    fixed = np.zeros(points.n_dof, dtype=bool)
    fixed[: points.permanent.size] = points.permanent.reshape(-1)
    if deck.case.spc is not None:
        for name, item in _selected(deck, deck.case.spc, ("SPC", "SPC1"), notes):
            for dof in _spc_dofs(name, item, points):
                fixed[dof] = True
    rows = Rows(points)
    for name, make in RIGID.items():
        for number, card in deck.bulk.table(name).items():
            make(rows, card, deck.bulk.place(name, number))
    if deck.case.mpc is not None:
        for _, item in _selected(deck, deck.case.mpc, ("MPC",), notes):
            _add_mpc(rows, item, points)
    return Constraints(_equations(rows, points.n_dof), fixed, tuple(notes))


def _selected(
    deck: Deck, number: int, names: tuple[str, ...], notes: list[str]
) -> Iterator[tuple[str, _Set]]:
    """Cards of a set, sets added together resolved; what is missing goes to `notes`."""
    kind = names[0]
    wanted = {number: f"{deck.path}: case control asks for {kind} = {number}"}
    for k, card in enumerate(deck.bulk.listed(f"{kind}ADD")):
        if int(card.conid) == number:
            place = deck.bulk.place_listed(f"{kind}ADD", k)
            wanted.update({int(s): f"{place} adds set {int(s)}" for s in card.sets})
    added = len(wanted) > 1
    found = {number} if added else set()
    for name in names:
        for k, card in enumerate(deck.bulk.listed(name)):
            if int(card.conid) in wanted:
                found.add(int(card.conid))
                raw = deck.bulk.raw[name][k]
                thru = any("THRU" in line.upper() for line in raw.lines)
                yield name, _Set(card, f"{name} ({deck.bulk.at(raw)})", thru)
    notes.extend(
        f"{asked}, but the deck has no {kind} cards of that set: nothing is constrained by it"
        for missing, asked in wanted.items()
        if missing not in found
    )


def _spc_dofs(name: str, item: _Set, points: Points) -> Iterator[int]:
    card = item.card
    components = [card.components] * len(card.nodes) if name == "SPC1" else card.components
    for grid, digits in zip(card.nodes, components, strict=True):
        if item.range and not points.exists(int(grid)):
            continue
        for component in _components(str(digits or "0")):
            yield points.dof(int(grid), component, item.place)


def _components(digits: str) -> list[int]:
    return [int(d) for d in digits.strip()]


def _add_mpc(rows: Rows, item: _Set, points: Points) -> None:
    card = item.card
    dofs = [
        points.dof(int(grid), int(component or 0), item.place)
        for grid, component in zip(card.nodes, card.components, strict=True)
    ]
    coefficients = np.array([float(a) for a in card.coefficients])
    if coefficients[0] == 0.0:
        raise InputError(f"{item.place}: the first coefficient of an MPC must not be zero")
    rows.add(dofs[0], dofs[1:], -coefficients[1:] / coefficients[0], item.place)


def _equations(rows: Rows, n_dof: int) -> Equations:
    matrix = sp.coo_matrix(
        (
            np.array(rows.values, dtype=np.float64),
            (np.array(rows.rows, dtype=np.int64), np.array(rows.columns, dtype=np.int64)),
        ),
        shape=(len(rows.dependent), n_dof),
    ).tocsr()
    matrix.eliminate_zeros()
    return Equations(np.array(rows.dependent, dtype=np.int64), matrix, tuple(rows.owners))
