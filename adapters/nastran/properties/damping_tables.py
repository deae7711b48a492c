"""Modal damping that case control selects: SDAMPING and TABDMP1."""

from dataclasses import dataclass

import numpy as np

from ....core.arrays import Floats
from ....core.errors import Place
from ..deck.card_definition import Card
from ..deck.read_deck import Deck
from .thermal import interpolated, read_points

CARDS = (Card("TABDMP1", "TID:i! TYPE:w=G", "tid", more=read_points, extra="x y"),)

_RATIO = {"G": lambda g: g / 2.0, "CRIT": lambda g: g, "Q": lambda g: 0.5 / g}
"""Fraction of critical of what a table holds, by its TYPE."""


@dataclass(frozen=True)
class TableOfRatios:
    """Damping by frequency, as a table of a type says it: points x [Hz], y.

    Between points and beyond the ends linear, as in Nastran; nowhere below 0.
    """

    type: str
    x: tuple[float, ...]
    y: tuple[float, ...]

    def __call__(self, frequencies_hz: Floats) -> Floats:
        """Return fractions of critical, (n,)."""
        values = np.array([interpolated(self, f) for f in frequencies_hz.tolist()])
        floor = np.finfo(float).tiny if self.type == "Q" else 0.0
        return np.asarray(_RATIO[self.type](np.maximum(values, floor)))


def selected_ratios(deck: Deck) -> TableOfRatios | None:
    """Return the fractions of critical that the selected table gives; None where none is.

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
    return TableOfRatios(table.type, table.x, table.y)
