"""Mass spread over a region: insulation, paint, liquid, cabling."""

from __future__ import annotations

from typing import Any

import numpy as np
import scipy.sparse as sp

from ...arrays import Floats
from ..candidates import Candidates, MassLaw
from ..structure import Structure
from .patches import Patch, PatchCandidates, patches_of, where_of
from .scale import Scale

_RADII = (0.13, 0.22)


def candidates(structure: Structure, scale: Scale) -> Candidates | None:
    """Extra mass, in proportion to the mass that is there, over large patches of elements."""
    patches = patches_of(structure, scale.size, _RADII)
    if not patches:
        return None
    return PatchCandidates(
        kind="distributed_mass",
        xyz=np.array([p.xyz for p in patches]),
        law=MassLaw(),
        trials=scale.masses(),
        root=sp.csr_matrix((0, structure.model.n_free)),
        rows_each=0,
        where=where_of(structure, patches),
        typical=float(np.log(0.05 * scale.mass)),
        spread=1.5,
        extra={
            "structure": structure,
            "patches": patches,
            "share": _share,
            "areas": np.array([_area(structure, p) for p in patches]),
        },
    )


def _area(structure: Structure, patch: Patch) -> float:
    """Area of the shell elements of a patch."""
    x = structure.model.geometry.xyz[structure.members[patch.member].corners[patch.rows]]
    last = x[:, 3] if x.shape[1] == 4 else x[:, 0]
    diagonals = np.cross(x[:, 2] - x[:, 0], last - x[:, 1])
    return float(0.5 * np.linalg.norm(diagonals, axis=1).sum())


def _share(patch: Patch, M: Floats) -> Any:
    """Scale element masses so that the patch as a whole has unit mass."""
    n = M.shape[1]
    x = np.zeros(n)
    x[np.arange(0, n, 6)] = 1.0
    return 1.0 / float(np.einsum("i,nij,j->", x, M, x))
