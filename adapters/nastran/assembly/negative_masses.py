"""Cards to blame for a mass that is negative."""

from collections.abc import Iterator

import numpy as np

from ....core.arrays import Floats, Ints
from ....core.errors import Place
from ..deck.read_deck import Deck
from ..properties.grids import Points

_ATTRIBUTES = ("m", "mass", "rho", "nsm")
_ROUNDING = 1e-9
_NAMED = 3


def refuse_negative_masses(deck: Deck, points: Points, dofs: Ints, diagonal: Floats) -> None:
    """Name the cards of negative mass where they leave a direction negative by more than rounding.

    Parameters
    ----------
    dofs : (n,) int
        Degrees of freedom of the g-set.
    diagonal : (n,) float
        Their masses.

    Raises
    ------
    InputError
        The first of the cards: file and line.
    """
    row = int(np.argmin(diagonal))
    if diagonal[row] >= -_ROUNDING * diagonal.max() or not (every := list(_negative(deck))):
        return
    also = "".join(f", {p.card}" for p in every[1:_NAMED])
    raise every[0].error(
        f"its mass or density is negative{f' (also{also[1:]})' * bool(also)}, and leaves "
        f"{diagonal[row]:g} at {points.label(int(dofs[row]))}"
    )


def _negative(deck: Deck) -> Iterator[Place]:
    for name, cards in deck.bulk.tables.items():
        for number, card in cards.items():
            given = (getattr(card, a, 0.0) for a in _ATTRIBUTES)
            if any(isinstance(v, float) and v < 0.0 for v in given):
                yield deck.bulk.place(name, number)
