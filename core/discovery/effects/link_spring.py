"""A spring between two places: a brace, a strut, a member that the model does not have."""

from dataclasses import dataclass, field

import numpy as np
import scipy.sparse as sp

from ...arrays import Floats
from ..reduction.elements_and_supports import Structure, thinned
from .candidates import Candidates
from .effect_kind import STIFFNESS, EffectKind, Scale
from .effect_laws import SpringLaw
from .effect_numbers import EFFECTS
from .structure_points import points_of, translations


@dataclass(frozen=True, eq=False)
class Links(Candidates):
    """Springs along the lines between two places, `ends_xyz` (n, 6) of them one after the other."""

    ends_xyz: Floats = field(default_factory=lambda: np.zeros((0, 6)))

    @property
    def spots(self) -> Floats:
        """Return both ends: links are near each other where both of these are."""
        return np.asarray(self.ends_xyz * np.sqrt(0.5))


def _places(structure: Structure, scale: Scale) -> tuple[Candidates, ...]:
    """Springs between any two of the grids that are left when these are thinned."""
    points, xyz, grids = points_of(structure)
    own = np.flatnonzero([len(g) == 1 for g in grids])
    own = own[np.argsort(xyz[own] @ _ORDER, kind="stable")]
    spacing = EFFECTS.link_spacing * scale.size
    while len(kept := thinned(xyz[own], spacing)) > EFFECTS.link_ends:
        spacing *= EFFECTS.link_thinned
    own = own[kept]
    a, b = np.triu_indices(len(own), 1)
    line = xyz[own[b]] - xyz[own[a]]
    length = np.linalg.norm(line, axis=1)
    low, high = EFFECTS.link_lengths
    some = np.flatnonzero((length > low * scale.size) & (length < high * scale.size))
    if not len(some):
        return ()
    a, b, n = a[some], b[some], line[some] / length[some, None]
    rows, three = np.repeat(np.arange(len(some)), 3), np.arange(3)
    pull = sp.csr_matrix(
        (n.ravel(), (rows, (3 * b[:, None] + three).ravel())), (len(some), 3 * len(own))
    )
    push = sp.csr_matrix((n.ravel(), (rows, (3 * a[:, None] + three).ravel())), pull.shape)
    first, last = xyz[own[a]], xyz[own[b]]
    found = Links(
        kind=KIND,
        xyz=0.5 * (first + last),
        law=SpringLaw(np.zeros((len(some), 1))),
        trials=scale.springs(),
        root=((pull - push) @ translations(structure, points[own])).tocsr(),
        rows_each=1,
        where=tuple(
            {"grids": [grids[i][0], grids[j][0]], "components": [1]}
            for i, j in zip(own[a].tolist(), own[b].tolist(), strict=True)
        ),
        typical=np.array([np.log(EFFECTS.spring * scale.mass * scale.omega2)]),
        spread=np.array([EFFECTS.spring_spread]),
        ends_xyz=np.hstack([first, last]),
    )
    return (found,)


_ORDER = np.array([1.0, 0.7548776662466927, 0.5698402909980532])
"""Along it grids are in order: which end of a link is the first (Roberts 2018)."""

KIND = EffectKind(
    name="link_spring",
    label="spring between two places",
    plural="springs between two places",
    sentence="A spring of about {stiffness:.3g} (deck units) between two places, along the line "
    "through them, is missing {region}: it",
    magnitudes=(STIFFNESS,),
    places=_places,
    across=EFFECTS.links_across,
    directed=True,
    nature="link",
    late=True,
)
