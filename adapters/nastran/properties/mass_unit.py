"""What a deck counts masses in, as far as its densities tell."""

import numpy as np

from ....core.data.length_units import METRES
from ....core.data.mass_unit import MassUnit
from ..deck.read_deck import Deck

_KILOGRAMS = {
    "m": (1.0, 1e3),
    "mm": (1e3, 1.0),
    "in": (175.12683699, 0.45359237),
    "ft": (14.59390294, 0.45359237),
}
"""Kilograms in the mass units that go with a length: t or kg, lbf s²/in or lb, slug or lb."""
_FORCES = {
    ("m", 1.0): "N",
    ("mm", 1e3): "N",
    ("mm", 1.0): "mN",
    ("in", 175.12683699): "lbf",
    ("ft", 14.59390294): "lbf",
}
"""The force that goes with a length, a mass and seconds."""
_SOLID = (4e2, 2.5e4)
"""Densities of what structures are made of [kg/m³]: balsa panels and below are left out."""


def densest(deck: Deck) -> float:
    """Return the largest density of what a deck is made of, as in its mass matrix; 0 if unknown."""
    return max(_densities(deck), default=0.0)


def mass_unit(deck: Deck, length_unit: str | None) -> MassUnit:
    """Return what masses are counted in, in kilograms where the densities leave no doubt.

    Parameters
    ----------
    deck : Deck
    length_unit : {"m", "mm", "in", "ft"} or None
    """
    wtmass = deck.param("WTMASS", 1.0)
    rho = _densities(deck)
    if length_unit is None or not rho:
        return MassUnit(1.0 / wtmass)
    volume = METRES[length_unit] ** 3
    likely = [
        kg for kg in _KILOGRAMS[length_unit] if _SOLID[0] < np.median(rho) * kg / volume < _SOLID[1]
    ]
    if len(likely) != 1:
        return MassUnit(1.0 / wtmass)
    force = _FORCES.get((length_unit, likely[0]))
    return MassUnit(1.0 / wtmass, likely[0], f"{force}/{length_unit}" if force else "")


def _densities(deck: Deck) -> list[float]:
    wtmass = deck.param("WTMASS", 1.0)
    return [c.rho * wtmass for c in deck.bulk.table("MAT1").values() if c.rho > 0.0]
