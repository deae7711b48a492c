"""Mass spread over a region: insulation, paint, liquid, cabling."""

from __future__ import annotations

import numpy as np
import scipy.sparse as sp

from ..candidates import Candidates
from ..laws import MassLaw
from ..structure import Structure
from .patches import PatchCandidates, area_of, patches_of, where_of
from .scale import Scale

_RADII = (0.062, 0.075, 0.092, 0.11, 0.14, 0.175, 0.22)
"""Radii beside the size of the structure; what is smaller is a mass at a point."""


def candidates(structure: Structure, scale: Scale) -> tuple[Candidates, ...]:
    """Extra mass, in proportion to the mass that is there, over patches of elements."""
    patches = patches_of(structure, scale.size, _RADII)
    if not patches:
        return ()
    made = PatchCandidates(
        kind="distributed_mass",
        xyz=np.array([p.xyz for p in patches]),
        law=MassLaw(),
        trials=scale.masses(),
        root=sp.csr_matrix((0, structure.model.n_free)),
        rows_each=0,
        where=where_of(structure, patches),
        typical=np.array([np.log(0.05 * scale.mass)]),
        spread=np.array([1.5]),
        extra={
            "structure": structure,
            "patches": patches,
            "areas": np.array([area_of(structure, p) for p in patches]),
        },
    )
    return (made,)
