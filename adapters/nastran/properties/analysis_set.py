"""The analysis set: ASET, ASET1, OMIT, OMIT1."""

from typing import Any

import numpy as np

from ....core.errors import Place
from ..deck.card_definition import Card
from ..deck.read_deck import Deck
from .grids import Points

CARDS = (
    *(Card(name, "[G>nodes:i! C>components:c=0]") for name in ("ASET", "OMIT", "SUPORT")),
    *(Card(name, "C>components:c=0 G>nodes:*") for name in ("ASET1", "OMIT1")),
    Card("SUPORT1", "SID:i! [G>nodes:i! C>components:c=0]"),
)


def read_analysis_set(deck: Deck, points: Points) -> Any:
    """Return which of the g-set stay after static condensation, (n_dof,) bool; None: all.

    With ASET everything else is omitted, with OMIT alone everything else stays.

    Raises
    ------
    InputError
        Grids or components that do not exist, a degree of freedom in both sets.
    """
    masks = {}
    for name in ("ASET", "OMIT"):
        mask = np.zeros(points.n_dof, dtype=bool)
        for kind in (name, f"{name}1"):
            for card, place in deck.bulk.placed(kind):
                mask[list(points.named(card, place))] = True
        masks[name] = mask
    both = np.flatnonzero(masks["ASET"] & masks["OMIT"])
    if len(both):
        raise Place(deck.path).error(
            f"{points.label(both[0])} (grid:component) is in ASET and in OMIT"
        )
    if masks["ASET"].any():
        return masks["ASET"]
    return ~masks["OMIT"] if masks["OMIT"].any() else None
