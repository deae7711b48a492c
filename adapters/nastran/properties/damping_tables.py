"""Modal damping that case control selects: SDAMPING and TABDMP1."""

import numpy as np

from ....core.arrays import Floats
from ....core.errors import Place
from ..deck.card_definition import Card
from ..deck.read_deck import Deck
from .thermal import interpolated, read_points

CARDS = (Card("TABDMP1", "TID:i! TYPE:w=G", "tid", more=read_points, extra="x y"),)

_RATIO = {"G": lambda g: g / 2.0, "CRIT": lambda g: g, "Q": lambda g: 0.5 / g}
"""Fraction of critical of what a table holds, by its TYPE."""


def selected_ratios(deck: Deck, frequencies_hz: Floats) -> Floats | None:
    """Return the fractions of critical that the selected table gives; None where none is.

    Between points and beyond the ends linear, as in Nastran; nowhere below 0.

    Raises
    ------
    InputError
        A table that does not exist or is of no known TYPE.
    """
    number = deck.case.sdamping
    if number is None:
        return None
    table = deck.bulk.table("TABDMP1").get(number)
    if table is None:
        raise Place(deck.path).error(f"SDAMPING selects TABDMP1 {number}, which is not in the deck")
    if table.type not in _RATIO:
        known = ", ".join(_RATIO)
        raise deck.bulk.place("TABDMP1", number).fault(f"is of type {table.type}, none of {known}")
    values = np.array([interpolated(table, f) for f in frequencies_hz.tolist()])
    floor = np.finfo(float).tiny if table.type == "Q" else 0.0
    return np.asarray(_RATIO[table.type](np.maximum(values, floor)))
