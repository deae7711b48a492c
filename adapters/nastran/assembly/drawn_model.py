"""Grids and connectivity of a deck whose matrices are not needed, or not known."""

from __future__ import annotations

import numpy as np

from ....core.arrays import Ints
from ....core.data.geometry import Geometry
from ....core.data.parametric_model import Model
from ..deck.read_deck import Deck
from ..properties.grids import Points, point_dofs, read_points, to_basic


def drawn_model(deck: Deck) -> Model:
    """Return a deck as a model without matrices: every degree of freedom of the g-set is free.

    Elements that name grids which do not exist are not drawn; properties, materials, constraints
    and cards that are not known do not matter.

    Raises
    ------
    InputError
        Grids or coordinate systems at fault.
    """
    points = read_points(deck.bulk)
    dofs = point_dofs(points.ids, points.scalar_ids)
    return Model(drawn_geometry(deck, points), dofs, to_basic(points), (), ())


def drawn_geometry(deck: Deck, points: Points) -> Geometry:
    """Return the grids, and the elements that stand on grids that exist."""
    corners: dict[str, list[Ints]] = {}
    ids: dict[str, list[Ints]] = {}
    for name, card in deck.bulk.definitions.items():
        shape = card.element.shape if card.element else None
        if shape is None or not card.number:
            continue
        used = {
            number: held
            for number, values in deck.bulk.table(name).items()
            if len(held := card.grids_of(values)[: shape.corners]) == shape.corners
        }
        if not used:
            continue
        grids = np.array([*used.values()], dtype=np.int64)
        rows = np.minimum(np.searchsorted(points.ids, grids), max(len(points.ids) - 1, 0))
        there = (points.ids[rows] == grids).all(axis=1)
        corners.setdefault(shape.name, []).append(rows[there])
        ids.setdefault(shape.name, []).append(np.array([*used], dtype=np.int64)[there])
    return Geometry(
        points.ids,
        points.xyz,
        deck.length_unit,
        {k: np.concatenate(v) for k, v in corners.items()},
        {k: np.concatenate(v) for k, v in ids.items()},
    )
