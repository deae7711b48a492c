"""What hypotheses compete for: evidence, basis, catalogue; one that is fitted; two compared."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, replace

import numpy as np

from ...arrays import Floats, Ints
from ...numerics.products import stacked_product
from ...reduction.reduced_sum import ReducedSum
from ..effects.candidates import Candidates, Catalogue, Suspect
from ..effects.effect_laws import Law, Rows
from ..reduction.search_basis import Basis
from .frf_likelihood import Heard
from .likelihood_numbers import LIKELIHOOD
from .mode_likelihood import Evidence


@dataclass(frozen=True, eq=False)
class Prior:
    """Normal prior of the nuisance parameters, mean 0 and `spread`, within bounds.

    Each (n_parameter + 1,): ln p of the known parameters, then the mesh error; see `Fit`.
    """

    spread: Floats
    lower: Floats
    upper: Floats


@dataclass(frozen=True, eq=False)
class Problem:
    """What stays the same while hypotheses compete.

    `factors` holds, for every kind of the catalogue, its rows on the basis, (n, q, r), `missing`
    the flexibility of each that the basis lacks, (n, q), where it matters; `modes` eigenpairs are
    computed, of which the first `columns` may match a test mode. `evidence` is the part of the
    test that hypotheses are fitted to, at the rows `sensors` of the basis; `whole` is all of it,
    at the rows `everywhere`. `heard` is what frequency responses say, where there are any. `known`
    are the rows of single candidates that were asked for.
    """

    evidence: Evidence
    whole: Evidence
    basis: Basis
    sensors: Floats
    everywhere: Floats
    mesh: Floats
    catalogue: Catalogue
    factors: tuple[Rows, ...]
    prior: Prior
    modes: int
    columns: int

    missing: tuple[Rows | None, ...] = ()
    turn: Floats | None = None
    rest: Floats | None = None
    held: tuple[Suspect, ...] = ()
    heard: Heard | None = None
    known: dict[tuple[int, int] | None, tuple[Floats, Floats | None]] = field(
        default_factory=dict, init=False
    )

    def turned(
        self, T: Floats, rest: Floats | None = None, held: Sequence[Suspect] = ()
    ) -> Problem:
        """Return the problem on the basis ``vectors @ T``, T (r, s).

        `rest` (r, r - s) is what T leaves out, each vector divided by the root of its eigenvalue,
        so that the static response that is lost can be put back into the laws. Of what those `held`
        do, whose model has the vectors T as modes, nothing is lost.
        """
        return replace(
            self,
            basis=self.basis.turned(T),
            sensors=self.sensors @ T,
            everywhere=self.everywhere @ T,
            mesh=T.T @ self.mesh @ T,
            turn=T if self.turn is None else self.turn @ T,
            rest=rest,
            held=tuple(held),
        )

    def with_more(self, more: Prior, stiffness: ReducedSum, mass: ReducedSum) -> Problem:
        """Return the problem with `more` parameters before the mesh error, and what they move."""
        of = self.prior
        both = (of.spread, more.spread), (of.lower, more.lower), (of.upper, more.upper)
        prior = Prior(*(np.insert(a, len(a) - 1, b) for a, b in both))
        return replace(self, basis=replace(self.basis, stiffness=stiffness, mass=mass), prior=prior)

    def with_kind(self, kind: int, new: Candidates, rows: Rows) -> Problem:
        """Return the problem with candidates as one of the numbers of its catalogue.

        `rows` are theirs on the basis, which lacks nothing that matters of them.
        """
        before, after = slice(kind), slice(kind + 1, None)
        missing = (*self.missing[before], None, *self.missing[after]) if self.missing else ()
        return replace(
            self,
            catalogue=(*self.catalogue[before], new, *self.catalogue[after]),
            factors=(*self.factors[before], rows, *self.factors[after]),
            missing=missing,
        )

    def entire(self) -> Problem:
        """Return the problem with all of the test as evidence."""
        return replace(self, evidence=self.whole, sensors=self.everywhere)

    def part(self, kind: int, rows: Ints, nuisance: Floats) -> tuple[Floats, Law]:
        """Return rows (n, q, r) of some candidates on the basis, and their law at `nuisance`."""
        U, missing = self._rows(kind, rows)
        top = LIKELIHOOD.law_top * float((2.0 * np.pi * self.evidence.frequencies_hz.max()) ** 2)
        law = self.catalogue[kind].law.on_basis(rows, missing, nuisance[:-1], top)
        return U if law.turn is None else np.matmul(law.turn, U), law

    def _rows(self, kind: int, rows: Ints) -> tuple[Floats, Floats | None]:
        """Return rows of some candidates and the flexibility they lack; of a single one kept."""
        one = (kind, int(rows[0])) if len(rows) == 1 else None
        if one in self.known:
            return self.known[one]
        U = self.factors[kind][rows]
        known = self.missing[kind] if self.missing else None
        missing = None if known is None else known[rows]
        c = self.catalogue[kind]
        if self.rest is not None and c.rows_each:
            held = np.isin(rows, [s.row for s in self.held if s.kind == kind])
            lost = _flexibility(stacked_product(U, self.rest), c.law.shared)
            lost[held] = 0.0
            if not held.all():
                missing = lost if missing is None else missing + lost
        found = U if self.turn is None else stacked_product(U, self.turn), missing
        if one is not None:
            self.known[one] = found
        return found


def _flexibility(F: Floats, shared: bool) -> Floats:
    """Return F Fᵀ of rows F (n, q, r), (n, q, q) if it is shared, else its diagonal (n, q)."""
    if shared:
        return np.asarray(np.matmul(F, F.transpose(0, 2, 1)))
    return np.asarray(np.sum(F**2, axis=-1))


@dataclass(frozen=True, eq=False)
class Fit:
    """A hypothesis with its best parameters and magnitudes.

    `objective` = misfit + prior; `nuisance` (n_parameter + 1,) holds ln p of the known parameters
    and, last and no logarithm, the mesh error (see `discretisation_error`); `information`
    (n_unknown, n_unknown) is the Gauss-Newton Hessian of half the objective, prior included, active
    nuisance parameters first.
    """

    objective: float
    misfit: float
    nuisance: Floats
    suspects: tuple[Suspect, ...]
    match: Ints
    eigenvalues: Floats
    vectors: Floats
    information: Floats
    active: tuple[int, ...]

    @property
    def log_p(self) -> Floats:
        """Return ln p of the known parameters, (n_parameter,)."""
        return self.nuisance[:-1]

    def others(self, q: int) -> tuple[Suspect, ...]:
        """Return all suspects but one."""
        return self.suspects[:q] + self.suspects[q + 1 :]

    def instead(self, q: int, new: Suspect) -> tuple[Suspect, ...]:
        """Return the suspects with another in place of one."""
        return (*self.suspects[:q], new, *self.suspects[q + 1 :])


def softened(problem: Problem) -> Problem:
    """Return the problem with more noise: wider valleys, seen from places and sizes further off.

    The known parameters have yet to follow, so that modes further apart turn within their subspace.
    """
    e = problem.evidence
    n, s, m = e.noise, LIKELIHOOD.soft, LIKELIHOOD.soft_mixing
    wide = replace(n, frequency=s * n.frequency, shape=s * n.shape, mixing=m * n.mixing)
    return replace(problem, evidence=replace(e, noise=wide))


def distinct(fits: Sequence[Fit], catalogue: Catalogue, near: float) -> list[Fit]:
    """Drop fits whose suspects are the same kinds, nearer than `near`, as a better one's."""
    kept: list[Fit] = []
    for f in fits:
        if not any(_same(f, g, catalogue, near) for g in kept):
            kept.append(f)
    return kept


def unmatched(
    best: Fit, f: Fit, same: Callable[[Suspect, Suspect], bool]
) -> tuple[list[int], list[Suspect]]:
    """Return numbers of the suspects of the best that `f` does not have, and what it has instead.

    `same` says whether a suspect of the best and one of `f` are one.
    """
    left, alone = list(f.suspects), []
    for k, s in enumerate(best.suspects):
        twin = next((t for t in left if same(s, t)), None)
        if twin is None:
            alone.append(k)
        else:
            left.remove(twin)
    return alone, left


def _same(f: Fit, g: Fit, catalogue: Catalogue, near: float) -> bool:
    def close(s: Suspect, t: Suspect) -> bool:
        xyz = catalogue[s.kind].xyz
        return s.kind == t.kind and float(np.linalg.norm(xyz[s.row] - xyz[t.row])) < near

    return unmatched(f, g, close) == ([], [])
