"""K x = lambda M x: its matrices, aligned for K - sigma M, and what a solver hands back."""

from __future__ import annotations

from copy import copy
from dataclasses import dataclass, field
from functools import cached_property, lru_cache
from itertools import pairwise
from typing import Self

import numpy as np
import scipy.sparse as sp

from ..arrays import Floats, Ints, frozen, require_finite
from ..data.parametric_model import Model
from ..errors import CheckError, InputError
from ..noun import Noun
from ..numerics.block_lanczos import NEGATIVE_MASS
from ..numerics.factorisation import Factorisation
from ..numerics.shared_pattern_sum import same_pattern, shared, weighted_sum
from .eigen_numbers import EIGEN


class Pencil:
    """K and M of one model at one parameter point.

    Parameters
    ----------
    K, M : (n, n) sparse
        Symmetric.
    labels : tuple of str, optional
        Name of each degree of freedom, for messages.

    Raises
    ------
    InputError
        Shapes that disagree, entries that are not finite, a matrix that is not symmetric, no
        mass, a negative mass on the diagonal, or a degree of freedom with neither stiffness nor
        mass.
    """

    def __init__(self, K: sp.spmatrix, M: sp.spmatrix, labels: tuple[str, ...] = ()) -> None:
        self.K, self.M = sp.csr_matrix(K), sp.csr_matrix(M)
        self.n = int(self.K.shape[0])
        self.labels = labels
        self._check_shapes()
        self.given_mass = self.M
        self.M = _without_rounding(self.K, self.M, self.groups)
        self._check()
        upper_k, upper_m = sp.triu(self.K, format="csr"), sp.triu(self.M, format="csr")
        both = (upper_k + 1j * upper_m).tocsr()  # keeps an entry unless it is zero in both
        both.sort_indices()
        self._indptr, self._indices = both.indptr, both.indices
        self._k, massive = both.data.real.copy(), np.flatnonzero(both.data.imag)
        self._massive, self._m = massive, both.data.imag[massive]
        self.k_diagonal: Floats = np.asarray(self.K.diagonal(), np.float64)
        self.m_diagonal: Floats = np.asarray(self.M.diagonal(), np.float64)

    @classmethod
    def of(cls, model: Model | tuple[sp.spmatrix, sp.spmatrix], p: Floats | None = None) -> Pencil:
        """Return the pencil of a model at `p`, or of a pair (K, M)."""
        if isinstance(model, Model):
            return cls(model.K(p), model.M(p), model.free_labels)
        return cls(*model)

    def on(self, pattern: sp.csr_matrix) -> Self:
        """Return the pencil on a wider pattern, upper triangle of ones (n, n), where it fits.

        Entries that happen to cancel at some values of parameters are zeros on it, so that what
        was analysed for one point serves the others.
        """
        if same_entries(pattern, self.pattern):
            return self
        number = np.arange(1.0, len(self._indices) + 1.0)  # exact in a float up to 2**53
        own, every = (number, self._indices, self._indptr), (pattern.indices, pattern.indptr)
        half = sp.csr_matrix((np.full(pattern.nnz, 0.5), *every), shape=pattern.shape)
        both = half + sp.csr_matrix(own, shape=pattern.shape)
        if both.nnz > pattern.nnz:
            return self
        both.sort_indices()
        place = np.flatnonzero(both.data > 1.0)
        out = copy(self)
        out._indptr, out._indices, out._k = both.indptr, both.indices, np.zeros(both.nnz)
        out._k[place] = self._k
        out._massive = place[self._massive]
        return out

    def sprung(self, rows: Ints) -> Pencil:
        """Return the pencil with springs to ground, as stiff as the diagonal, at some rows."""
        spring = np.zeros(self.n)
        spring[rows] = np.where(self.k_diagonal[rows] > 0.0, self.k_diagonal[rows], 1.0)
        return Pencil(self.K + sp.diags(spring), self.M, self.labels)

    def shifted(self, sigma: float) -> sp.csr_matrix:
        """Upper triangle of K - sigma M, (n, n) csr on a pattern that does not depend on sigma."""
        data = self._k.copy()
        data[self._massive] -= sigma * self._m
        return sp.csr_matrix((data, self._indices, self._indptr), shape=(self.n, self.n))

    @cached_property
    def stiffness_over_mass(self) -> Floats:
        """k_ii / m_ii where both are positive, ascending, (n_both,); at least one value.

        Raises
        ------
        CheckError
            They are no numbers of the machine's.
        """
        both = (self.k_diagonal > 0.0) & (self.m_diagonal > 0.0)
        if not both.any():
            return np.ones(1)
        with np.errstate(over="ignore"):
            ratios = np.sort(self.k_diagonal[both] / self.m_diagonal[both])
        if not np.isfinite(ratios[-1]):
            raise CheckError("masses and stiffnesses differ by more decades than numbers have")
        return ratios

    @property
    def groups(self) -> Ints | None:
        """Node of each degree of freedom by its label, (n,); None where there are no labels."""
        if len(self.labels) != self.n:
            return None
        return _nodes(self.labels)

    @property
    def least_shift(self) -> float:
        """Size of a shift that stands clear of the rounding of K."""
        ratio = self.stiffness_over_mass
        least = EIGEN.least_shift * float(np.median(ratio))
        return max(least, EIGEN.digits * self.precision * float(ratio[-1]))

    @cached_property
    def precision(self) -> float:
        """Relative rounding of stiffness values that came through single precision or few digits.

        Zero for full double precision. A matrix read from a punch file with ten digits restrains
        its rigid-body motions by that rounding. Round numbers typed by hand are exact and do not
        count: most values must need the last digit.
        """
        data = self.K.data[self.K.data != 0.0]
        sample = data[:: max(1, len(data) // EIGEN.sample)]
        if len(sample) < EIGEN.sample_least:
            return 0.0
        needed = np.array([_digits(v) for v in sample])
        most, typical = int(needed.max()), float(np.median(needed))
        if EIGEN.few_digits[0] <= most == typical <= EIGEN.few_digits[1]:
            return 0.5 * 10.0 ** (1 - most)
        with np.errstate(over="ignore"):
            single = sample.astype(np.float32).astype(np.float64)
        same = typical >= EIGEN.single_digits and np.array_equal(single, sample)
        return EIGEN.single if same else 0.0

    def backward_error(self, values: Floats, X: Floats, left: Floats) -> float:
        """Return the largest ||K x - lambda M x||, `left`, beside ||D x|| of modes X (n, k).

        Forces are scaled by D^-1/2 and motions by D^1/2, D the diagonal of K + lambda M.
        """
        size = np.maximum(np.abs(values), self.least_shift)
        D = np.abs(self.k_diagonal)[:, None] + self.m_diagonal[:, None] * size
        D[D == 0.0] = 1.0
        off = (left**2 / D).sum(axis=0) / np.einsum("ij,ij,ij->j", X, X, D)
        return float(np.sqrt(off.max(initial=0.0)))

    @property
    def pattern(self) -> sp.csr_matrix:
        """Upper triangle of ones where K or M has an entry, (n, n)."""
        ones = np.ones(len(self._indices), np.int8)
        return sp.csr_matrix((ones, self._indices, self._indptr), shape=(self.n, self.n))

    def name(self, row: int) -> str:
        """Return what the user calls a degree of freedom."""
        return self.labels[row] if len(self.labels) == self.n else f"degree of freedom {row + 1}"

    def _check_shapes(self) -> None:
        for matrix, what in ((self.K, "stiffness"), (self.M, "mass")):
            if matrix.shape != (self.n, self.n):
                raise InputError(f"the {what} matrix has shape {matrix.shape}, expected square")
            require_finite(matrix.data, f"the {what} matrix")
            probe = np.random.default_rng(1).standard_normal(self.n)
            size = (magnitudes(matrix) @ np.abs(probe)).max(initial=0.0)
            if (np.abs(matrix @ probe - matrix.T @ probe) > EIGEN.symmetric * size).any():
                raise InputError(f"the {what} matrix is not symmetric")

    def _check(self) -> None:
        if self.n == 0:
            raise InputError("the model has no free degree of freedom: nothing can move")
        if self.M.nnz == 0 or not np.any(self.M.data):
            raise InputError("the model has no mass: give densities, masses or NSM")
        mass = self.M.diagonal()
        if (mass < 0.0).any():
            row = int(np.argmin(mass))
            raise InputError(
                f"the mass at {self.name(row)} is negative ({mass[row]:g}): "
                "look for a negative density, NSM or point mass"
            )
        ones = np.ones(self.n)
        used = (magnitudes(self.K) @ ones > 0.0) | (magnitudes(self.M) @ ones > 0.0)
        if not used.all():
            rows = np.flatnonzero(~used)
            names = ", ".join(self.name(int(r)) for r in rows[: EIGEN.unused_named])
            left = len(rows) - EIGEN.unused_named
            more = f" and {left} more" if left > 0 else ""
            raise InputError(
                f"{names}{more} has neither stiffness nor mass: constrain it or connect it"
            )


def same_entries(a: sp.csr_matrix, b: sp.csr_matrix) -> bool:
    """Whether two matrices have entries at the same places, sorted."""
    return np.array_equal(a.indptr, b.indptr) and np.array_equal(a.indices, b.indices)


def widest_pattern(model: Model) -> sp.csr_matrix:
    """Upper triangle of ones where a term of K or M has an entry, whatever the parameters."""
    every = [t.matrix for t in (*model.stiffness, *model.mass)]
    distinct = every[:1] + [b for a, b in pairwise(every) if not same_pattern(a, b)]
    parts = [sp.triu(A, format="csr") for A in distinct]
    ones = weighted_sum(((1.0, *shared([np.ones(A.nnz)], A)) for A in parts), model.n_free)
    ones.data[:] = 1.0
    return ones


@lru_cache(maxsize=2)
def _nodes(labels: tuple[str, ...]) -> Ints:
    """Return the number of the node of each label, (n,), found once for all points of a model."""
    nodes = np.array([label.split(":", 1)[0] for label in labels])
    return frozen(np.unique(nodes, return_inverse=True)[1].reshape(-1).astype(np.int64))


def magnitudes(matrix: sp.csr_matrix) -> sp.csr_matrix:
    """Return a matrix of absolute values on the same pattern."""
    return sp.csr_matrix((np.abs(matrix.data), matrix.indices, matrix.indptr), matrix.shape)


def _without_rounding(K: sp.csr_matrix, M: sp.csr_matrix, nodes: Ints | None) -> sp.csr_matrix:
    """Take out rows and columns of M that are the rounding of zero, positive or negative.

    Massless directions, as the torsion of a bar, that a displacement coordinate system mixes
    with others keep some 1e-16 of the masses that they are mixed with. So a row is rounding where
    each of its entries is, beside the mass of the other degree of freedom or the largest entry
    between the same two nodes (`nodes`, (n,)); how a mass compares with those elsewhere says
    nothing. Scaled by the stiffness, which rids it of units.
    """
    k = np.abs(K.diagonal())
    d = 1.0 / np.sqrt(np.where(k > 0.0, k, 1.0))
    m = np.abs(M.diagonal()) * d**2
    small = np.flatnonzero(m < EIGEN.mass_rounding * m.max(initial=0.0))
    if not len(small):
        return M
    of = np.arange(len(m)) if nodes is None else nodes
    near = np.flatnonzero(np.isin(of, of[small]))
    entries = (sp.diags(d[near]) @ M[near] @ sp.diags(d)).tocoo()
    rows, size = near[entries.row], np.abs(entries.data)
    pairs, pair = np.unique(of[rows] * (of.max() + 1) + of[entries.col], return_inverse=True)
    between = np.zeros(len(pairs))
    np.maximum.at(between, pair, size)
    limit = EIGEN.mass_rounding * np.maximum(m[entries.col], between[pair])
    beside = (rows != entries.col) & (size > 0.0)
    row, other = rows[beside], entries.col[beside]
    mixed, largest = np.zeros(len(m), bool), np.zeros(len(m))
    mixed[row] = True
    mixed[row[size[beside] > limit[beside]]] = False
    np.maximum.at(largest, row, m[other])
    noise = np.zeros(len(m), bool)
    noise[small] = (mixed & (m < EIGEN.mass_rounding * largest))[small]
    if not noise.any():
        return M
    kept = sp.diags((~noise).astype(float))
    cleaned = sp.csr_matrix(kept @ M @ kept)
    cleaned.eliminate_zeros()
    return cleaned


def _digits(value: float) -> int:
    """Significant decimal digits that a number needs, at most 17."""
    return len(repr(float(value)).split("e")[0].replace(".", "").strip("-0"))


def refuse_indefinite_mass(pencil: Pencil) -> None:
    """Raise `InputError` where a few Lanczos steps on the mass find a negative eigenvalue."""
    M = pencil.M
    if (M - sp.diags(pencil.m_diagonal)).count_nonzero() == 0:
        return
    root = np.sqrt(pencil.m_diagonal)
    d = np.divide(1.0, root, out=np.zeros_like(root), where=root > 0.0)
    q = d * (M @ np.random.default_rng(6).standard_normal(pencil.n))
    Q = np.zeros((pencil.n, EIGEN.mass_steps))
    T = np.zeros((EIGEN.mass_steps, EIGEN.mass_steps))
    for j in range(EIGEN.mass_steps):
        norm = np.linalg.norm(q)
        if norm <= EIGEN.mass_spanned:
            break
        Q[:, j] = q / norm
        image = d * (M @ (d * Q[:, j]))
        T[:, j] = Q.T @ image
        q = image - Q @ T[:, j]
    if np.linalg.eigvalsh((T + T.T) / 2.0)[0] < -EIGEN.mass_negative:
        raise InputError(NEGATIVE_MASS)


@dataclass(frozen=True, eq=False)
class Spectrum(Noun):
    """Modes besides the rigid-body modes that were known beforehand.

    Parameters
    ----------
    values : (n_mode,) float
        Ascending.
    vectors : (n, n_mode) float
        M-orthonormal, and M-orthogonal to the known ones.
    residual : (n_mode,) float
        ||x - (lambda - sigma) A^-1 M x||_M with A = K - sigma M.
    sigma : float
        The shift.
    complete : bool
        Whether these are all modes that the mass matrix allows.
    missed : int or None
        Eigenvalues that the inertia count shows but that are not here; None without a count.
    factor : Factorisation or None
        Of K - sigma M.
    count_factor : Factorisation or None
        Of K - s M, s next to the modes, by which they were counted.
    ahead : (n,) float
        Rough values of the next eigenvalues, to find a gap.
    left_out : int
        Modes up to the highest frequency asked for that were not looked for, being too many.
    """

    values: Floats
    vectors: Floats
    residual: Floats
    sigma: float
    complete: bool
    missed: int | None
    factor: Factorisation | None = None
    ahead: Floats = field(default_factory=lambda: np.zeros(0))
    left_out: int = 0
    count_factor: Factorisation | None = None


def widest_gap(values: Floats, first: int, rounding: float = 0.0) -> int | None:
    """Return a position k >= first of a clear gap between values[k - 1] and values[k], else None.

    Where values differ by their `rounding` only there is none.
    """
    step = np.diff(values[first - 1 :])
    ahead = np.where(step > rounding, step / np.abs(values[first:]), 0.0)
    clear = np.flatnonzero(ahead > EIGEN.clear)
    if len(clear):
        return first + int(clear[0])
    k = int(np.argmax(ahead)) if len(ahead) else 0
    return first + k if len(ahead) and ahead[k] > EIGEN.gap else None
