"""Coordinate systems of a deck (CORD1R ... CORD2S), chains resolved to the basic frame."""

from collections.abc import Callable

import numpy as np

from ....core.arrays import Floats
from ....core.data.coordinate_systems import BASIC, Frame, frame_of_points
from ....core.errors import InputError, Place
from ..deck.bulk import Bulk
from ..deck.card_definition import Card, Values

KIND_OF = {"R": "rectangular", "C": "cylindrical", "S": "spherical"}
_TWO = "CID:i! RID:i=0 A1,A2,A3>points:r=0. B1,B2,B3>points:r=0. C1,C2,C3>points:r=0."
_ONE = "CID:i! G1,G2,G3>nodes:i!"
_SPACE = "coordinate system"

CARDS = (
    *(Card(f"CORD2{kind}", _TWO, "cid", space=_SPACE) for kind in KIND_OF),
    *(Card(f"CORD1{kind}", _ONE, "cid", several=4, space=_SPACE) for kind in KIND_OF),
)


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
        self._open: list[Place] = []

    def get(self, number: int, asked_by: Place) -> Frame:
        """Return coordinate system `number`.

        Raises
        ------
        InputError
            No such system, systems defined by each other, points in a line.
        """
        if number in self._known:
            return self._known[number]
        found = self._bulk.find([c.name for c in CARDS], number)
        if found is None:
            raise asked_by.fault(f"refers to coordinate system {number}, which does not exist")
        name, card = found
        place = self._bulk.place(name, number)
        if place in self._open:
            raise place.fault(f"is defined by itself, through {' and '.join(map(str, self._open))}")
        self._open.append(place)
        if name[4] == "2":
            points = self.get(card.rid, place).positions(np.reshape(card.points, (3, 3)))
        else:
            points = self._at_grids(card, place)
        try:
            frame = frame_of_points(KIND_OF[name[5]], *points)
        except InputError as error:
            raise place.error(str(error)) from None
        self._open.pop()
        self._known[number] = frame
        return frame

    def _at_grids(self, card: Values, place: Place) -> Floats:
        points = []
        for grid in card.nodes:
            found = self._grid_system(grid)
            if found is None:
                raise place.fault(f"refers to grid {grid}, which does not exist")
            system, coordinates = found
            points.append(self.get(system, place).positions(coordinates)[0])
        return np.array(points)
