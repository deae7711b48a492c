"""A model to be solved again and again: in full, or reduced around one parameter point."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
import scipy.sparse as sp

from ..arrays import Floats
from ..data.parametric_model import Model
from ..eigen.normal_modes import Eigensolution, solve
from ..eigen.pencil import widest_gap
from ..eigen.warm_modes import Near
from .derivative_numbers import DERIVATIVES
from .eigenpair_derivatives import Sensitivities, Spectral, sensitivities
from .reduced_model import ReducedModel, ReducedModes, build_reduced


@dataclass(frozen=True, eq=False)
class FullOrder:
    """The model itself; `sensors` (n_sensor, n_free) read the vectors of `solve`.

    The static answers to `forces` (n_force, n_free) are in what is reduced of it. Where it is to
    be solved the modes may be known nearly. The factor that counts them is kept: one at a time
    answers, corrects and verifies.
    """

    model: Model
    sensors: sp.csr_matrix
    n_modes: int
    forces: sp.csr_matrix | None = None
    near: Near | None = None

    def solve(self, p: Floats) -> Eigensolution:
        """Find and check the modes."""
        return solve(self.model, n_modes=self.n_modes, p=p, keep_counter=True, near=self.near)

    def sensitivities(
        self, p: Floats, solution: Spectral, T: Floats, active: Sequence[int], with_shapes: bool
    ) -> Sensitivities:
        """Differentiate by the full matrices."""
        assert isinstance(solution, Eigensolution)
        at = self.sensors if with_shapes else None
        return sensitivities(self.model, p, solution, T, tuple(active), at)

    def damping_on_modes(self, p: Floats, solution: Spectral) -> tuple[Floats, Floats]:
        """Return D and H on the modes, each (n_mode, n_mode)."""
        X = solution.vectors
        return X.T @ (self.model.D(p) @ X), X.T @ (self.model.H(p) @ X)

    def changes_on_modes(self, p: Floats, solution: Spectral, active: Sequence[int]) -> Floats:
        """Return K', M', D' and H' on the modes, (4, len(active), n_mode, n_mode)."""
        X, model = solution.vectors, self.model
        parts = (model.dK, model.dM, model.dD, model.dH)
        return np.array([[X.T @ (part(k, p) @ X) for k in active] for part in parts])


@dataclass(frozen=True, eq=False)
class ReducedOrder:
    """The model on the modes of one parameter point and their static answers to parameters.

    `sensors` (n_sensor, n_basis) read the vectors of `solve`.
    """

    reduced: ReducedModel
    sensors: Floats
    n_modes: int

    @property
    def model(self) -> Model:
        """The full model that is reduced."""
        return self.reduced.model

    def with_modes(self, full: FullOrder, found: Eigensolution) -> ReducedOrder:
        """Return it with the modes of another point, found in full, in its basis."""
        return self._on(full, self.reduced.with_modes(found))

    def corrected(self, full: FullOrder, p: Floats) -> ReducedOrder:
        """Return it with what its modes at `p`, and some above, lack in its basis."""
        modes = self.reduced.solve(p, self.reduced.size).take(self._some_more)
        return self._on(full, self.reduced.corrected(p, modes))

    def near(self, p: Floats) -> Near:
        """Return what it knows of the full model's modes at `p`: those up to a gap, some above."""
        every = self.reduced.solve(p, self.reduced.size)
        rigid = every.rigid_body_modes
        above = rigid + (widest_gap(every.eigenvalues[rigid:], self.n_modes - rigid) or 0)
        some = every.take(max(above, self.n_modes) + DERIVATIVES.guard)
        vectors = self.reduced.vectors(some)[:, rigid:]
        return Near(every.eigenvalues[rigid:], vectors, self.reduced.solution.kept)

    @property
    def _some_more(self) -> int:
        return self.n_modes + DERIVATIVES.guard

    def _on(self, full: FullOrder, reduced: ReducedModel) -> ReducedOrder:
        return replace(self, reduced=reduced, sensors=reduced.project(full.sensors.T).T)

    def solve(self, p: Floats) -> ReducedModes:
        """Find the modes within the basis."""
        return self.reduced.solve(p, self.reduced.size).take(self.n_modes)

    def sensitivities(
        self, p: Floats, solution: Spectral, T: Floats, active: Sequence[int], with_shapes: bool
    ) -> Sensitivities:
        """Differentiate within the basis."""
        assert isinstance(solution, ReducedModes)
        at = self.sensors if with_shapes else None
        return self.reduced.sensitivities(p, T, tuple(active), at, solution)

    def damping_on_modes(self, p: Floats, solution: Spectral) -> tuple[Floats, Floats]:
        """Return D and H on the modes, each (n_mode, n_mode)."""
        q, r = solution.vectors, self.reduced
        return q.T @ r.damping.at(p) @ q, q.T @ r.loss.at(p) @ q

    def changes_on_modes(self, p: Floats, solution: Spectral, active: Sequence[int]) -> Floats:
        """Return K', M', D' and H' on the modes, (4, len(active), n_mode, n_mode)."""
        q, r = solution.vectors, self.reduced
        parts = (r.stiffness, r.mass, r.damping, r.loss)
        return np.array([q.T @ part.slopes(p, active) @ q for part in parts])


Order = FullOrder | ReducedOrder
"""Modes and their derivatives at any factors, seen by the sensors of a test."""


def reduce_around(
    full: FullOrder,
    p: Floats,
    solution: Eigensolution,
    active: Sequence[int],
    sketch: int | None = None,
) -> ReducedOrder:
    """Reduce a model around the factors `p` (n_parameter,), where its modes are `solution`.

    `active` are the parameters that will move; `sketch` is that of `build_reduced`.
    """
    count = len(solution.eigenvalues)
    elastic = np.arange(min(solution.rigid_body_modes, count - 1), count)
    reduced = build_reduced(
        full.model,
        p,
        elastic,
        tuple(active),
        solution=solution,
        forces=full.forces,
        sketch=sketch,
    )
    return ReducedOrder(reduced, reduced.project(full.sensors.T).T, count)
