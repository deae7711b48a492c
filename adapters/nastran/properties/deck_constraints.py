"""Constraints of a deck: SPC, permanent constraints, MPC and rigid elements."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from ....core.errors import Place
from ..deck.card_definition import Card, Values
from ..deck.read_deck import Deck
from .grids import Points
from .rigid_elements import RIGID, Rows

if TYPE_CHECKING:
    from ....core.assembly.multipoint_constraints import Equations

_TERM = "G>nodes:i! C>components:c=0"

CARDS = (
    Card("SPC", f"SID:i! [{_TERM} D>enforced:r=0.]"),
    Card("SPC1", "SID:i! C>components:c=0 G>nodes:*"),
    Card("MPC", f"SID:i! [{_TERM} A>coefficients:r=0. {_TERM} A>coefficients:r=0. - -]"),
    *(Card(name, "SID:i! [S>sets:i]") for name in ("SPCADD", "MPCADD")),
)
_NAMED = 5


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
        Sets that case control asks for and the deck does not have, and those of a deck of which
        case control selects none.
    """

    equations: Equations
    fixed: Any
    notes: tuple[str, ...] = ()


def read_constraints(deck: Deck, points: Points) -> Constraints:
    """Collect the constraints that the case control section selects, and the rigid elements.

    A set that does not exist constrains nothing and is noted, as in Nastran (its warning 2053).

    Raises
    ------
    InputError
        A grid or component that does not exist; an equation without its first coefficient.
    """
    notes = list(_unselected(deck))
    fixed = np.zeros(points.n_dof, dtype=bool)
    fixed[: points.permanent.size] = points.permanent.reshape(-1)
    if deck.case.spc is not None:
        for card, place in _selected(deck, deck.case.spc, ("SPC", "SPC1"), notes):
            fixed[list(points.named(card, place))] = True
    rows = Rows(points)
    for name, make in RIGID.items():
        for number, card in deck.bulk.table(name).items():
            make(rows, card, deck.bulk.place(name, number))
    if deck.case.mpc is not None:
        for card, place in _selected(deck, deck.case.mpc, ("MPC",), notes):
            _add_mpc(rows, card, place)
    return Constraints(_equations(rows, points.n_dof), fixed, tuple(notes))


def _unselected(deck: Deck) -> Iterator[str]:
    for kind, names, chosen in (
        ("SPC", ("SPC", "SPC1"), deck.case.spc),
        ("MPC", ("MPC",), deck.case.mpc),
    ):
        sets = sorted({card.sid for name in names for card in deck.bulk.listed(name)})
        if sets and chosen is None:
            shown = ", ".join(map(str, sets[:_NAMED])) + ", ..." * (len(sets) > _NAMED)
            yield (
                f"{deck.path}: case control selects no {kind}: nothing is constrained by those of "
                f"the deck (SID {shown})"
            )


def _selected(
    deck: Deck, number: int, names: tuple[str, ...], notes: list[str]
) -> Iterator[tuple[Values, Place]]:
    """Cards of a set, sets added together resolved; what is missing goes to `notes`.

    SPCADD and MPCADD stand for the cards of their own number, which superelements join.
    """
    kind, joined = names[0], bool(deck.parts or deck.case.of_parts)
    wanted = {
        s: f"{place} adds set {s}"
        for card, place in deck.bulk.placed(f"{kind}ADD")
        if card.sid == number
        for s in card.sets
    }
    found = {number} if wanted else set()
    if joined or not wanted:
        wanted.setdefault(number, f"{deck.path}: case control asks for {kind} = {number}")
    for name in names:
        for card, place in deck.bulk.placed(name):
            if card.sid in wanted:
                found.add(card.sid)
                yield card, place
            elif card.sid == number:
                notes.append(f"{place} is not used: {kind}ADD {number} takes its place")
    notes.extend(
        f"{asked}, but the deck has no {kind} cards of that set: nothing is constrained by it"
        for missing, asked in wanted.items()
        if missing not in found
    )


def _add_mpc(rows: Rows, card: Values, place: Place) -> None:
    dofs = [
        rows.points.dof(grid, int(component), place)
        for grid, component in zip(card.nodes, card.components, strict=True)
    ]
    coefficients = np.array(card.coefficients)
    if coefficients[0] == 0.0:
        raise place.error("the first coefficient of an MPC must not be zero")
    rows.add(dofs[0], dofs[1:], -coefficients[1:] / coefficients[0], place, least=0.0)


def _equations(rows: Rows, n_dof: int) -> Equations:
    import scipy.sparse as sp  # slow to import, and not needed to read a deck

    from ....core.assembly.multipoint_constraints import Equations

    matrix = sp.coo_matrix(
        (
            np.array(rows.values, dtype=np.float64),
            (np.array(rows.rows, dtype=np.int64), np.array(rows.columns, dtype=np.int64)),
        ),
        shape=(len(rows.dependent), n_dof),
    ).tocsr()
    matrix.eliminate_zeros()
    return Equations(np.array(rows.dependent, dtype=np.int64), matrix, tuple(rows.owners))
