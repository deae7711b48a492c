"""Supports that hold more of the structure than the deck says: a clamp that reaches further in.

Elements within its reach do not bend; those of the row in which it ends bend as much less as a
smaller part of them is left. No effect of the list is that, and patches and springs beside the
support imitate it.
"""

from dataclasses import dataclass

import numpy as np
import scipy.sparse as sp
from scipy.spatial import cKDTree

from ...arrays import Bools, Floats
from ..effects.candidates import Candidates
from ..effects.effect_kind import FACTOR, EffectKind
from ..effects.effect_laws import FactorLaw
from ..effects.effect_numbers import EFFECTS
from ..effects.element_patches import root_of
from ..reduction.elements_and_supports import Structure, placed
from ..reduction.search_basis import Basis
from .model_error_numbers import MODEL_ERROR


@dataclass(frozen=True)
class Reach:
    """How far in supports hold more than the deck says, and ln of the evidence for it."""

    far: float
    score: float


@dataclass(frozen=True, eq=False, kw_only=True)
class Reaches(Candidates):
    """Reaches by one and more rows of elements.

    Parameters
    ----------
    matrices : tuple of (n_free, n_free) sparse
        A of each.
    far : (n + 1,) float
        How far from the support each row of elements ends, 0 first.
    """

    matrices: tuple[sp.csr_matrix, ...]
    far: Floats

    def factors(self, basis: Basis) -> Floats:
        """Return the rows of a root of each matrix on the basis, (n, r, r)."""
        V = basis.vectors
        out = np.zeros((len(self), V.shape[1], V.shape[1]))
        for own, A in zip(out, self.matrices, strict=True):
            root = root_of(V.T @ (A @ V))
            own[: len(root)] = root
        return out

    def acting(self, row: int) -> sp.csr_matrix:
        """Return A of one reach."""
        return self.matrices[row]


def reaches_of(structure: Structure) -> Reaches | None:
    """Return how far clamps may reach, None where no grid is held in all three directions."""
    s, g = structure.supports, structure.model.geometry
    if s is None:
        return None
    held = np.bincount(g.index_of(s.grid)[s.component <= 3], minlength=len(g.ids)) == 3
    within, inner = held, sp.csr_matrix((structure.model.n_free,) * 2)
    made: list[sp.csr_matrix] = []
    far = [0.0]
    for _ in range(MODEL_ERROR.clamp_rows):
        rows = [within[m.corners].any(axis=1) for m in structure.members]
        wider = within.copy()
        for m, own in zip(structure.members, rows, strict=True):
            wider[m.corners[own]] = True
        if np.array_equal(wider, within) or np.mean(wider) > EFFECTS.patch_largest:
            break
        outer = _stiffness(structure, rows)
        made.append(outer + (MODEL_ERROR.clamp_rigid - 1.0) * inner)
        far.append(float(cKDTree(g.xyz[held]).query(g.xyz[wider])[0].max()))
        within, inner = wider, outer
    if not made:
        return None
    n = len(made)
    return Reaches(
        kind=KIND,
        xyz=np.tile(g.xyz[held].mean(axis=0), (n, 1)),
        law=FactorLaw(),
        trials=np.array([[MODEL_ERROR.clamp[0]]]),
        root=sp.csr_matrix((0, structure.model.n_free)),
        rows_each=0,
        where=tuple({"grids": g.ids[held].tolist()} for _ in range(n)),
        typical=np.array([MODEL_ERROR.clamp[0]]),
        spread=np.array([MODEL_ERROR.clamp[1]]),
        lower=np.zeros(1),
        matrices=tuple(made),
        far=np.array(far),
    )


def _stiffness(structure: Structure, rows: list[Bools]) -> sp.csr_matrix:
    """Return the stiffness (n_free, n_free) of some elements of each card, as the deck has it."""
    p, D = structure.model.deck_point, structure.displacement
    A = sp.csr_matrix((D.shape[0],) * 2)
    for m, own in zip(structure.members, rows, strict=True):
        which = np.flatnonzero(own)
        if len(which):
            A = A + placed(D.shape[0], m.coordinates(which), m.stiffness(which, p))
    return (D.T @ A @ D).tocsr()


KIND = EffectKind(
    name="support_reach",
    label="support that reaches further in",
    sentence="",
    magnitudes=(FACTOR,),
)
