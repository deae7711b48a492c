"""One kind of effect at every place where it could be."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from typing import Any, Protocol

import numpy as np
import scipy.sparse as sp

from ..arrays import Floats, Ints
from .basis import Basis

_RIGID = 1e-4
"""ω² m times the flexibility that an attached mass has at least."""


class Rows(Protocol):
    """Rows of candidates on a basis; an array (n, q, r), or something that makes them."""

    def __getitem__(self, rows: Ints) -> Floats:
        """Return the rows of some candidates, (n, q, r)."""
        ...


class Law(Protocol):
    """How the magnitudes enter: the matrix of an effect is ``value(θ) · A`` with θ = ln sizes."""

    @property
    def on(self) -> str:
        """Which matrix it changes, ``K`` or ``M``."""
        ...

    def value(self, theta: Floats, rows: Ints) -> Floats:
        """Return the factors on the q rows of `rows` at `theta` (n, t): (n, q or 1)."""
        ...

    def slope(self, theta: Floats, rows: Ints) -> Floats:
        """Return their derivatives by each θ, (n, t, q or 1)."""
        ...


@dataclass(frozen=True)
class MassLaw:
    """A mass m = e^θ adds m·A to M."""

    on: str = "M"

    def value(self, theta: Floats, rows: Ints) -> Floats:
        """Return m."""
        return np.asarray(np.exp(theta))

    def slope(self, theta: Floats, rows: Ints) -> Floats:
        """Return dm/dθ."""
        return np.asarray(np.exp(theta)[:, :, None])


@dataclass(frozen=True, eq=False)
class AttachedLaw:
    """A mass m = e^θ on a basis that lacks the flexibility `missing` (n, q) where it sits.

    Each of the q directions gets a coordinate of its own: m on a spring 1/missing, which is what
    the mass is to a structure that moves as the basis can. `top` is an eigenvalue above those of
    interest: springs so stiff that they do not matter below it stay finite.
    """

    missing: Rows
    top: float
    on: str = "A"

    def value(self, theta: Floats, rows: Ints) -> Floats:
        """Return m."""
        return np.asarray(np.exp(theta))

    def slope(self, theta: Floats, rows: Ints) -> Floats:
        """Return dm/dθ."""
        return np.asarray(np.exp(theta)[:, :, None])

    def springs(self, theta: Floats, rows: Ints) -> Floats:
        """Return the stiffness between the structure and the mass, (n, q)."""
        rigid = _RIGID / (np.exp(theta) * self.top)
        return np.asarray(1.0 / (self.missing[rows] + rigid))

    def springs_slope(self, theta: Floats, rows: Ints) -> Floats:
        """Return the derivatives of these stiffnesses by each θ, (n, t, q)."""
        rigid = _RIGID / (np.exp(theta) * self.top)
        return np.asarray(rigid * self.springs(theta, rows) ** 2)[:, None, :]


@dataclass(frozen=True)
class FactorLaw:
    """A stiffness factor f = e^θ on some elements adds (f − 1)·A to K."""

    on: str = "K"

    def value(self, theta: Floats, rows: Ints) -> Floats:
        """Return f − 1."""
        return np.asarray(np.expm1(theta))

    def slope(self, theta: Floats, rows: Ints) -> Floats:
        """Return df/dθ."""
        return np.asarray(np.exp(theta)[:, :, None])


@dataclass(frozen=True, eq=False)
class SpringLaw:
    """A spring k = e^θ adds k·A to K.

    On a basis that lacks the flexibility `missing` (n, 1) it is worth k / (1 + k·missing).
    """

    missing: Rows
    on: str = "K"

    def value(self, theta: Floats, rows: Ints) -> Floats:
        """Return what the spring is worth."""
        k = np.exp(theta)
        return np.asarray(k / (1.0 + k * self.missing[rows]))

    def slope(self, theta: Floats, rows: Ints) -> Floats:
        """Return its derivative by θ."""
        k = np.exp(theta)
        return np.asarray(k / (1.0 + k * self.missing[rows]) ** 2)[:, None, :]


@dataclass(frozen=True, eq=False)
class ReleaseLaw:
    """A connection that was rigid gets the stiffness k = f e^θ.

    Each freed coordinate, condensed, takes f q qᵀ / (e^θ + d) from K, with q the forces that its
    unit displacement puts on the rest and d its own stiffness, both for the deck as it is, and f
    the factor by which the known parameters change them: a release all but cancels d, so that it
    has to follow. `own` (n, q) holds d, `elasticity` (n, q, n_parameter) ∂ln d/∂ln p, `log_p`
    (n_parameter,) where the parameters stand.
    """

    own: Floats
    elasticity: Floats
    log_p: Floats
    on: str = "K"

    def factor(self, rows: Ints) -> Floats:
        """Return f, (n, q)."""
        return np.asarray(np.exp(self.elasticity[rows] @ self.log_p))

    def value(self, theta: Floats, rows: Ints) -> Floats:
        """Return −f/(e^θ + d)."""
        return np.asarray(-self.factor(rows) / (np.exp(theta) + self.own[rows]))

    def slope(self, theta: Floats, rows: Ints) -> Floats:
        """Return the derivative by θ."""
        k = np.exp(theta)
        return np.asarray(self.factor(rows) * k / (k + self.own[rows]) ** 2)[:, None, :]

    def by_parameter(self, theta: Floats, rows: Ints, parameter: int) -> Floats:
        """Return the derivative by ln p of a known parameter."""
        return np.asarray(self.elasticity[rows, :, parameter] * self.value(theta, rows))


@dataclass(frozen=True, eq=False)
class Candidates:
    """All places of one kind of effect.

    Parameters
    ----------
    kind : str
        One of the fixed words of the interface.
    xyz : (n, 3) float
        Where, deck units.
    law : Law
    trials : (n_trial, t) float
        Values of θ that the search tries at every place, one θ for each of the t magnitudes.
    root : (n · q, n_free) sparse
        A of place i is the sum of the outer products of its q rows.
    rows_each : int
        q.
    where : tuple of dict
        ``grids`` or ``elements`` of each place, ``components`` where the kind has them.
    typical, spread : (t,) float
        Prior of θ: normal with these means and standard deviations.
    steps : (t,) float
        What is a step of each θ where a search moves it.
    """

    kind: str
    xyz: Floats
    law: Law
    trials: Floats
    root: sp.csr_matrix
    rows_each: int
    where: tuple[dict[str, Any], ...]
    typical: Floats
    spread: Floats
    steps: Floats = field(default_factory=lambda: np.ones(1))
    extra: dict[str, Any] = field(default_factory=dict)

    def __len__(self) -> int:
        return len(self.xyz)

    def surprise(self, theta: Floats) -> Floats:
        """Return −2 ln of the prior density of θ (n, t), up to a constant, (n,)."""
        return np.asarray(np.sum(((theta - self.typical) / self.spread) ** 2, axis=-1))

    def around(self, theta: Sequence[float], changes: Floats) -> Floats:
        """Return θ (t,) with each magnitude in turn moved by `changes` (n,) steps, (≤ n·t, t)."""
        moves = changes[:, None, None] * np.diag(self.steps)
        return np.asarray(theta + np.unique(moves.reshape(-1, len(self.steps)), axis=0))

    def factors(self, basis: Basis) -> Rows:
        """Return the rows of `root` on the basis, (n, q, r)."""
        U = np.asarray(self.root @ basis.vectors)
        return U.reshape(len(self), self.rows_each, basis.size)

    def law_at(
        self,
        rows: Ints,
        missing: Floats | None,
        log_p: Floats | None = None,
        top: float = 0.0,
    ) -> Law:
        """Return the law of some rows alone.

        Parameters
        ----------
        rows : (n,) int
        missing : (n, q) float or None
            Flexibility of each row that the basis does not have. What is released or attached on
            a basis that is too stiff by it would do too little.
        log_p : (n_parameter,) float, optional
            Where the parameters stand.
        top : float
            An eigenvalue above those of interest.
        """
        law = self.law
        if isinstance(law, MassLaw) and missing is not None:
            return AttachedLaw(missing, top)
        if isinstance(law, SpringLaw):
            lost = law.missing[rows]
            return SpringLaw(lost if missing is None else lost + missing)
        if isinstance(law, ReleaseLaw):
            own = law.own[rows]
            left = own if missing is None else np.maximum(own - missing, 1e-6 * own)
            at = law.log_p if log_p is None else log_p[: len(law.log_p)]
            return ReleaseLaw(left, law.elasticity[rows], at)
        return law

    @property
    def needs_flexibility(self) -> bool:
        """Whether the law depends on what a basis lacks."""
        return self.rows_each > 0 and isinstance(self.law, MassLaw | SpringLaw | ReleaseLaw)

    def full(self, row: int) -> sp.csr_matrix:
        """Return A of one place, (n_free, n_free)."""
        part = self.root[row * self.rows_each : (row + 1) * self.rows_each]
        return (part.T @ part).tocsr()


@dataclass(frozen=True)
class Suspect:
    """One candidate with its magnitudes: kind (number in the catalogue), place, θ of each."""

    kind: int
    row: int
    theta: tuple[float, ...]

    def moved(self, theta: Floats) -> Suspect:
        """Return the candidate with magnitudes `theta` (t,)."""
        return replace(self, theta=tuple(float(v) for v in theta))


def magnitudes(suspects: Sequence[Suspect]) -> Floats:
    """Return θ of all suspects one after the other, (n_magnitude,)."""
    return np.array([v for s in suspects for v in s.theta], dtype=float)


def changed(suspects: Sequence[Suspect], step: Floats) -> tuple[Suspect, ...]:
    """Return the suspects with `step` (n_magnitude,) added to their magnitudes."""
    ends = np.cumsum([len(s.theta) for s in suspects])
    return tuple(
        s.moved(s.theta + d) for s, d in zip(suspects, np.split(step, ends)[:-1], strict=True)
    )


Catalogue = Sequence[Candidates]
