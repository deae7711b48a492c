"""A dashpot weighed on the model that a search ended with."""

from dataclasses import dataclass

import numpy as np

from ...arrays import Floats, Ints, Numbers
from ...correlation.mac import principal
from ..effects.local_damper import PEAKS, dashpots
from ..effects.structure_points import Axes
from ..likelihood.complex_modes import Oriented, complex_modes, oriented
from ..likelihood.hypothesis import Fit, Problem
from ..likelihood.mode_likelihood import Evidence
from ..likelihood.request import Request
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
    known : (n, n) float
        Dashpots of the deck on unit modal masses.
    """

    found: DamperFound
    places: Axes
    modes: Oriented
    u: Floats
    known: Floats


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
    turn = V @ modes.turn
    places = dashpots(structure)
    free = problem.basis.vectors @ turn
    u = np.asarray(places.root @ free)
    known = np.zeros((len(modes.omega),) * 2)
    if structure.damping is not None:
        known = np.asarray(free.T @ (structure.damping @ free))
    imaginary = _imaginary(shapes, own[:, : modes.count])
    evidence = DampingEvidence(test.damping, imaginary, e.noise.independent)
    found = find_damper(evidence, modes, u, own, known, np.log(PEAKS))
    return None if found is None else Weighed(found, places, modes, u, known)


def _imaginary(shapes: Numbers, own: Floats) -> Floats | None:
    """Imaginary parts scaled as the real parts are to unit modal mass, None of real shapes."""
    if not np.iscomplexobj(shapes):
        return None
    real = np.asarray(shapes.real)
    length = np.maximum(np.sum(real**2, axis=0), np.finfo(float).tiny)
    return np.asarray(shapes.imag * (np.sum(own * real, axis=0) / length))


def moved(w: Weighed) -> Ints:
    """Return the test modes whose frequency or real shape the dashpot moves, numbers from 0.

    A heavy dashpot couples close modes: to a search for missing stiffness and mass that looks
    like something else at its place.
    """
    n, found, omega = w.modes.count, w.found, w.modes.omega
    u = w.u[found.rows[0]]
    level = np.full(len(omega), float(np.exp(np.mean(np.log(found.level_with)))))
    level[:n] = found.level_with
    D = w.known + np.exp(found.log_size[0]) * np.outer(u, u) + np.diag(2.0 * level * omega)
    poles, Q = complex_modes(omega, D)
    shift = np.abs(np.abs(poles[:n]) / omega[:n] - 1.0)
    turned = np.linalg.norm(Q.real[:, :n] - np.eye(len(omega))[:, :n], axis=0)
    still = (shift < DAMPERS.shifted) & (turned < DAMPERS.turned)
    return np.flatnonzero(~still)
