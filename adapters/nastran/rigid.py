"""Rigid elements as equations: RBE2; one routine a card, in one table."""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np

from ...core.arrays import Floats
from ...core.elements.batch import skew
from ...core.errors import InputError
from .cards import Card
from .grids import Points


class Rows:
    """Equations collected one by one; each gives one dependent degree of freedom.

    Parameters
    ----------
    points : Points
        Grids, whose displacement systems the components refer to.
    """

    def __init__(self, points: Points) -> None:
        self.points = points
        self.dependent: list[int] = []
        self.owners: list[str] = []
        self.rows: list[int] = []
        self.columns: list[int] = []
        self.values: list[float] = []

    def add(self, dependent: int, columns: Sequence[int], values: Floats, owner: str) -> None:
        """Add ``u[dependent] = sum(values * u[columns])``."""
        row = len(self.dependent)
        self.dependent.append(int(dependent))
        self.owners.append(owner)
        self.rows.extend([row] * len(columns))
        self.columns.extend(int(c) for c in columns)
        self.values.extend(float(v) for v in values)

    def motion(self, row: int, origin: Floats) -> Floats:
        """Displacements (6) of grid `row`, its system, from rigid motion about `origin`, (6, 6)."""
        R = self.points.directions[row]
        arm = self.points.xyz[row] - origin
        out = np.zeros((6, 6))
        out[:3, :3] = R
        out[:3, 3:] = -R @ skew(arm[None])[0]
        out[3:, 3:] = R
        return out


def components_of(digits: object, place: str) -> list[int]:
    """Component numbers 1..6 from digits such as 1235.

    Raises
    ------
    InputError
        Anything else.
    """
    text = str(digits or "").strip()
    if any(d not in "123456" for d in text):
        raise InputError(f"{place}: components {text!r} are not digits from 1 to 6")
    return sorted(int(d) for d in set(text))


def rbe2(rows: Rows, card: Card, place: str) -> None:
    """Components CM of the grids GMi follow the rigid motion of GN."""
    points = rows.points
    centre = points.row(int(card.gn), place)
    components = components_of(card.cm, place)
    independent = rows.motion(centre, points.xyz[centre])
    inverse = independent.T  # a rotation of translations and of rotations
    for grid in card.Gmi:
        row = points.row(int(grid), place)
        if row == centre:
            raise InputError(f"{place}: grid {grid} is both the independent and a dependent grid")
        T = rows.motion(row, points.xyz[centre]) @ inverse
        for c in components:
            values = T[c - 1]
            used = np.flatnonzero(np.abs(values) > 1e-14 * max(1.0, float(np.abs(values).max())))
            rows.add(6 * row + c - 1, (6 * centre + used).tolist(), values[used], place)


RIGID: dict[str, Callable[[Rows, Card, str], None]] = {"RBE2": rbe2}
"""Rigid elements by card name."""
