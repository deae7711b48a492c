"""Where the nodes are and how they are connected for drawing."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np

from ..arrays import Floats, Ints, frozen, hold, require_finite
from ..errors import InputError, require_kind
from ..noun import Noun


@dataclass(frozen=True, eq=False)
class Geometry(Noun):
    """Node ids, positions and elements of an analysis or a test model.

    Parameters
    ----------
    ids : (n_node,) int
        Node numbers as in the file, unique, in any order.
    xyz : (n_node, 3) float
        Positions in the basic frame, in `length_unit`.
    length_unit : {"m", "mm", "in", "ft"} or None
        None where the source does not say.
    elements : mapping of str to (n_element, n_corner) int
        Corner node *indices* (rows of `xyz`) by shape: ``point``, ``line``, ``tria``, ``quad``,
        ``tetra``, ``pyramid``, ``penta``, ``hexa``. For drawing and for finding the element a
        sensor lies on.
    element_ids : mapping of str to (n_element,) int
        Element numbers as in the file, same keys and order as `elements`.

    Raises
    ------
    InputError
        Shapes that disagree, positions that are not finite, ids used twice.
    """

    ids: Ints
    xyz: Floats
    length_unit: str | None = None
    elements: dict[str, Ints] = field(default_factory=dict)
    element_ids: dict[str, Ints] = field(default_factory=dict)

    def __post_init__(self) -> None:
        hold(self, "ids", np.int64, ("n",))
        hold(self, "xyz", np.float64, (len(self.ids), 3), "positions")
        require_finite(self.xyz, "positions")
        unique, counts = np.unique(self.ids, return_counts=True)
        if len(unique) < len(self.ids):
            raise InputError(f"node {unique[counts > 1][0]} is defined twice")
        for name in ("elements", "element_ids"):
            said, given = f"{name} of Geometry", getattr(self, name)
            require_kind(given, Mapping, said)
            tables = {k: frozen(v, np.int64, said) for k, v in given.items()}
            object.__setattr__(self, name, tables)

    def index_of(self, ids: Ints) -> Ints:
        """Rows of the given node ids, (n,); -1 where a node does not exist."""
        order = np.argsort(self.ids, kind="stable")
        found = np.searchsorted(self.ids, ids, sorter=order)
        found = np.minimum(found, len(self.ids) - 1)
        rows = order[found] if len(order) else np.zeros(len(ids), np.int64)
        return np.where(self.ids[rows] == ids, rows, -1) if len(order) else rows - 1

    @property
    def size(self) -> float:
        """Largest dimension: the diagonal of the bounding box, in the length unit."""
        return float(np.linalg.norm(np.ptp(self.xyz, axis=0))) if len(self.xyz) else 0.0
