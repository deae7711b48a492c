"""Coordinate systems of a deck (CORD1R ... CORD2S), chains resolved to the basic frame."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from ...core.arrays import Floats
from ...core.errors import InputError
from ...core.frames import BASIC, Frame, frame_of_points
from .cards import Bulk, Card

KIND_OF = {"R": "rectangular", "C": "cylindrical", "S": "spherical"}
CARDS = ("CORD2R", "CORD2C", "CORD2S", "CORD1R", "CORD1C", "CORD1S")


class Frames:
    """Coordinate systems by number; made when first asked for, because they refer to each other.

    Parameters
    ----------
    bulk : Bulk
        The deck's cards.
    grid_system : callable
        Gives a grid's CP (GRDSET applied) and coordinates: what CORD1x need.
    """

    def __init__(self, bulk: Bulk, grid_system: Callable[[int], tuple[int, Floats] | None]) -> None:
        self._bulk = bulk
        self._grid_system = grid_system
        self._known: dict[int, Frame] = {0: BASIC}
        self._open: list[str] = []

    def get(self, number: int, asked_by: str) -> Frame:
        """Return coordinate system `number`.

        Raises
        ------
        InputError
            No such system, systems defined by each other, points in a line.
        """
        if number in self._known:
            return self._known[number]
        found = self._bulk.find(CARDS, number)
        if found is None:
            raise InputError(
                f"{asked_by} refers to coordinate system {number}, which does not exist"
            )
        name, card = found
        place = self._bulk.place(name, number)
        if place in self._open:
            raise InputError(f"{place} is defined by itself, through {' and '.join(self._open)}")
        self._open.append(place)
        points = self._two(card, place) if name[4] == "2" else self._one(card, place)
        try:
            frame = frame_of_points(KIND_OF[name[5]], *points)
        except InputError as error:
            raise InputError(f"{place}: {error}") from None
        self._open.pop()
        self._known[number] = frame
        return frame

    def _two(self, card: Card, place: str) -> Floats:
        parent = self.get(int(card.rid), place)
        return parent.positions(np.array([card.e1, card.e2, card.e3], dtype=np.float64))

    def _one(self, card: Card, place: str) -> list[Floats]:
        points = []
        for grid in (card.g1, card.g2, card.g3):
            found = self._grid_system(int(grid))
            if found is None:
                raise InputError(f"{place} refers to grid {grid}, which does not exist")
            system, coordinates = found
            points.append(self.get(system, place).positions(coordinates)[0])
        return points
