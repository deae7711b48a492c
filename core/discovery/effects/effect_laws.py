"""How the magnitudes of an effect enter the matrices."""

from __future__ import annotations

from abc import ABC, abstractmethod
from dataclasses import dataclass, replace
from typing import ClassVar, Protocol

import numpy as np

from ...arrays import Floats, Ints
from .effect_numbers import EFFECTS


class Rows(Protocol):
    """Rows of candidates on a basis; an array (n, q, r), or something that makes them."""

    def __getitem__(self, rows: Ints) -> Floats:
        """Return the rows of some candidates, (n, q, r)."""
        ...


class Law(ABC):
    """How the magnitudes enter: the matrix of an effect is ``value(θ) · A`` with θ = ln sizes.

    A law derives from this class.

    Attributes
    ----------
    on : str
        Which matrix it changes, ``K`` or ``M``; ``A`` where each of its rows gets a coordinate of
        its own, of mass `value` on a spring of `flexibility`.
    shared : bool
        Whether its rows share the flexibility that a basis lacks: what is `missing` is then
        (n, q, q).
    turn : (n, q, q) float or None
        Its rows are this times those of the candidates.
    """

    on: ClassVar[str]
    shared: ClassVar[bool] = False
    turn: Floats | None = None

    @property
    def acts_on(self) -> str:
        """The matrix that it acts like a change of, ``K`` or ``M``."""
        return "M" if self.on == "A" else self.on

    @abstractmethod
    def value(self, theta: Floats, rows: Ints) -> Floats:
        """Return the factors on the q rows of `rows` at `theta` (n, t): (n, q or 1)."""

    @abstractmethod
    def slope(self, theta: Floats, rows: Ints) -> Floats:
        """Return their derivatives by each θ, (n, t, q or 1)."""

    def flexibility(self, theta: Floats, rows: Ints) -> Floats:
        """Return that between the structure and coordinates of its own, (n, q or 1)."""
        raise NotImplementedError

    def flexibility_slope(self, theta: Floats) -> Floats:
        """Return its derivatives by each θ, (n, t)."""
        raise NotImplementedError

    def by_parameter(self, theta: Floats, rows: Ints, parameter: int) -> Floats | None:
        """Return the derivative of the value by ln p of a known parameter, None where it is nil."""
        return None

    def on_basis(self, rows: Ints, missing: Floats | None, log_p: Floats, top: float) -> Law:
        """Return the law of some rows alone on a basis, as it is where that changes nothing.

        Parameters
        ----------
        rows : (n,) int
        missing : (n, q) or, `shared`, (n, q, q) float or None
            Flexibility of each row that the basis does not have. What is released or attached on
            a basis that is too stiff by it would do too little.
        log_p : (n_parameter,) float
            Where the known parameters stand.
        top : float
            An eigenvalue above those of interest.
        """
        return self


class _Mass(Law):
    """A mass m = e^θ."""

    def value(self, theta: Floats, rows: Ints) -> Floats:
        """Return m."""
        return np.asarray(np.exp(theta[:, :1]))

    def slope(self, theta: Floats, rows: Ints) -> Floats:
        """Return dm/dθ."""
        return np.asarray(np.exp(theta)[:, :, None])


@dataclass(frozen=True)
class MassLaw(_Mass):
    """A mass m = e^θ adds m·A to M."""

    on = "M"

    def on_basis(self, rows: Ints, missing: Floats | None, log_p: Floats, top: float) -> Law:
        """Return the mass on the spring that the basis lacks."""
        return self if missing is None else AttachedLaw(missing, top)


@dataclass(frozen=True, eq=False)
class AttachedLaw(_Mass):
    """A mass m = e^θ on a basis that lacks the flexibility `missing` (n, q) where it sits.

    Each of the q directions gets a coordinate of its own: m on a spring 1/missing, which is what
    the mass is to a structure that moves as the basis can. `top` is an eigenvalue above those of
    interest: springs so stiff that they do not matter below it stay finite.
    """

    missing: Rows
    top: float
    on = "A"

    def on_basis(self, rows: Ints, missing: Floats | None, log_p: Floats, top: float) -> Law:
        """Return the mass on the spring that this basis lacks."""
        return self if missing is None else AttachedLaw(missing, top)

    def own(self, theta: Floats) -> Floats:
        """Return the flexibility of its spring on any basis, (n, 1)."""
        return np.asarray(EFFECTS.rigid / (np.exp(theta) * self.top))

    def flexibility(self, theta: Floats, rows: Ints) -> Floats:
        """Return what the basis lacks and the spring's own."""
        return np.asarray(self.missing[rows] + self.own(theta))

    def flexibility_slope(self, theta: Floats) -> Floats:
        """Return that of the spring's own."""
        return -self.own(theta)


@dataclass(frozen=True, eq=False)
class TunedLaw(AttachedLaw):
    """A mass m = e^θ₁ on a spring that tunes it to f = e^θ₂ Hz, with no top.

    On a basis that lacks flexibility where it sits its spring m (2πf)² is in line with that. It is
    an absorber or, alike in all directions and tuned above the measured band, the mount of a mass:
    brackets give, and so does the skin between the grids of a shell, which a load at a point of
    its mesh does not feel.
    """

    def on_basis(self, rows: Ints, missing: Floats | None, log_p: Floats, top: float) -> Law:
        """Return the spring in line with what this basis lacks."""
        return TunedLaw(np.zeros((len(rows), 1)) if missing is None else missing, top)

    def slope(self, theta: Floats, rows: Ints) -> Floats:
        """Return dm/dθ."""
        m = np.exp(theta[:, :1])
        return np.stack([m, np.zeros_like(m)], axis=1)

    def own(self, theta: Floats) -> Floats:
        """Return 1/(m (2πf)²)."""
        return np.asarray(np.exp(-theta[:, :1] - 2.0 * theta[:, 1:]) / (2.0 * np.pi) ** 2)

    def flexibility_slope(self, theta: Floats) -> Floats:
        """Return those by ln m and ln f."""
        return np.hstack([-self.own(theta), -2.0 * self.own(theta)])


@dataclass(frozen=True, eq=False)
class FactorLaw(Law):
    """A stiffness factor f = e^θ on some elements adds (f − 1) g·A to K.

    A is as the deck has it, g = exp(elasticity · ln p) by how much the known parameters change it:
    f counts from where they stand, as in the deck that is written, and never takes more than
    there is. `elasticity` (n, n_parameter) is ∂ln A/∂ln p of each place, None where A stays as it
    is; `log_p` (n_parameter,).
    """

    elasticity: Floats | None = None
    log_p: Floats | None = None
    on = "K"

    def on_basis(self, rows: Ints, missing: Floats | None, log_p: Floats, top: float) -> Law:
        """Return the law where the parameters stand."""
        return self if self.elasticity is None else FactorLaw(self.elasticity[rows], log_p)

    def value(self, theta: Floats, rows: Ints) -> Floats:
        """Return (f − 1) g."""
        return np.asarray(np.expm1(theta) * self._followed(rows))

    def slope(self, theta: Floats, rows: Ints) -> Floats:
        """Return its derivative by θ."""
        return np.asarray((np.exp(theta) * self._followed(rows))[:, :, None])

    def by_parameter(self, theta: Floats, rows: Ints, parameter: int) -> Floats | None:
        """Return the derivative by ln p of a known parameter."""
        if self.elasticity is None or parameter >= self.elasticity.shape[1]:
            return None
        return np.asarray(self.elasticity[rows, parameter, None] * self.value(theta, rows))

    def _followed(self, rows: Ints) -> Floats:
        """Return g, (n, 1)."""
        if self.elasticity is None or self.log_p is None:
            return np.ones((len(rows), 1))
        known = self.elasticity[rows]
        return np.asarray(np.exp(known @ self.log_p[: known.shape[1]])[:, None])


@dataclass(frozen=True, eq=False)
class SpringLaw(Law):
    """A spring k = e^θ adds k·A to K.

    On a basis that lacks the flexibility `missing` (n, 1) it is worth k / (1 + k·missing).
    """

    missing: Rows
    on = "K"

    def on_basis(self, rows: Ints, missing: Floats | None, log_p: Floats, top: float) -> Law:
        """Return the spring in line with what this basis lacks."""
        return SpringLaw(np.zeros((len(rows), 1)) if missing is None else missing)

    def value(self, theta: Floats, rows: Ints) -> Floats:
        """Return what the spring is worth."""
        k = np.exp(theta)
        return np.asarray(k / (1.0 + k * self.missing[rows]))

    def slope(self, theta: Floats, rows: Ints) -> Floats:
        """Return its derivative by θ."""
        k = np.exp(theta)
        return np.asarray(k / (1.0 + k * self.missing[rows]) ** 2)[:, None, :]


@dataclass(frozen=True, eq=False)
class ReleaseLaw(Law):
    """A connection that was rigid gets the stiffness k = f e^θ.

    Each freed coordinate, condensed, takes f q qᵀ / (e^θ + d) from K, with q the forces that its
    unit displacement puts on the rest and d its own stiffness, both for the deck as it is, and f
    the factor by which the known parameters change them: a release all but cancels d, so that it
    has to follow. `own` (n, q) holds d, `elasticity` (n, q, n_parameter) ∂ln d/∂ln p, `log_p`
    (n_parameter,) where the parameters stand, `base` where d was found. The first `free`
    coordinates get no stiffness.
    """

    own: Floats
    elasticity: Floats
    log_p: Floats
    free: int = 0
    turn: Floats | None = None
    base: Floats | float = 0.0
    on = "K"
    shared = True

    def on_basis(self, rows: Ints, missing: Floats | None, log_p: Floats, top: float) -> Law:
        """Return the release, parameters where they stand, by coordinates that are sprung alone."""
        own, q = self.own[rows], self.own.shape[1]
        if missing is None:
            return replace(self, own=own, elasticity=self.elasticity[rows], log_p=log_p)
        left = -missing
        left[:, np.arange(q), np.arange(q)] += own
        least = EFFECTS.least_left * own.max(axis=1, keepdims=True)
        d, W = directions(left, self.free)
        weight = W**2 * own[:, None, :]
        elasticity = weight @ self.elasticity[rows] / weight.sum(axis=2, keepdims=True)
        return ReleaseLaw(np.maximum(d, least), elasticity, log_p, self.free, W, self.base)

    def factor(self, rows: Ints) -> Floats:
        """Return f, (n, q)."""
        known = self.elasticity[rows]
        return np.asarray(np.exp(known @ (self.log_p[: known.shape[-1]] - self.base)))

    def _stiffness(self, theta: Floats) -> Floats:
        """Return e^θ of each coordinate, nil of the free ones, (n, q)."""
        return np.asarray(np.exp(theta) * (np.arange(self.own.shape[1]) >= self.free))

    def value(self, theta: Floats, rows: Ints) -> Floats:
        """Return −f/(e^θ + d)."""
        return np.asarray(-self.factor(rows) / (self._stiffness(theta) + self.own[rows]))

    def slope(self, theta: Floats, rows: Ints) -> Floats:
        """Return the derivative by θ."""
        k = self._stiffness(theta)
        return np.asarray(self.factor(rows) * k / (k + self.own[rows]) ** 2)[:, None, :]

    def by_parameter(self, theta: Floats, rows: Ints, parameter: int) -> Floats | None:
        """Return the derivative by ln p of a known parameter."""
        if parameter >= self.elasticity.shape[-1]:
            return None
        return np.asarray(self.elasticity[rows, :, parameter] * self.value(theta, rows))


def directions(A: Floats, free: int) -> tuple[Floats, Floats]:
    """Take stiffness matrices A (n, q, q) apart into coordinates that are freed one by one.

    The first `free` coordinates are condensed out, then each part is turned to its principal
    directions: the inverse of A + k S, with S nil on the first `free` coordinates and the
    identity on the others, is Wᵀ diag(1 / (d + k s)) W for every k, d (n, q) and W (n, q, q).
    """
    n, q, _ = A.shape
    d, W = np.empty((n, q)), np.zeros((n, q, q))
    rest = A[:, free:, free:]
    d[:, :free], R = np.linalg.eigh(A[:, :free, :free])
    W[:, :free, :free] = R.transpose(0, 2, 1)
    if free:
        side = A[:, free:, :free]
        carried = np.matmul(np.matmul(side, R) / d[:, None, :free], R.transpose(0, 2, 1))
        rest = rest - np.matmul(carried, side.transpose(0, 2, 1))
    d[:, free:], R = np.linalg.eigh(rest)
    W[:, free:, free:] = R.transpose(0, 2, 1)
    if free:
        W[:, free:, :free] = -np.matmul(W[:, free:, free:], carried)
    return d, W
