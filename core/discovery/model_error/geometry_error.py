"""A structure of another shape than drawn, on the modes of a hypothesis.

Stiffness and mass of the deck with its nodes moved by +h and -h along a shape give those of any
amplitude a to second order. A flat plate that is bowed strains in its plane as it bends, in
proportion to a, and what gives way to that is in no mode of the measured band: the static answer
to it, A⁻¹ K₁ φ less what the modes have of it, goes with each mode, times -a. So a shallow shell
does not lock on the modes of the plate (residual flexibility: MacNeal 1971, Computers and
Structures 1, 581).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import scipy.sparse as sp

from ...arrays import Floats
from ...data.parametric_model import Factor
from ..likelihood.hypothesis import Prior, Problem
from ..reduction.elements_and_supports import Structure
from ..reduction.residual_flexibility import Compliance
from .diffuse_fit import Judged
from .geometry_shapes import Shape
from .model_error_numbers import MODEL_ERROR

_ORDERS = (0.0, 1.0), (0.5, 0.0, 0.5)
"""Chebyshev series of x and of x²."""


@dataclass(frozen=True, eq=False)
class Deviation:
    """A shape on a basis.

    Parameters
    ----------
    shape : Shape
    unit : float
        Length of a standard deviation of its amplitude beforehand.
    stiffness, mass : (2, r, r) float
        What an amplitude of one unit adds to first and to second order.
    """

    shape: Shape
    unit: float
    stiffness: Floats
    mass: Floats


@dataclass(frozen=True)
class Misshapen:
    """What a structure is that is of another shape than drawn.

    Parameters
    ----------
    name : str
        As ``bowed``.
    amplitude : float
        How far it is, a length.
    error : float
        The diffuse error that is left.
    score : float
        ln of the evidence, the choice of shapes paid for.
    """

    name: str
    amplitude: float
    error: float
    score: float


class Movable:
    """A structure whose nodes may move, on mass-orthonormal modes (n_free, r), lowest first."""

    def __init__(self, structure: Structure, modes: Floats, compliance: Compliance) -> None:
        self._structure, self._modes = structure, modes
        self._compliance, self._inverse = compliance, compliance.on(modes)
        self._now = structure.model.K(), structure.model.M()
        self._products = tuple(A @ modes for A in self._now)
        self._unit = MODEL_ERROR.shape * structure.model.geometry.size

    def deviation(self, shape: Shape) -> Deviation:
        """Return a shape on the modes."""
        moved = self._structure.moved
        assert moved is not None
        V, h = self._modes, MODEL_ERROR.shape_step
        by = h * self._unit * shape.by
        (K, M), (k, m) = moved(by), moved(-by)
        stiffness, mass = (
            (0.5 * (there - back) / h, (0.5 * (there + back) - now) / h**2)
            for there, back, now in zip((K @ V, M @ V), (k @ V, m @ V), self._products, strict=True)
        )
        loads = stiffness[0]
        W = V @ (self._inverse @ (V.T @ loads)) - self._compliance.responses(loads)
        pairs = zip(self._now, (stiffness, mass), strict=True)
        return Deviation(shape, self._unit, *(_to_second(A, V, W, *own) for A, own in pairs))


def _to_second(A: sp.csr_matrix, V: Floats, W: Floats, first: Floats, second: Floats) -> Floats:
    """Return (V + aW)ᵀ A(a) (V + aW) to first and second order of a, (2, r, r).

    `first` and `second` (n, r) are what A(a) gives of V to these orders.
    """
    AW = A @ W
    a, b = AW.T @ V, W.T @ first
    return np.array([V.T @ first + a + a.T, V.T @ second + b + b.T + W.T @ AW])


def with_deviation(problem: Problem, d: Deviation) -> Problem:
    """Return a problem whose known parameters are followed by the amplitude of a shape.

    It may be on the first modes of the problem alone.
    """
    n, u = len(problem.prior.spread) - 1, MODEL_ERROR.shape_unit
    most = np.array([MODEL_ERROR.shape_most * u])
    b, orders = problem.basis, [tuple(c / u**k for c in s) for k, s in enumerate(_ORDERS, 1)]
    factors = [Factor(n, series, 0.0, 2.0) for series in orders]
    stiffness, mass = (
        matrices.plus([np.pad(A, (0, b.size - len(A))) for A in own], factors)
        for matrices, own in ((b.stiffness, d.stiffness), (b.mass, d.mass))
    )
    return problem.with_more(Prior(np.array([u]), -most, most), stiffness, mass)


def misshapen(d: Deviation, found: Judged, choices: int) -> Misshapen:
    """Return what a structure is by a fit of a problem with one of so many shapes."""
    x = float(np.expm1(found.fit.nuisance[-2]))
    name = d.shape.name if x > 0.0 else d.shape.reverse
    amplitude = d.unit * abs(x) / MODEL_ERROR.shape_unit
    return Misshapen(name, amplitude, found.diffuse.error, found.evidence - float(np.log(choices)))
