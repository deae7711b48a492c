"""The sensors of a test, to be judged by one model after the other."""

from __future__ import annotations

import numpy as np
import scipy.sparse as sp

from ...arrays import Floats
from ...correlation.comparison import Placed
from ...correlation.mac import realised
from ...data.dofs import Dofs
from ...data.parametric_model import Model
from ...sensors.sensor_map import observe
from ..likelihood.hypothesis import Fit, Problem
from .diagnosis import Verdicts, judge_sensors
from .leave_one_out import Span, Survey


class Bench:
    """A test laid onto a model, with what its nodes would read in every direction.

    Parameters
    ----------
    placed : Placed
    model : Model
        The deck's.
    """

    def __init__(self, placed: Placed, model: Model) -> None:
        self.survey = survey_of(placed)
        self._along = placed.observation.matrix
        self._around = _every_direction(placed, model)

    def judged(self, motion: Floats, eigenvalues: Floats) -> Verdicts:
        """Judge by shapes on all analysis dofs, (n_dof, n)."""
        hz = np.sqrt(np.maximum(eigenvalues, 0.0)) / (2.0 * np.pi)
        around = np.asarray(self._around @ motion).reshape(-1, 3, motion.shape[1])
        return judge_sensors(self.survey, Span(np.asarray(self._along @ motion), around, hz))

    def judged_by(self, problem: Problem, state: Fit) -> Verdicts:
        """Judge by the shapes of a fit."""
        return self.judged(
            problem.basis.motion @ state.vectors[: problem.basis.size], state.eigenvalues
        )


def survey_of(placed: Placed) -> Survey:
    """Return the readings of a test on a model, complex shapes turned to real ones."""
    seen = placed.observation
    return Survey(
        realised(placed.test.shapes),
        placed.test.frequencies_hz,
        seen.sensors.node,
        seen.sensors.component,
        seen.sensors.axis,
        seen.xyz,
        None if placed.errors is None else placed.errors.shape,
    )


def _every_direction(placed: Placed, model: Model) -> sp.csr_matrix:
    """Map of sensors along all three axes at each node, (3 n_node, n_dof)."""
    _, first = np.unique(placed.observation.sensors.node, return_index=True)
    nodes = placed.observation.sensors.node[np.sort(first)]
    n = len(nodes)
    along = Dofs(np.repeat(nodes, 3), np.tile([1, 2, 3], n), np.tile(np.eye(3), (n, 1)))
    at = observe(model.geometry, model.dofs, placed.test_geometry, along, motion=model.expansion)
    return at.matrix
