"""Stiffness lost or gained over a patch of elements: a crack, a repair, a doubler."""

from __future__ import annotations

import numpy as np
import scipy.sparse as sp

from ..candidates import Candidates
from ..laws import FactorLaw
from ..structure import Structure
from .bars import bars_of
from .patches import Patch, PatchCandidates, patches_of, where_of
from .scale import Scale

_FACTORS = (0.2, 0.5, 1.6, 3.0)


def candidates(structure: Structure, scale: Scale) -> tuple[Candidates, ...]:
    """Factors on the stiffness of patches of shells, of bars between joints and of runs in them."""
    found = (patches_of(structure, scale.size), bars_of(structure, scale.size))
    return tuple(_of(structure, patches) for patches in found if patches)


def _of(structure: Structure, patches: list[Patch]) -> Candidates:
    return PatchCandidates(
        kind="local_stiffness",
        xyz=np.array([p.xyz for p in patches]),
        law=FactorLaw(),
        trials=np.log(_FACTORS)[:, None],
        root=sp.csr_matrix((0, structure.model.n_free)),
        rows_each=0,
        where=where_of(structure, patches),
        typical=np.array([0.0]),
        spread=np.array([1.2]),
        extra={"structure": structure, "patches": patches},
    )
