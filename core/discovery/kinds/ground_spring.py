"""A spring to ground: a cable, a hose, a suspension, a contact that the model does not have."""

from __future__ import annotations

import numpy as np

from ..candidates import Candidates
from ..laws import SpringLaw
from ..structure import Structure
from .point_mass import points_of, translations
from .scale import Scale


def candidates(structure: Structure, scale: Scale) -> tuple[Candidates, ...]:
    """Springs along each basic axis at every grid, shell middle and shell edge that moves."""
    points, xyz, grids = points_of(structure)
    root = translations(structure, points)
    live = np.flatnonzero(np.diff(root.indptr) > 0)
    at = live // 3
    made = Candidates(
        kind="ground_spring",
        xyz=xyz[at],
        law=SpringLaw(np.zeros((len(at), 1))),
        trials=scale.springs(),
        root=root[live],
        rows_each=1,
        where=tuple(
            {"grids": grids[i], "components": [int(c)]}
            for i, c in zip(at, live % 3 + 1, strict=True)
        ),
        typical=np.array([np.log(0.03 * scale.mass * scale.omega2)]),
        spread=np.array([2.5]),
    )
    return (made,)
