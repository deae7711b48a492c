"""A spring to ground: a cable, a hose, a suspension, a contact that the model does not have."""

from __future__ import annotations

import numpy as np

from ..candidates import Candidates, SpringLaw
from ..structure import Structure
from .point_mass import points_of, translations
from .scale import Scale


def candidates(structure: Structure, scale: Scale) -> Candidates:
    """Springs along each basic axis at every grid that is not fixed in it."""
    points, xyz, grids = points_of(structure)
    own = np.flatnonzero(np.diff(points.indptr) == 1)
    root = translations(structure, points[own])
    live = np.flatnonzero(np.diff(root.indptr) > 0)
    at = own[live // 3]
    return Candidates(
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
        typical=float(np.log(0.03 * scale.mass * scale.omega2)),
        spread=2.5,
    )
