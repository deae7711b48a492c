"""Measured frequency responses laid onto a model and held against its hypotheses."""

from dataclasses import replace

import numpy as np
import scipy.sparse as sp

from ...arrays import Floats, Numbers
from ...correlation.comparison import Placed
from ...data.dofs import Dofs
from ...data.frfs import Frfs
from ...data.geometry import Geometry
from ...errors import InputError
from ...sensors.sensor_map import observe
from ..findings import Discovery, ResponseGap
from ..reduction.residual_flexibility import Compliance
from .complex_modes import oriented
from .frf_likelihood import Heard, Responses, State, frac, heard, lacking, ratios_of, synthesised
from .hypothesis import Fit, Problem
from .map_fit import evaluate, misfit
from .request import Request


def place_responses(
    frfs: Frfs | None, placed: Placed, geometry: Geometry, dofs: Dofs, motion: Numbers | sp.spmatrix
) -> tuple[Responses | None, tuple[str, ...]]:
    """Lay the responses of a test onto a model; None where none lies on it, and why not.

    A line at 0 Hz says nothing: what is free moves away there.

    `frfs` are in the test's length unit and frame, `placed` are the modes of the same test,
    `geometry` and `dofs` those of the analysis; for `motion` see `grids_of`.
    """
    if frfs is None:
        return None, ()
    own = replace(geometry, length_unit=placed.test_geometry.length_unit)
    try:
        both = (
            Dofs(d.node, d.component, placed.alignment.turn(d.axis))
            for d in (frfs.responses, frfs.references)
        )
        at, by = (observe(own, dofs, placed.test_geometry, d, motion=motion) for d in both)
    except InputError as error:
        return None, (f"the frequency responses do not count as evidence: {error}",)
    rows, columns = np.flatnonzero(at.within), np.flatnonzero(by.within)
    if not len(rows) or not len(columns):
        return None, (
            "the frequency responses do not count as evidence: their "
            f"{'references' if len(rows) else 'sensors'} do not lie on the model",
        )
    lines = frfs.frequencies_hz > 0.0
    whole = replace(
        frfs,
        frequencies_hz=frfs.frequencies_hz[lines],
        responses=at.sensors,
        references=by.sensors,
        values=frfs.values[..., lines] * placed.length_factor,
    )
    return Responses(whole.at(rows, columns), at.matrix[rows], by.matrix[columns]), ()


def hearing(
    request: Request, problem: Problem, compliance: Compliance, nuisance: Floats
) -> Problem:
    """Return the problem with the responses, at sensors that the test still has, as evidence.

    `compliance` is the deck's; `nuisance` (n_parameter + 1,) that of the known parameters fitted
    alone: what that leaves shows how lines go along.
    """
    if request.responses is None:
        return problem
    r = request.responses.at(request.placed.observation.sensors.node)
    if not len(r.frfs.responses):
        return problem
    hz, measured = problem.whole.frequencies_hz, request.placed.test.damping
    observed, driven = (A @ request.structure.model.expansion for A in (r.observed, r.driven))
    rest = lacking(observed, driven, compliance, problem.basis.vectors)
    state = turned_state(problem, evaluate(problem, nuisance, ()), measured)
    return replace(problem, heard=heard(r, hz, measured, rest, state))


def misfit_of_responses(problem: Problem, f: Fit) -> float:
    """Return −2 ln of how likely the responses are by a hypothesis; 0 where there are none."""
    if problem.heard is None:
        return 0.0
    fit = evaluate(problem, f.nuisance, f.suspects)
    return problem.heard.misfit(turned_state(problem, fit, problem.heard.ratios))


def state_of(problem: Problem, f: Fit, measured: Floats) -> State:
    """Return a fit, on the basis of the problem, with the damping that was measured."""
    _, match = misfit(problem.entire(), f.eigenvalues, f.vectors)
    omega = np.sqrt(np.maximum(f.eigenvalues, 0.0))
    motion = problem.basis.motion @ f.vectors[: problem.basis.size]
    return State(omega, ratios_of(measured, match, len(omega)), motion)


def turned_state(problem: Problem, f: Fit, measured: Floats) -> State:
    """Return a fit with its modes turned onto the measured ones, at their frequencies."""
    V = f.vectors[: problem.basis.size]
    modes = oriented(problem.whole, f.eigenvalues, problem.everywhere @ V, problem.columns)
    above = modes.above
    turn = np.hstack([modes.turn, np.eye(len(f.eigenvalues))[:, above]])
    omega = np.concatenate([modes.omega, np.sqrt(np.maximum(f.eigenvalues[above], 0.0))])
    ratios = ratios_of(measured, np.arange(modes.count), len(omega))
    return State(omega, ratios, problem.basis.motion @ (V @ turn))


def with_responses(problem: Problem, nuisance: Floats, best: Fit, said: Discovery) -> Discovery:
    """Add how well the responses are met before and after.

    `nuisance` (n_parameter + 1,) is that of the known parameters fitted alone, `best` what was
    accepted, on the basis of the problem.
    """
    h = problem.heard
    if h is None:
        return said
    deck, known = (evaluate(problem, at, ()) for at in (np.zeros_like(nuisance), nuisance))
    before, after = (tuple(_assurance(h, state_of(problem, f, h.ratios))) for f in (deck, best))
    was, moved, now = (h.rms(turned_state(problem, f, h.ratios)) for f in (deck, known, best))
    frfs, rms = h.responses.frfs, (was, moved, now)
    names, by = tuple(frfs.responses.labels), tuple(frfs.references.labels)
    lines = len(frfs.frequencies_hz)
    gap = ResponseGap(names, by, lines, h.independent, before, after, rms)
    return replace(said, responses=gap)


def _assurance(h: Heard, s: State) -> list[float]:
    """Frequency response assurance of each response, mean over the references measured."""
    measured = h.responses.frfs.values
    each = frac(measured, synthesised(h.responses, s, h.rest))
    seen = np.isfinite(measured).any(axis=-1)
    total = np.sum(np.where(seen, each, 0.0), axis=1)
    return [float(v) for v in total / np.maximum(seen.sum(axis=1), 1)]
