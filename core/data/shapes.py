"""The shapes of elements: what is drawn, and what a sensor can lie on."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class Shape:
    """Corners of an element and how they are joined.

    Parameters
    ----------
    name : str
        Key of `Geometry.elements`.
    dimension : {0, 1, 2, 3}
        Of a point, a line, a surface, a solid.
    corners : int
        How many.
    faces : tuple of tuple of int
        Corners of the faces of a solid, in turn, seen from outside counter-clockwise.
    """

    name: str
    dimension: int
    corners: int
    faces: tuple[tuple[int, ...], ...] = ()

    @property
    def sides(self) -> tuple[tuple[int, int], ...]:
        """Ends of the sides of a surface, in turn."""
        return tuple((k, (k + 1) % self.corners) for k in range(self.corners))


POINT = Shape("point", 0, 1)
LINE = Shape("line", 1, 2)
TRIA = Shape("tria", 2, 3)
QUAD = Shape("quad", 2, 4)
TETRA = Shape("tetra", 3, 4, ((0, 2, 1), (0, 1, 3), (1, 2, 3), (0, 3, 2)))
PYRAMID = Shape("pyramid", 3, 5, ((0, 3, 2, 1), (0, 1, 4), (1, 2, 4), (2, 3, 4), (3, 0, 4)))
PENTA = Shape("penta", 3, 6, ((0, 2, 1), (3, 4, 5), (0, 1, 4, 3), (1, 2, 5, 4), (2, 0, 3, 5)))
_SIDES = ((0, 1, 5, 4), (1, 2, 6, 5), (2, 3, 7, 6), (3, 0, 4, 7))
HEXA = Shape("hexa", 3, 8, ((0, 3, 2, 1), (4, 5, 6, 7), *_SIDES))

SHAPES = {s.name: s for s in (POINT, LINE, TRIA, QUAD, TETRA, PYRAMID, PENTA, HEXA)}
"""All shapes by name."""
