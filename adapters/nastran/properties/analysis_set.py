"""The analysis set: ASET, ASET1, OMIT, OMIT1."""

from __future__ import annotations

from typing import Any

import numpy as np

from ...core.errors import InputError
from .cards import Fields
from .grids import Points
from .read import Deck


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
            for k, fields in enumerate(deck.bulk.listed(kind)):
                place = deck.bulk.place_listed(kind, k)
                for dof in _dofs(kind, fields, points, place):
                    mask[dof] = True
        masks[name] = mask
    both = np.flatnonzero(masks["ASET"] & masks["OMIT"])
    if len(both):
        raise InputError(
            f"{deck.path}: {points.label(both[0])} (grid:component) is in ASET and in OMIT"
        )
    if masks["ASET"].any():
        return masks["ASET"]
    return ~masks["OMIT"] if masks["OMIT"].any() else None


def _dofs(kind: str, fields: Fields, points: Points, place: str) -> list[int]:
    try:
        if kind.endswith("1"):
            digits = str(fields[1] or "0")
            words = [str(f).upper() for f in fields[2:] if f is not None]
            grids = _range(words, points)
            return [points.dof(g, int(d), place) for g in grids for d in digits]
        pairs = zip(fields[1::2], [*fields[2::2], None], strict=False)
        return [
            points.dof(int(str(grid)), int(d), place)
            for grid, digits in pairs
            if grid is not None
            for d in str(digits or "0")
        ]
    except ValueError:
        raise InputError(f"{place}: a grid or its components are not numbers") from None


def _range(words: list[str], points: Points) -> list[int]:
    if "THRU" in words:
        low, high = int(words[0]), int(words[-1])
        every = np.concatenate([points.ids, points.scalar_ids])
        return [int(g) for g in every if low <= g <= high]
    return [int(w) for w in words]
