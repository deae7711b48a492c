"""Grid and scalar points: positions, displacement systems, numbering of the g-set."""

from collections.abc import Iterable, Iterator
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
import scipy.sparse as sp

from ....core.arrays import Floats, Ints, skew
from ....core.data.dofs import Dofs
from ....core.errors import Place
from ....core.noun import Noun
from ..deck.bulk import Bulk
from ..deck.card_definition import Card, Values
from ..deck.movable_values import Moves
from .deck_coordinate_systems import Frames

CARDS = (
    Card(
        "GRID",
        "ID:i! CP:i=0 X1,X2,X3>xyz:r=0. CD:i=0 PS:c SEID:i=0",
        "id",
        blanks_from="GRDSET",
        moves=Moves(),
    ),
    Card("GRDSET", "- CP:i=0 - - - CD:i=0 PS:c SEID:i=0"),
    Card("SPOINT", "ID>nodes:*"),
    Card("EPOINT", "ID>nodes:*", ignored="it belongs to response analyses"),
)


@dataclass(frozen=True, eq=False)
class Points(Noun):
    """Grids and scalar points of a deck, and the numbering of their degrees of freedom.

    Grid row i has degrees of freedom 6i ... 6i+5 in its displacement system (CD); scalar point k
    follows at ``6 * n_grid + k``.

    Parameters
    ----------
    bulk : Bulk
        The deck's cards, for messages.
    ids : (n_grid,) int
        Increasing.
    xyz : (n_grid, 3) float
        Basic frame.
    rotated : (n_grid,) bool
        Whether the displacement system differs from the basic one at this grid.
    directions : (n_grid, 3, 3) float
        Rows are the displacement directions in the basic frame.
    permanent : (n_grid, 6) bool
        Degrees of freedom constrained on the GRID card (PS).
    scalar_ids : (n_scalar,) int
        Increasing.
    frames : Frames
        Coordinate systems, for cards that refer to them.
    """

    bulk: Bulk
    ids: Ints
    xyz: Floats
    rotated: Any
    directions: Floats
    permanent: Any
    scalar_ids: Ints
    frames: Frames

    @property
    def n_dof(self) -> int:
        """Size of the g-set."""
        return 6 * len(self.ids) + len(self.scalar_ids)

    def rows(self, ids: Any, name: str, owners: Any) -> Ints:
        """Rows of grids, any shape.

        Parameters
        ----------
        ids : array of int
            Grid numbers.
        name : str
            Card that asks, for the message.
        owners : array of int
            Number of the card that asks, same first dimension as `ids`.

        Raises
        ------
        InputError
            A grid that does not exist: the card, its file and line.
        """
        ids = np.asarray(ids, dtype=np.int64)
        found = np.minimum(np.searchsorted(self.ids, ids), max(len(self.ids) - 1, 0))
        missing = (self.ids[found] != ids) if len(self.ids) else np.ones(ids.shape, bool)
        if missing.any():
            where = np.argwhere(missing)[0]
            owner = int(np.asarray(owners).reshape(-1)[where[0]]) if ids.ndim else int(owners)
            bad = int(ids[tuple(where)])
            what = "is a scalar point" if bad in self.scalar_ids else "does not exist"
            raise self.bulk.place(name, owner).fault(f"refers to grid {bad}, which {what}")
        return np.asarray(found, dtype=np.int64)

    def dof(self, point: int, component: int, place: Place) -> int:
        """Return the g-set number of one component of a grid (1..6) or scalar point (0 or 1)."""
        k = int(np.searchsorted(self.ids, point))
        if k < len(self.ids) and self.ids[k] == point:
            if not 1 <= component <= 6:
                raise place.error(f"component {component} of grid {point} must be 1 to 6")
            return 6 * k + component - 1
        k = int(np.searchsorted(self.scalar_ids, point))
        if k < len(self.scalar_ids) and self.scalar_ids[k] == point:
            if component > 1:
                raise place.error(f"scalar point {point} has no component {component}")
            return 6 * len(self.ids) + k
        raise place.fault(f"refers to grid {point}, which does not exist")

    def listed(self, parts: Iterable[int | range]) -> Iterator[int]:
        """Grids and scalar points of a list; those of a range only where they exist."""
        for part in parts:
            if isinstance(part, int):
                yield part
                continue
            for ids in (self.ids, self.scalar_ids):
                within = ids[(ids >= part.start) & (ids < part.stop)]
                yield from (int(k) for k in within if k in part)

    def named(self, card: Values, place: Place) -> Iterator[int]:
        """Yield the degrees of freedom that a card names: pairs, or components of many grids."""
        pairs = zip(card.nodes, card.components, strict=True)
        if isinstance(card.components, str):
            pairs = ((grid, card.components) for grid in self.listed(card.nodes))  # type: ignore[assignment]
        for grid, digits in pairs:
            for component in digits:
                yield self.dof(grid, int(component), place)

    def row(self, grid: int, place: Place) -> int:
        """Return the row of one grid."""
        k = int(np.searchsorted(self.ids, grid))
        if k == len(self.ids) or self.ids[k] != grid:
            raise place.fault(f"refers to grid {grid}, which does not exist")
        return k

    def motions(self, rows: Ints | slice, origin: Floats) -> Floats:
        """Displacements of grids, their systems, from rigid motions about a point, (n, 6, 6)."""
        R = self.directions[rows]
        out = np.zeros((len(R), 6, 6))
        out[:, :3, :3] = out[:, 3:, 3:] = R
        out[:, :3, 3:] = -R @ skew(self.xyz[rows] - origin)
        return out

    def label(self, dof: int) -> str:
        """``grid:component`` of a degree of freedom of the g-set."""
        grid, component = divmod(int(dof), 6)
        if grid < len(self.ids):
            return f"{self.ids[grid]}:{component + 1}"
        return f"{self.scalar_ids[dof - 6 * len(self.ids)]}:0"


def point_dofs(ids: Ints, scalar_ids: Ints) -> Dofs:
    """Return six degrees of freedom a grid, then one a scalar point."""
    component = np.concatenate([np.tile(np.arange(1, 7), len(ids)), np.ones(len(scalar_ids), int)])
    return Dofs(np.concatenate([np.repeat(ids, 6), scalar_ids]), component)


def to_basic(points: Points) -> sp.csr_matrix:
    """Return basic displacements from those in the displacement systems."""
    n = points.n_dof
    turned = np.flatnonzero(points.rotated)
    diagonal = np.ones(n)
    start = (6 * turned[:, None] + np.array([0, 3])).reshape(-1)
    triples = start[:, None] + np.arange(3)
    diagonal[triples] = 0.0
    R = np.repeat(points.directions[turned], 2, axis=0)
    rows = np.repeat(triples, 3, axis=1).reshape(-1)
    columns = np.tile(triples, (1, 3)).reshape(-1)
    values = R.swapaxes(1, 2).reshape(-1)
    return (sp.diags(diagonal) + sp.coo_matrix((values, (rows, columns)), shape=(n, n))).tocsr()


def read_points(bulk: Bulk) -> Points:
    """Place all grids and scalar points of a deck.

    Raises
    ------
    InputError
        No grids at all, or one whose number is not positive; no such coordinate system.
    """
    table = bulk.table("GRID")
    cards = [table[k] for k in sorted(table)]
    scalar = _scalar_ids(bulk)
    if not cards and not len(scalar):
        raise Place(bulk.files[0]).error("the deck has no GRID")
    ids = np.array([c.id for c in cards], dtype=np.int64)
    if len(ids) and ids[0] < 1:
        raise bulk.place("GRID", int(ids[0])).error("the number of a grid must be 1 or more")
    both = np.intersect1d(ids, scalar)
    if len(both):
        raise bulk.place("GRID", int(both[0])).fault("is a scalar point (SPOINT) as well")
    cp, cd = (np.array([c[k] for c in cards], dtype=np.int64) for k in (1, 3))
    given = np.array([c.xyz for c in cards], dtype=np.float64).reshape(-1, 3)
    index = {int(k): i for i, k in enumerate(ids)}

    def grid_system(grid: int) -> tuple[int, Floats] | None:
        i = index.get(grid)
        return None if i is None else (int(cp[i]), given[i : i + 1])

    frames = Frames(bulk, grid_system)
    xyz = _positions(bulk, ids, given, cp, frames)
    rotated, directions = _directions(bulk, ids, xyz, cd, frames)
    permanent = np.zeros((len(ids), 6), dtype=bool)
    for i, card in enumerate(cards):
        if card.ps:
            permanent[i, [int(c) - 1 for c in card.ps.strip("0")]] = True
    return Points(bulk, ids, xyz, rotated, directions, permanent, scalar, frames)


def moved_points(points: Points, values: Bulk, grids: Ints) -> Points:
    """Return the points with some grids, (n,), where other cards have them; systems stay."""
    rows = np.searchsorted(points.ids, grids)
    cards = [values.table("GRID")[int(g)] for g in grids]
    given = np.array([c.xyz for c in cards], dtype=np.float64)
    cp, cd = (np.array([getattr(c, name) for c in cards]) for name in ("cp", "cd"))
    xyz, directions = points.xyz.copy(), points.directions.copy()
    xyz[rows] = _positions(values, grids, given, cp, points.frames)
    _, directions[rows] = _directions(values, grids, xyz[rows], cd, points.frames)
    return replace(points, xyz=xyz, directions=directions)


def _positions(bulk: Bulk, ids: Ints, given: Floats, cp: Ints, frames: Frames) -> Floats:
    xyz = given.copy()
    for system in np.unique(cp[cp != 0]):
        rows = np.flatnonzero(cp == system)
        frame = frames.get(int(system), bulk.place("GRID", int(ids[rows[0]])))
        xyz[rows] = frame.positions(given[rows])
    return xyz


def _directions(bulk: Bulk, ids: Ints, xyz: Floats, cd: Ints, frames: Frames) -> tuple[Any, Floats]:
    """Which grids have displacement directions other than the basic ones, and all directions."""
    directions = np.broadcast_to(np.eye(3), (len(ids), 3, 3)).copy()
    rotated = np.zeros(len(ids), dtype=bool)
    for system in np.unique(cd[cd != 0]):
        rows = np.flatnonzero(cd == system)
        place = bulk.place("GRID", int(ids[rows[0]]))
        if system < 0:
            raise place.error("fluid points (CD = -1) are not supported")
        frame = frames.get(int(system), place)
        if not frame.is_basic:
            rotated[rows] = True
            directions[rows] = frame.directions(xyz[rows])
    return rotated, directions


def _scalar_ids(bulk: Bulk) -> Ints:
    """Scalar points named on SPOINT, or used without one by cards with attribute `scalars`."""
    ids: set[int] = set()
    for card in bulk.listed("SPOINT"):
        for part in card.nodes:
            ids.update(part if isinstance(part, range) else (part,))
    for name, definition in bulk.definitions.items():
        if any(f.attribute == "scalars" for f in definition.fields):
            ids.update(k for card in bulk.table(name).values() for k in card.scalars if k)
    return np.array(sorted(ids), dtype=np.int64)
