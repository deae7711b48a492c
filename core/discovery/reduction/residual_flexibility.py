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


class Lost:
    """What a basis lacks of the flexibility of loads.

    Parameters
    ----------
    compliance : Compliance
    vectors : (n_free, r) float
        The basis.
    """

    def __init__(self, compliance: Compliance, vectors: Floats) -> None:
        self._compliance, self._vectors = compliance, vectors
        self._inverse = compliance.on(vectors)

    def of(self, loads: sp.csr_matrix) -> Floats:
        """Return by how much less than in truth each of `loads` (n, n_free) moves itself, (n,)."""
        seen = np.asarray(loads @ self._vectors)
        lost = self._compliance.of(loads) - np.einsum("ij,ij->i", seen @ self._inverse, seen)
        return np.asarray(np.maximum(lost, 0.0))

    def among(self, loads: sp.csr_matrix) -> Floats:
        """Return by how much less they move each other, (n, n)."""
        seen = np.asarray(loads @ self._vectors)
        return np.asarray(self._compliance.among(loads) - seen @ self._inverse @ seen.T)


class Flexibility:
    """The flexibility of loads that a basis does not have, found when asked for, then kept.

    What a basis lacks is local: loads that are apart, as the ends of a spring between two places,
    lack what each of them does.

    Parameters
    ----------
    lost : Lost
    loads : (m, n_free) sparse
        Each at one place.
    turns : (n · q, m) sparse
        Loads of n candidates, q each, as sums of those.
    each : int
        q.
    """

    def __init__(self, lost: Lost, loads: sp.csr_matrix, turns: sp.csr_matrix, each: int) -> None:
        self._lost, self._loads, self._each = lost, loads, each
        self._turns = turns.multiply(turns).tocsr()
        self._known = np.full(loads.shape[0], np.nan)

    def __getitem__(self, rows: Ints) -> Floats:
        """Return what the basis lacks, (len(rows), q)."""
        turns = self._turns[(rows[:, None] * self._each + np.arange(self._each)).ravel()]
        wanted = np.unique(turns.indices)
        new = wanted[np.isnan(self._known[wanted])]
        if len(new):
            self._known[new] = self._lost.of(self._loads[new])
        return np.asarray(turns @ self._known).reshape(len(rows), self._each)


class SharedFlexibility:
    """The flexibility among loads of one candidate that a basis does not have.

    See `Flexibility`; `loads` are what candidates have in common.
    """

    def __init__(self, lost: Lost, loads: sp.csr_matrix, turns: sp.csr_matrix, each: int) -> None:
        self._lost, self._loads, self._turns, self._each = lost, loads, turns, each
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
        lost = self._lost.among(self._loads[known])
        for i, part in zip(rows[:number], parts[:number], strict=True):
            T = part[:, known].toarray()
            self._kept[i] = T @ lost @ T.T
        return number
