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
    """

    equations: Equations
    fixed: Any


class _Set(NamedTuple):
    """Cards of one kind that a set number selects, with where they stand."""

    card: Card
    place: str
    range: bool  # with THRU: grids missing in the range are passed over, as in Nastran


def read_constraints(deck: Deck, points: Points) -> Constraints:
    """Collect the constraints that the case control section selects, and the rigid elements.

    Raises
    ------
    InputError
        A set, grid or component that does not exist; an equation without its first coefficient.
    """
    fixed = np.zeros(points.n_dof, dtype=bool)
    fixed[: points.permanent.size] = points.permanent.reshape(-1)
    if deck.case.spc is not None:
        for name, item in _selected(deck, deck.case.spc, "SPCADD", ("SPC", "SPC1")):
            for dof in _spc_dofs(name, item, points):
                fixed[dof] = True
    rows = Rows(points)
    for name, make in RIGID.items():
        for number, card in deck.bulk.table(name).items():
            make(rows, card, deck.bulk.place(name, number))
    if deck.case.mpc is not None:
        for _, item in _selected(deck, deck.case.mpc, "MPCADD", ("MPC",)):
            _add_mpc(rows, item, points)
    return Constraints(_equations(rows, points.n_dof), fixed)


def _selected(
    deck: Deck, number: int, adder: str, names: tuple[str, ...]
) -> Iterator[tuple[str, _Set]]:
    """Cards of a set, sets added together resolved."""
    numbers = [number]
    for card in deck.bulk.listed(adder):
        if int(card.conid) == number:
            numbers.extend(int(s) for s in card.sets)
    found = False
    for name in names:
        for k, card in enumerate(deck.bulk.listed(name)):
            if int(card.conid) in numbers:
                found = True
                raw = deck.bulk.raw[name][k]
                thru = any("THRU" in line.upper() for line in raw.lines)
                yield name, _Set(card, f"{name} ({deck.bulk.at(raw)})", thru)
    if not found:
        kind = adder[:3]
        raise InputError(
            f"{deck.path}: case control asks for {kind} = {number}, but the deck has no {kind} "
            "cards of that set"
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
