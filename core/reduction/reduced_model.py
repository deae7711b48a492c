"""A model projected onto few vectors: its modes at any parameter values in milliseconds."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from itertools import chain

import numpy as np
import scipy.linalg as sl
import scipy.sparse as sp

from ..arrays import Floats, Ints
from ..data.parametric_model import Model
from ..eigen.normal_modes import Eigensolution, solve
from ..eigen.pencil import Pencil
from ..errors import InputError
from ..noun import Noun
from ..numerics.factorisation import Factorisation, factorise
from ..numerics.products import product
from .derivative_numbers import DERIVATIVES
from .eigenpair_derivatives import Sensitivities, clusters, coefficients, differentiate
from .eigenvector_derivatives import modal_change
from .reduced_sum import ReducedSum, reduced_sum
from .static_answers import answers_to, drawn_loads, static_answers


@dataclass(frozen=True, eq=False)
class ReducedModes:
    """Modes of a reduced model at one parameter point.

    Parameters
    ----------
    eigenvalues : (n_mode,) float
        Ascending, (rad/s)^2.
    vectors : (n_basis, n_mode) float
        Coordinates in the basis, mass-orthonormal.
    rigid_body_modes : int
        Of the full model.
    whole : ReducedModes, optional
        All modes of the basis that these are the lowest of, for their derivatives.
    """

    eigenvalues: Floats
    vectors: Floats
    rigid_body_modes: int
    whole: ReducedModes | None = field(default=None, repr=False)

    @property
    def frequencies_hz(self) -> Floats:
        """Natural frequencies, (n_mode,) Hz."""
        return np.asarray(np.sqrt(np.maximum(self.eigenvalues, 0.0)) / (2.0 * np.pi))

    def take(self, count: int) -> ReducedModes:
        """Return the lowest `count` modes."""
        return ReducedModes(
            self.eigenvalues[:count],
            self.vectors[:, :count],
            min(self.rigid_body_modes, count),
            self.whole or self,
        )


@dataclass(frozen=True, eq=False)
class ReducedModel(Noun):
    """K(p) and M(p) of a model on a fixed basis Q.

    Parameters
    ----------
    model : Model
        The full model.
    p0 : (n_parameter,) float
        The parameter values around which it is made.
    parts : tuple of (n_free, k) float
        Vectors Q, side by side: orthonormal with respect to K - sigma M at `p0`.
    stiffness, mass : ReducedSum
        Q^T K Q and Q^T M Q at any parameter values.
    solution : Eigensolution
        Of the full model at `p0`, with its factor.
    damping, loss : ReducedSum
        Q^T D Q and Q^T H Q.
    """

    model: Model
    p0: Floats
    parts: tuple[Floats, ...]
    stiffness: ReducedSum
    mass: ReducedSum
    solution: Eigensolution = field(repr=False)
    damping: ReducedSum
    loss: ReducedSum

    @property
    def size(self) -> int:
        """Number of basis vectors."""
        return sum(part.shape[1] for part in self.parts)

    def spread(self, q: Floats) -> Floats:
        """Return Q q of coordinates (n_basis, k), (n_free, k)."""
        ends = np.cumsum([part.shape[1] for part in self.parts])[:-1]
        first, *others = np.split(q, ends)
        out = product(self.parts[0], first)
        for part, some in zip(self.parts[1:], others, strict=True):
            product(part, some, out, add=True)
        return out

    def project(self, vectors: sp.spmatrix | Floats) -> Floats:
        """Return Q^T u of full vectors u, (n_free, k), as (n_basis, k).

        The transpose of what sensors C, (n_sensor, n_free), see of the basis: C Q is
        ``project(C.T).T``.
        """
        rows: slice | Ints = slice(None)
        if sp.issparse(vectors):
            vectors = sp.csr_matrix(vectors)
            rows = np.flatnonzero(np.diff(vectors.indptr))
        return np.vstack([(vectors[rows].T @ part[rows]).T for part in self.parts])

    def solve(self, p: Floats, n_modes: int | None = None) -> ReducedModes:
        """Find modes at the parameter values `p`.

        Parameters
        ----------
        p : (n_parameter,) float
        n_modes : int, optional
            Default: as many as the full solution at `p0` has.

        Raises
        ------
        InputError
            Where K - sigma M is not positive definite: factors that make no structure.
        """
        K, M = self.stiffness.at(p), self.mass.at(p)
        n = self.size
        wanted = min(n, len(self.solution.eigenvalues) if n_modes is None else n_modes)
        sigma = self.solution.sigma
        part = None if wanted == n else (n - wanted, n - 1)  # all of them come faster
        try:
            theta, q = sl.eigh(M, K - sigma * M, subset_by_index=part)
        except np.linalg.LinAlgError as error:
            raise InputError(
                "the reduced model is not positive definite at these parameter values"
            ) from error
        theta, q = theta[::-1], q[:, ::-1]
        theta = np.maximum(theta, np.finfo(float).tiny)
        rigid = min(self.solution.rigid_body_modes, wanted)
        return ReducedModes(sigma + 1.0 / theta, q / np.sqrt(theta), rigid)

    def with_modes(self, found: Eigensolution) -> ReducedModel:
        """Return the model with the modes of another parameter point in its basis: exact there."""
        left = replace(
            self.solution,
            factor=found.factor,
            count_factor=found.count_factor,
            kept=found.kept or self.solution.kept,
        )
        X = found.vectors[:, found.rigid_body_modes :]
        return replace(self, solution=left)._beside(X, DERIVATIVES.known_already)

    def corrected(self, p: Floats, found: ReducedModes) -> ReducedModel:
        """Return the model with what its modes at `p` lack, A^-1 (K - lambda M) phi, in its basis.

        A is K - s M where the model was last solved in full, s next to the modes: a step of
        Davidson's method (1975, Journal of Computational Physics 17, 87), which leaves of an error
        the share by which K at `p` differs from that. Modes of the basis leave no force along it,
        along the full modes below s neither, so that A is positive beside it.
        """
        free = slice(found.rigid_body_modes, None)
        lam = found.eigenvalues[free]
        X = self.spread(found.vectors[:, free] / np.sqrt(lam - self.solution.sigma))
        R, MX = self.stiffness.applied(p, X), self.mass.applied(p, X)
        MX *= lam
        R -= MX
        W = _factor(self.model, self.p0, self.solution).solve(R)
        return self._beside(W, DERIVATIVES.too_little, np.ones(W.shape[1]))

    def differentiable(
        self,
        p: Floats,
        found: Eigensolution,
        parameters: Sequence[int],
        count: int,
        modes: Ints,
    ) -> ReducedModel:
        """Return the model with what derivatives of the modes `found` at `p` lack in its basis.

        They lack (K - lambda M)^-1 f of the loads f = (K' - lambda M') phi of modes by parameters.
        So many combinations of these, drawn at random, are solved for with the factor by which the
        modes were counted, of K - s M with s next to them. `modes` are elastic ones, from 0.
        """
        X, lam = found.vectors[:, modes], found.eigenvalues[modes]
        weight, rng = 1.0 / np.sqrt(lam - found.sigma), np.random.default_rng(1)
        F = drawn_loads(self.model, p, parameters, X, lam, weight, count, rng)
        W = _factor(self.model, p, found).solve(F)
        return self._beside(W, DERIVATIVES.known_already)

    def _beside(self, W: Floats, least: float, beside: Floats | None = None) -> ReducedModel:
        """Return the model with what its basis lacks of vectors W (n_free, s).

        Of at least so much of an energy, `beside` (s,), by default their own.
        """
        W = np.ascontiguousarray(W)  # as sparse products want
        sums = [terms.widened(self.parts, W) for terms in self._sums]
        A = sums[0].at(self.p0) - self.solution.sigma * sums[1].at(self.p0)
        n = self.size
        own = A[n:, n:].diagonal() if beside is None else beside
        known, scale = A[:n, n:], 1.0 / np.sqrt(np.where(own > 0.0, own, 1.0))
        lacking = (A[n:, n:] - known.T @ known) * np.outer(scale, scale)
        T = scale[:, None] * _independent(lacking, least)
        last = np.vstack([-known @ T, T])
        V = replace(self, parts=(*self.parts, W)).spread(last)
        return self._widened(V, [s.ending(n, last) for s in sums])

    @property
    def _sums(self) -> tuple[ReducedSum, ...]:
        return self.stiffness, self.mass, self.damping, self.loss

    def _widened(self, W: Floats, sums: Sequence[ReducedSum]) -> ReducedModel:
        K, M, D, H = sums
        return replace(self, parts=(*self.parts, W), stiffness=K, mass=M, damping=D, loss=H)

    def vectors(self, modes: ReducedModes) -> Floats:
        """Return the shapes on the free degrees of freedom, (n_free, n_mode), unit modal mass."""
        return self.spread(modes.vectors)

    def sensitivities(
        self,
        p: Floats,
        modes: Sequence[int] | Ints | Floats,
        parameters: Sequence[int],
        sensors: Floats | None = None,
        solution: ReducedModes | None = None,
    ) -> Sensitivities:
        """Differentiate modes within the basis, exactly.

        Parameters
        ----------
        p : (n_parameter,) float
        modes, parameters
            As in `sensitivity.sensitivities`; columns of coefficients may have as many rows as
            there are modes of interest.
        sensors : (n_sensor, n_basis) float, optional
            C Q of the sensors.
        solution : ReducedModes, optional
            At `p`, with its `whole`: repeated modes are those that the coefficients combine.

        Returns
        -------
        Sensitivities
        """
        whole = None if solution is None else solution.whole
        everything = whole or self.solve(p, self.size)
        span = everything.eigenvalues - self.solution.sigma
        count = int(np.count_nonzero(span < DERIVATIVES.mass * span[0]))  # those with mass
        everything = everything.take(count)
        given = np.asarray(modes)
        if given.ndim == 2:
            given = np.vstack([given, np.zeros((max(count - len(given), 0), given.shape[1]))])
        T, by_position = coefficients(given, count)
        X, lam = everything.vectors, everything.eigenvalues
        near = np.flatnonzero(np.isin(np.arange(count), [*chain(*clusters(T, everything))]))
        K, M = (
            np.matmul(X.T, np.matmul(terms.slopes(p, parameters), X[:, near]))
            for terms in (self.stiffness, self.mass)
        )

        def part(cluster: Ints) -> tuple[Floats, Floats]:
            at = np.searchsorted(near, cluster)
            return K[:, :, at], M[:, :, at]

        def matrices_of(cluster: Ints) -> Floats:
            dK, dM = (change[:, cluster] for change in part(cluster))
            G = dK - dM * lam[cluster]
            return (G + G.swapaxes(1, 2)) / 2.0

        at_modes = None if sensors is None else sensors @ X

        def change_of(cluster: Ints) -> Floats:
            return modal_change(lam, cluster, *part(cluster))

        size = len(parameters)
        return differentiate(T, by_position, everything, size, matrices_of, at_modes, change_of)


def _factor(model: Model, p: Floats, found: Eigensolution) -> Factorisation:
    """Return the factor nearest to modes found at `p`, made where none was kept."""
    near = found.count_factor or found.factor
    return near or factorise(Pencil.of(model, p).shifted(found.sigma), True)


def _independent(energy: Floats, least: float) -> Floats:
    """Return combinations of unit energy of vectors with W^T A W, of at least so much of theirs."""
    size, turn = np.linalg.eigh((energy + energy.T) / 2.0)
    new = size > least
    return np.asarray(turn[:, new] / np.sqrt(size[new]))


def build_reduced(
    model: Model,
    p0: Floats,
    targets: Sequence[int] | Ints,
    parameters: Sequence[int],
    *,
    solution: Eigensolution | None = None,
    forces: sp.csr_matrix | None = None,
    more_modes: int = DERIVATIVES.more_modes,
    max_static: int = DERIVATIVES.most_static,
    least_energy: float = DERIVATIVES.least_energy,
    sketch: int | None = None,
) -> ReducedModel:
    """Project a model onto its modes and their static answers to the parameters.

    Parameters
    ----------
    model : Model
    p0 : (n_parameter,) float
        Usually the middle of where the parameters may go.
    targets : (n,) int
        Modes, from 0, that must be good.
    parameters : sequence of int
        Positions in ``model.parameters`` that will move.
    solution : Eigensolution, optional
        At `p0` with ``keep_factor``; made here otherwise.
    forces : (n_force, n_free) sparse, optional
        Whose static answers are in the basis, too.
    more_modes : int
        Modes in the basis beyond the last target, when `solution` is not given.
    max_static : int
        Most static vectors kept, by their energy.
    least_energy : float
        Static vectors of less energy, beside that of a mode and for a factor moved by one, are
        left out; frequencies within 30 % are then good to about a tenth of this.
    sketch : int, optional
        So many combinations of static vectors, at most, drawn at random, by the factor that
        counted the modes in their place (Halko, Martinsson and Tropp 2011, SIAM Review 53, 217):
        a basis that is to be corrected where it is used.

    Returns
    -------
    ReducedModel

    Raises
    ------
    InputError
        A target or parameter that does not exist.

    Notes
    -----
    The basis is Phi and A^-1 (dK/dp_i - lambda_j dM/dp_i) phi_j, with A = K - sigma M the
    matrix whose factor the eigensolution has: the first-order change of every target (Fox and
    Kapoor 1968) is in its span up to the factor (lambda - sigma) / (lambda_k - sigma) of the
    first mode k left out. Modes alone are not enough.
    """
    last = int(np.max(targets, initial=-1))
    if solution is None:
        solution = solve(model, last + 1 + more_modes, p=p0, keep_factor=True)
    if last < 0 or last >= len(solution.eigenvalues) or min(targets) < 0:
        raise InputError(f"mode {last + 1} is a target, the model has {len(solution.eigenvalues)}")
    Q = solution.vectors / np.sqrt(solution.eigenvalues - solution.sigma)
    if sketch is None or forces is not None:
        A = solution.factor or factorise(Pencil.of(model, p0).shifted(solution.sigma), True)
    if sketch is None:
        answers = static_answers(
            model, p0, solution, A, targets, parameters, max_static, least_energy
        )
        Q = np.hstack([Q, answers])
    if forces is not None:
        Q = np.hstack([Q, answers_to(forces, A, Q)])
    K, M, D, H = (
        reduced_sum(terms, Q) for terms in (model.stiffness, model.mass, model.damping, model.loss)
    )
    reduced = ReducedModel(model, p0, (Q,), K, M, solution, D, H)
    if sketch is None:
        return reduced
    few = min(sketch, len(targets) * len(parameters))
    return reduced.differentiable(p0, solution, parameters, few, np.asarray(targets))
