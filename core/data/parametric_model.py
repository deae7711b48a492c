"""K, M and D as sums of constant matrices times scalar functions of the parameters."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from math import prod

import numpy as np
import scipy.sparse as sp

from ..arrays import Floats, frozen, require_shape
from ..errors import InputError, require_kind
from ..noun import Noun
from ..numerics.shared_pattern_sum import weighted_sum
from .dofs import Dofs
from .geometry import Geometry
from .parameter import Parameter


@dataclass(frozen=True)
class Factor:
    """A Chebyshev series in one parameter, on the interval `lower`..`upper`.

    A modulus or a density is the linear series that equals the parameter itself; a thickness
    takes a few terms. Value and derivative are summed by Clenshaw's recurrence.
    """

    parameter: int
    coefficients: tuple[float, ...]
    lower: float
    upper: float

    def value(self, p: Floats) -> float:
        """Return the factor at the parameter values `p`, (n_parameter,)."""
        x, c = self._unit(p), self.coefficients
        b, last = 0.0, 0.0
        for a in c[:0:-1]:
            b, last = a + 2.0 * x * b - last, b
        return c[0] + x * b - last

    def derivative(self, p: Floats) -> float:
        """Return the derivative by the factor's own parameter at `p`."""
        x, c = self._unit(p), self.coefficients
        b, last = 0.0, 0.0
        for n in range(len(c) - 1, 0, -1):
            b, last = n * c[n] + 2.0 * x * b - last, b
        return 2.0 * b / (self.upper - self.lower)

    def _unit(self, p: Floats) -> float:
        own = float(p[self.parameter])
        return (2.0 * own - self.lower - self.upper) / (self.upper - self.lower)


@dataclass(frozen=True, eq=False)
class Term(Noun):
    """A constant symmetric sparse matrix times a product of factors (none: constant)."""

    matrix: sp.csr_matrix
    factors: tuple[Factor, ...] = ()

    def coefficient(self, p: Floats) -> float:
        """Return the scalar that multiplies the matrix at `p`."""
        return prod(f.value(p) for f in self.factors)

    def coefficient_derivative(self, p: Floats, parameter: int) -> float:
        """Return the derivative of the scalar by parameter number `parameter`."""
        total = 0.0
        for f in self.factors:
            if f.parameter == parameter:
                total += f.derivative(p) * prod(g.value(p) for g in self.factors if g is not f)
        return total


@dataclass(frozen=True, eq=False)
class Model(Noun):
    """A finite-element model on its free (independent, unconstrained) degrees of freedom.

    K(p) = sum_t c_t(p) K_t, and likewise M(p), D(p) and H(p): equation (1) of the source paper
    written generally. A motion of frequency w takes the force (K + iH + iwD - w^2 M) u.

    Parameters
    ----------
    geometry : Geometry
        Nodes and elements, basic frame, deck length unit.
    dofs : Dofs
        All structural degrees of freedom, (n_dof): six a grid in basic axes, one a scalar point.
    expansion : (n_dof, n_free) sparse
        Displacements of all `dofs` from the free ones: constraints, rigid elements and
        displacement coordinate systems are in here.
    stiffness, mass : tuple of Term
        Matrices (n_free, n_free).
    parameters : tuple of Parameter
        What the factors of the terms refer to by position.
    free_labels : tuple of str, optional
        For messages, ``grid:component`` of each free degree of freedom, as the deck counts.
    warnings : tuple of str
        What the adapter left out or assumed.
    idle : tuple of int
        Nodes of which a translation is fixed for want of stiffness, not by the user.
    rigid_mass : tuple of (6, 6) float
        Of each term of `mass` what rigid motions about the origin of the basic frame move, fixed
        points included. Empty where that is not known.
    damping, loss : tuple of Term
        Viscous damping D, and H, the structural one: stiffness times loss factor. Empty where the
        model says nothing of it.
    ratios : callable, optional
        Damping of modes by their frequencies [Hz] besides, fractions of critical, (n,) of (n,).
    """

    geometry: Geometry
    dofs: Dofs
    expansion: sp.csr_matrix
    stiffness: tuple[Term, ...]
    mass: tuple[Term, ...]
    parameters: tuple[Parameter, ...] = ()
    free_labels: tuple[str, ...] = ()
    warnings: tuple[str, ...] = ()
    idle: tuple[int, ...] = ()
    rigid_mass: tuple[Floats, ...] = ()
    damping: tuple[Term, ...] = ()
    loss: tuple[Term, ...] = ()
    ratios: Callable[[Floats], Floats] | None = None

    def __post_init__(self) -> None:
        require_kind(self.geometry, Geometry, "geometry of Model")
        require_kind(self.dofs, Dofs, "dofs of Model")
        for name in ("stiffness", "mass", "parameters", "damping", "loss"):
            require_kind(getattr(self, name), tuple, f"{name} of Model")
        require_shape(self.expansion, (len(self.dofs), "n"), "the expansion")
        for t in (*self.stiffness, *self.mass, *self.damping, *self.loss):
            require_kind(t, Term, "a part of stiffness, mass or damping")
            require_shape(t.matrix, (self.n_free, self.n_free), "a matrix term")
        for q in self.parameters:
            require_kind(q, Parameter, "a parameter of Model")
        names = [q.name for q in self.parameters]
        repeated = sorted({name for name in names if names.count(name) > 1})
        if repeated:
            raise InputError(
                f"more than one parameter is called '{repeated[0]}'; give each its own name"
            )

    @property
    def damped(self) -> bool:
        """Whether the model says anything of its damping."""
        return bool(self.damping or self.loss or self.ratios)

    @property
    def n_free(self) -> int:
        """Number of free degrees of freedom."""
        return int(self.expansion.shape[1])

    @property
    def deck_point(self) -> Floats:
        """The parameter values of the deck as it is: ones, (n_parameter,)."""
        return frozen(np.ones(len(self.parameters)))

    def K(self, p: Floats | None = None) -> sp.csr_matrix:
        """Return K at the parameter values `p` (default: the deck), (n_free, n_free)."""
        return _sum(self.stiffness, self.deck_point if p is None else p, self.n_free)

    def M(self, p: Floats | None = None) -> sp.csr_matrix:
        """Return M at the parameter values `p` (default: the deck), (n_free, n_free)."""
        return _sum(self.mass, self.deck_point if p is None else p, self.n_free)

    def D(self, p: Floats) -> sp.csr_matrix:
        """Return D at the parameter values `p`, (n_free, n_free)."""
        return _sum(self.damping, p, self.n_free)

    def H(self, p: Floats) -> sp.csr_matrix:
        """Return H at the parameter values `p`, (n_free, n_free)."""
        return _sum(self.loss, p, self.n_free)

    def dK(self, parameter: int, p: Floats) -> sp.csr_matrix:
        """Return the derivative of K by one parameter at `p`, (n_free, n_free)."""
        return _sum_derivative(self.stiffness, p, parameter, self.n_free)

    def dM(self, parameter: int, p: Floats) -> sp.csr_matrix:
        """Return the derivative of M by one parameter at `p`, (n_free, n_free)."""
        return _sum_derivative(self.mass, p, parameter, self.n_free)

    def dD(self, parameter: int, p: Floats) -> sp.csr_matrix:
        """Return the derivative of D by one parameter at `p`, (n_free, n_free)."""
        return _sum_derivative(self.damping, p, parameter, self.n_free)

    def dH(self, parameter: int, p: Floats) -> sp.csr_matrix:
        """Return the derivative of H by one parameter at `p`, (n_free, n_free)."""
        return _sum_derivative(self.loss, p, parameter, self.n_free)


def _sum(terms: tuple[Term, ...], p: Floats, n: int) -> sp.csr_matrix:
    return weighted_sum(((t.coefficient(p), t.matrix) for t in terms), n)


def _sum_derivative(terms: tuple[Term, ...], p: Floats, parameter: int, n: int) -> sp.csr_matrix:
    return weighted_sum(((t.coefficient_derivative(p, parameter), t.matrix) for t in terms), n)
