"""The tuned numbers of a structure's symmetry: when an image counts as one."""

from dataclasses import dataclass

from ...number_table import ROUNDING, number

SIZE = "of the structure's size"


@dataclass(frozen=True)
class SymmetryNumbers:
    image_off: float = number(0.01, SIZE, "how far the image of a grid may lie from the grid that it is", "meshes and parts that are not quite symmetric")
    image_share: float = number(0.9, "of the grids", "that have an image, of a structure that is its own")
    image_round: float = number(0.02, "of the largest extent", "by which principal extents differ that are not the same")
    image_skew: float = number(1e-6, "-", "cosine below which planes are perpendicular", ROUNDING)
    rings: tuple[int, ...] = number((2, 3, 4, 6, 8), "places", "alike about an axis that are looked at")
    twins_apart: float = number(0.05, SIZE, "that places alike are from each other, at least", "nearer ones are one")


SYMMETRY = SymmetryNumbers()
