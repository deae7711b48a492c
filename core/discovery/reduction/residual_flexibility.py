"""What loads displace themselves and each other by, and how much of it a basis does not have."""

import numpy as np
import scipy.sparse as sp

from ...arrays import Floats, Ints
from ...data.parametric_model import Model
from ...eigen.normal_modes import Eigensolution
from ...numerics.factorisation import factorise
from .reduction_numbers import REDUCTION


class Compliance:
    """What single loads displace themselves by, found when asked for, then kept.

    Parameters
    ----------
    model : Model
    solution : Eigensolution
        Its factor is used; the compliance is that of K − σM with its shift.
    """

    def __init__(self, model: Model, solution: Eigensolution) -> None:
        self._A = (model.K() - solution.sigma * model.M()).tocsr()
        self._factor = solution.factor or factorise(self._A, definite=True)
        self._known: dict[bytes, float] = {}

    def of(self, loads: sp.csr_matrix) -> Floats:
        """Return lᵀ (K − σM)⁻¹ l of each row l of `loads` (n, n_free), (n,)."""
        ends = list(zip(loads.indptr[:-1], loads.indptr[1:], strict=True))
        keys = [loads.indices[a:b].tobytes() + loads.data[a:b].tobytes() for a, b in ends]
        new = {k: i for i, k in enumerate(keys) if k not in self._known}
        if new:
            exact = self._factor.compliances(loads[list(new.values())])
            self._known |= dict(zip(new, exact.tolist(), strict=True))
        return np.array([self._known[k] for k in keys])

    def responses(self, loads: Floats) -> Floats:
        """Return (K − σM)⁻¹ L of loads L (n_free, n)."""
        return np.asarray(self._factor.solve(np.ascontiguousarray(loads)))

    def among(self, loads: sp.csr_matrix) -> Floats:
        """Return L (K − σM)⁻¹ Lᵀ of the rows of `loads` L (n, n_free), (n, n)."""
        n = loads.shape[0]
        out = np.empty((n, n))
        for some in np.array_split(np.arange(n), -(-n // REDUCTION.at_once)) if n else ():
            out[:, some] = loads @ self._factor.solve(loads[some].T.toarray())
        return 0.5 * (out + out.T)

    def on(self, vectors: Floats) -> Floats:
        """Return the inverse of K − σM on a basis (n_free, r), (r, r)."""
        return np.asarray(np.linalg.inv(vectors.T @ (self._A @ vectors)))


class Flexibility:
    """The flexibility of loads that a basis does not have, found when asked for, then kept.

    What a basis lacks is local: loads that are apart, as the ends of a spring between two places,
    lack what each of them does.

    Parameters
    ----------
    compliance : Compliance
    vectors : (n_free, r) float
        The basis.
    inverse : (r, r) float
        See `Compliance.on`.
    loads : (m, n_free) sparse
        Each at one place.
    turns : (n · q, m) sparse
        Loads of n candidates, q each, as sums of those.
    each : int
        q.
    """

    def __init__(
        self,
        compliance: Compliance,
        vectors: Floats,
        inverse: Floats,
        loads: sp.csr_matrix,
        turns: sp.csr_matrix,
        each: int,
    ) -> None:
        self._compliance = compliance
        self._vectors, self._inverse = vectors, inverse
        self._loads, self._turns = loads, turns.multiply(turns).tocsr()
        self._of_loads = np.full(loads.shape[0], np.nan)
        self._kept = np.full((turns.shape[0] // each, each), np.nan)

    def __getitem__(self, rows: Ints) -> Floats:
        """Return what the basis lacks, (len(rows), q)."""
        new = np.unique(rows[np.isnan(self._kept[rows, 0])])
        if len(new):
            self._kept[new] = self._found(new)
        return np.asarray(self._kept[rows])

    def _found(self, rows: Ints) -> Floats:
        """Find what the basis lacks of some rows, of each load once."""
        q = self._kept.shape[1]
        turns = self._turns[(rows[:, None] * q + np.arange(q)).ravel()]
        wanted = np.unique(turns.indices)
        new = wanted[np.isnan(self._of_loads[wanted])]
        if len(new):
            own = self._loads[new]
            seen = np.asarray(own @ self._vectors)
            lost = self._compliance.of(own) - np.einsum("ij,ij->i", seen @ self._inverse, seen)
            self._of_loads[new] = np.maximum(lost, 0.0)
        known = np.zeros_like(self._of_loads)
        known[wanted] = self._of_loads[wanted]
        return np.asarray(turns @ known).reshape(len(rows), q)


class SharedFlexibility:
    """The flexibility among loads of one candidate that a basis does not have.

    Parameters
    ----------
    compliance, vectors, inverse
        See `Flexibility`.
    loads : (m, n_free) sparse
        What candidates have in common.
    turns : (n · q, m) sparse
        Loads of n candidates, q each, as sums of those.
    each : int
        q.
    """

    def __init__(
        self,
        compliance: Compliance,
        vectors: Floats,
        inverse: Floats,
        loads: sp.csr_matrix,
        turns: sp.csr_matrix,
        each: int,
    ) -> None:
        self._compliance = compliance
        self._vectors, self._inverse = vectors, inverse
        self._loads, self._turns, self._each = loads, turns, each
        self._kept: dict[int, Floats] = {}

    def __getitem__(self, rows: Ints) -> Floats:
        """Return what the basis lacks, (len(rows), q, q)."""
        new = [i for i in np.unique(rows).tolist() if i not in self._kept]
        while new:
            new = new[self._learn(new) :]
        return np.array([self._kept[i] for i in rows.tolist()])

    def _learn(self, rows: list[int]) -> int:
        """Find what the basis lacks for the first of some rows, and say for how many."""
        q = self._each
        parts = [self._turns[i * q : (i + 1) * q] for i in rows]
        known = np.zeros(self._loads.shape[0], bool)
        number = 0
        for part in parts:
            wider = known.copy()
            wider[part.indices] = True
            if number and np.count_nonzero(wider) > REDUCTION.shared_at_once:
                break
            known, number = wider, number + 1
        own = self._loads[known]
        seen = np.asarray(own @ self._vectors)
        lost = self._compliance.among(own) - seen @ self._inverse @ seen.T
        for i, part in zip(rows[:number], parts[:number], strict=True):
            T = part[:, known].toarray()
            self._kept[i] = T @ lost @ T.T
        return number
