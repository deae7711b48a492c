"""A spring between two places: a brace, a strut, a member that the model does not have."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import scipy.sparse as sp
from scipy.spatial import cKDTree

from ...arrays import Floats, Ints
from ..reduction.elements_and_supports import Structure, thinned
from .candidates import Candidates
from .effect_kind import STIFFNESS, EffectKind, Scale
from .effect_laws import SpringLaw
from .effect_numbers import EFFECTS
from .structure_points import Points, points_of


@dataclass(frozen=True, eq=False, kw_only=True)
class Links(Candidates):
    """Springs along the lines between two places, `ends_xyz` (n, 6) of them one after the other."""

    structure: Structure
    ends_xyz: Floats

    @property
    def spots(self) -> Floats:
        """Return both ends: links are near each other where both of these are."""
        return np.asarray(self.ends_xyz * np.sqrt(0.5))

    def near(self, row: int, count: int) -> Links:
        """Return the links between so many points nearest to either end of one of them.

        What joins two places ends where it ends, at a grid of the mesh or between them; not at the
        quarters of a bar: a link from one to the next along it would be a stiffer stretch of it.
        """
        every = points_of(self.structure)
        points = every.of(np.flatnonzero(["arms" not in w for w in every.where]))
        xyz = points.xyz
        first, last = (
            cKDTree(xyz).query(end, min(count, len(xyz)))[1]
            for end in np.split(self.ends_xyz[row], 2)
        )
        a, b = (i.ravel() for i in np.meshgrid(first, last, indexing="ij"))
        some = np.any(xyz[a] != xyz[b], axis=1)
        return _between(self.structure, points, a[some], b[some], self.trials, self.typical)


def _places(structure: Structure, scale: Scale) -> tuple[Candidates, ...]:
    """Springs between any two of the grids that are left when these are thinned."""
    points = points_of(structure)
    points = points.of(points.at_grids)
    xyz = points.xyz
    spacing = EFFECTS.link_spacing * scale.size
    while len(kept := thinned(xyz, spacing)) > EFFECTS.link_ends:
        spacing *= EFFECTS.link_thinned
    a, b = np.triu_indices(len(kept), 1)
    length = np.linalg.norm(xyz[kept[b]] - xyz[kept[a]], axis=1)
    low, high = EFFECTS.link_lengths
    some = np.flatnonzero((length > low * scale.size) & (length < high * scale.size))
    if not len(some):
        return ()
    a, b = kept[a[some]], kept[b[some]]
    return (_between(structure, points, a, b, scale.springs(), scale.spring),)


def _between(
    structure: Structure, at: Points, a: Ints, b: Ints, trials: Floats, typical: Floats
) -> Links:
    """Return the links between points a (n,) and b (n,); `trials`, `typical`: see `Candidates`."""
    xyz, grids = at.xyz, [w["grids"] for w in at.where]
    used, ends = np.unique(np.concatenate([a, b]), return_inverse=True)
    line = xyz[b] - xyz[a]
    n = line / np.linalg.norm(line, axis=1)[:, None]
    rows, three, shape = np.repeat(np.arange(len(a)), 3), np.arange(3), (len(a), 3 * len(used))
    moves = at.of(used).moves
    push, pull = (
        (sp.csr_matrix((n.ravel(), (rows, (3 * end[:, None] + three).ravel())), shape) @ moves)
        for end in np.split(ends.ravel(), 2)
    )
    one = sp.identity(len(a), format="csr")
    return Links(
        kind=KIND,
        xyz=0.5 * (xyz[a] + xyz[b]),
        law=SpringLaw(np.zeros((len(a), 1))),
        trials=trials,
        root=(pull - push).tocsr(),
        rows_each=1,
        loads=sp.vstack([push, pull]).tocsr(),
        turns=sp.hstack([-one, one]).tocsr(),
        where=tuple(
            {"grids": [*grids[i], *grids[j]], "ends": [grids[i], grids[j]], "components": [1]}
            for i, j in zip(a.tolist(), b.tolist(), strict=True)
        ),
        typical=typical,
        spread=np.array([EFFECTS.spring_spread]),
        structure=structure,
        ends_xyz=np.hstack([xyz[a], xyz[b]]),
    )


KIND = EffectKind(
    name="link_spring",
    label="spring between two places",
    plural="springs between two places",
    sentence="A spring of {size} between two places, along the line through them, is missing "
    "{region}: it",
    magnitudes=(STIFFNESS,),
    places=_places,
    across=EFFECTS.links_across,
    directed=True,
    nature="link",
    late=True,
)
