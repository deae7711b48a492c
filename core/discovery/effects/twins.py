"""The same effect at places that are each other's images: two engines, a ring of feet."""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from ...arrays import Floats, Ints
from ..reduction.search_basis import Basis
from ..symmetry.equivalent_places import images_of, symmetries
from ..symmetry.symmetry_numbers import SYMMETRY
from .candidates import Candidates
from .effect_laws import Rows


def with_twins(single: Candidates, size: float) -> tuple[Candidates, ...]:
    """Return candidates at points, and beside them the same at every set of equivalent grids.

    A set has one magnitude, that of each place. `size` is that of the structure.
    """
    at_grids = np.flatnonzero([len(w["grids"]) == 1 for w in single.where])
    grids = np.array([single.where[i]["grids"][0] for i in at_grids], dtype=np.int64)
    _, once = np.unique(grids, return_index=True)
    xyz = single.xyz[at_grids[once]]
    if not len(xyz):
        return (single,)
    sets = [
        together(single, at_grids[once][rows], np.concatenate([np.eye(3)[None], s.maps]))
        for s in symmetries(xyz, size)
        for rows in [images_of(s, xyz, SYMMETRY.image_off * size, SYMMETRY.twins_apart * size)]
        if len(rows)
    ]
    return (single, *sets)


def together(single: Candidates, rows: Ints, maps: Floats | None = None) -> Candidates:
    """Return candidates at several places each, `rows` (n, m) of those at one.

    `maps` (m, 3, 3) take the first of the places to each.
    """
    q = single.rows_each
    loads = (rows[:, :, None] * q + np.arange(q)).ravel()
    return replace(
        single,
        xyz=single.xyz[rows[:, 0]],
        root=single.root[loads],
        rows_each=q * rows.shape[1],
        where=tuple(single.where[i] for i in rows[:, 0]),
        single=single,
        copies=tuple(map(tuple, rows.tolist())),
        maps=maps,
    )


@dataclass(frozen=True, eq=False)
class RowsTogether:
    """Rows of sets of places on a basis, those of a place (n, q, r) one after the other."""

    each: Rows
    copies: Ints

    def __getitem__(self, rows: Ints) -> Floats:
        """Return the rows of some sets, (n, m · q, r)."""
        sets = self.copies[rows]
        U = self.each[sets.ravel()]
        return U.reshape(len(sets), sets.shape[1] * U.shape[1], U.shape[2])


def factors_of(catalogue: Sequence[Candidates], basis: Basis) -> tuple[Rows, ...]:
    """Return the rows of all candidates on a basis."""
    own: dict[int, Rows] = {id(c): c.factors(basis) for c in catalogue if c.single is None}
    return tuple(
        own[id(c)] if c.single is None else RowsTogether(own[id(c.single)], np.array(c.copies))
        for c in catalogue
    )


def places_of(c: Candidates, row: int) -> list[tuple[Candidates, int]]:
    """Return candidates and row of each place of one of them: more than one of a set of twins."""
    if c.single is None:
        return [(c, row)]
    return [(c.single, i) for i in c.copies[row]]
