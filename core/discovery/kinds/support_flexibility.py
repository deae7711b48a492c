"""A support that gives: a clamp that is not rigid."""

from __future__ import annotations

import numpy as np

from ..candidates import Candidates, ReleaseLaw
from ..structure import Structure
from .scale import Scale


def candidates(structure: Structure, scale: Scale) -> Candidates | None:
    """Give every fixed direction of every support, one at a time, a finite stiffness."""
    s = structure.supports
    if s is None or not len(s.grid):
        return None
    typical = float(np.median(np.log(s.own)))
    return Candidates(
        kind="support_flexibility",
        xyz=s.xyz,
        law=ReleaseLaw(s.own[:, None], s.elasticity[:, None, :], np.zeros(s.elasticity.shape[1])),
        trials=typical + np.log([0.003, 0.03, 0.3, 3.0]),
        root=s.root,
        rows_each=1,
        where=tuple(
            {"grids": [int(g)], "components": [int(c)]}
            for g, c in zip(s.grid, s.component, strict=True)
        ),
        typical=typical - 1.0,
        spread=2.5,
    )
