"""A dashpot weighed on the model that a search ended with."""

from dataclasses import dataclass, replace

import numpy as np

from ...arrays import Floats, Numbers
from ...correlation.comparison import Placed
from ...correlation.mac import principal, realised
from ...correlation.mode_errors import ModeErrors, mode_errors
from ..effects.local_damper import dashpots
from ..effects.structure_points import Axes
from ..likelihood.complex_modes import Oriented, oriented
from ..likelihood.hypothesis import Fit, Problem
from ..likelihood.mode_likelihood import Evidence
from ..likelihood.request import Request
from .damped_model import Damped, damped
from .damper_numbers import DAMPERS
from .damper_search import DamperFound, DampingEvidence, find_damper


@dataclass(frozen=True, eq=False)
class Weighed:
    """A dashpot weighed at every place.

    Parameters
    ----------
    found : DamperFound
    places : Axes
    modes : Oriented
    u : (n_place, n) float
        Motion of the places in the coordinates of `modes`.
    damped : Damped
        The model with the dashpot at its best place.
    vectors : (n_basis, n) float
        Undamped modes of the model that `damped` speaks of, on the basis.
    """

    found: DamperFound
    places: Axes
    modes: Oriented
    u: Floats
    damped: Damped
    vectors: Floats

    @property
    def heavy(self) -> bool:
        """Whether the dashpot is likely and moves modes that others are looked for by."""
        return self.found.exists > DAMPERS.likely and len(self.damped.moved) > 0


def weighed(request: Request, problem: Problem, state: Fit) -> Weighed | None:
    """Weigh a dashpot at sensors that are sound, given a fit on the basis of the problem."""
    structure, test = request.structure, request.placed.test
    V = state.vectors[: problem.basis.size]
    sensors = np.asarray(request.placed.observation.matrix @ (problem.basis.motion @ V))
    shapes = principal(test.shapes)
    real = np.asarray(shapes.real)
    unit = real / np.maximum(np.linalg.norm(real, axis=0), np.finfo(float).tiny)
    e = Evidence(test.frequencies_hz, unit, problem.whole.noise)
    modes = oriented(e, state.eigenvalues, sensors, problem.columns)
    own = sensors @ modes.turn
    places = dashpots(structure)
    free = problem.basis.vectors @ V
    motion = np.asarray(places.root @ free)
    known = np.zeros((V.shape[1],) * 2)
    if structure.damping is not None:
        known = np.asarray(free.T @ (structure.damping @ free))
    u = motion @ modes.turn
    low = np.setdiff1d(np.arange(V.shape[1]), modes.above)
    omega = np.sqrt(np.maximum(state.eigenvalues[low], 0.0))

    def exact(row: int, c: float, level: float) -> Damped:
        w = motion[row, low]
        D = known[np.ix_(low, low)] + c * np.outer(w, w) + np.diag(2.0 * level * omega)
        return damped(e, shapes, omega, sensors[:, low], D)

    imaginary = _imaginary(shapes, own[:, : modes.count])
    evidence = DampingEvidence(test.damping, imaginary, e.noise.independent)
    turned = modes.turn.T @ known @ modes.turn
    found = find_damper(evidence, modes, u, own, turned, exact)
    if found is None:
        return None
    level = float(np.exp(np.mean(np.log(found.level_with))))
    best = exact(int(found.rows[0]), float(np.exp(found.log_size[0])), level)
    return Weighed(found, places, modes, u, best, V[:, low])


def taken_off(w: Weighed, placed: Placed, problem: Problem) -> Placed:
    """Return a test as it would be without the dashpot: frequencies and real shapes.

    The model says by how much both differ, a share of which counts as error; `placed` may have
    more sensors than were weighed.
    """
    test, d = placed.test, w.damped
    sensors = np.asarray(placed.observation.matrix @ (problem.basis.motion @ w.vectors))
    with_it, real = sensors @ d.shapes, realised(test.shapes)
    change = sensors @ d.undamped - with_it
    without = real * _scale(real, with_it) + change
    hz = test.frequencies_hz / d.stretched
    off, wrong = DAMPERS.own_share * np.abs(hz - test.frequencies_hz), DAMPERS.own_share * change
    errors = mode_errors(hz, without, off, np.abs(wrong))
    if placed.errors is not None:
        own = placed.errors
        frequency = np.hypot(own.frequency, errors.frequency)
        errors = ModeErrors(frequency, np.hypot(own.shape, errors.shape))
    test = replace(test, frequencies_hz=hz, shapes=without)
    return replace(placed, test=test, errors=errors)


def _imaginary(shapes: Numbers, own: Floats) -> Floats | None:
    """Imaginary parts scaled as the real parts are to unit modal mass, None of real shapes."""
    if not np.iscomplexobj(shapes):
        return None
    return np.asarray(shapes.imag * _scale(np.asarray(shapes.real), own))


def _scale(real: Floats, own: Floats) -> Floats:
    """Return what real shapes (n, n_mode) are to be multiplied by to be a model's, (n_mode,)."""
    length = np.maximum(np.sum(real**2, axis=0), np.finfo(float).tiny)
    return np.asarray(np.sum(own * real, axis=0) / length)
