"""What a search starts from: the deck's basis and catalogue, and the known parameters fitted."""

from dataclasses import dataclass, replace

import numpy as np

from ..arrays import Bools, Floats
from ..correlation.mac import realised
from ..reduction.reduced_sum import ReducedSum, reduced_sum
from .discovery_numbers import DISCOVERY
from .effects import KINDS
from .effects.candidates import Candidates
from .effects.effect_kind import Scale
from .effects.element_patches import gives
from .likelihood.hypothesis import Fit, Prior, Problem
from .likelihood.map_fit import fit
from .likelihood.mode_likelihood import Evidence, noise_of
from .likelihood.repeated_modes import none_cut
from .likelihood.request import Request
from .model_error.model_error_numbers import MODEL_ERROR
from .reduction.discretisation_error import consistent_bars, lumping
from .reduction.residual_flexibility import Compliance
from .reduction.search_basis import Basis, build_basis
from .reduction.strain_energies import strain_energies


@dataclass(frozen=True, eq=False)
class Deck:
    """What does not depend on the sensors.

    The basis with the deck's masses and with consistent bars, the error of the mesh and what those
    bars add on it, how many modes may match, what loads do to the deck as it is, and every effect
    that may be missing.
    """

    plain: Basis
    basis: Basis
    mesh: ReducedSum
    bars: ReducedSum
    columns: int
    compliance: Compliance
    catalogue: list[Candidates]


def ground_of(request: Request, modes: Bools) -> Deck:
    """Return what does not depend on the sensors, of the test modes that are searched by."""
    targets = _targets(request.solution.eigenvalues, request.placed.test.frequencies_hz)
    plain = build_basis(request.structure.model, request.solution, targets)
    mesh = reduced_sum((lumping(request.structure),), plain.vectors)
    bars = reduced_sum(consistent_bars(request.structure), plain.vectors)
    return Deck(
        plain,
        replace(plain, mass=plain.mass.and_also(bars)),
        mesh,
        bars,
        none_cut(request.solution.eigenvalues, targets + DISCOVERY.band_more),
        Compliance(request.structure.model, request.solution),
        _catalogue(request, request.placed.test.frequencies_hz[modes], targets),
    )


def _targets(eigenvalues: Floats, hz: Floats) -> int:
    """Return the number of modes that may match those at `hz` [Hz]: as many as these at least."""
    below = np.count_nonzero(eigenvalues < (2.0 * np.pi * DISCOVERY.band * hz.max()) ** 2)
    return none_cut(eigenvalues, min(max(int(below), len(hz)), len(eigenvalues)))


def prepared(
    request: Request, ground: Deck, noise: float, modes: Bools, sensors: Bools
) -> tuple[Problem, Fit, Fit]:
    """Return the problem without suspects, its best fit, and the fit with nothing moved."""
    model, placed = request.structure.model, request.placed
    hz = placed.test.frequencies_hz
    shapes = np.asarray(placed.weighted(realised(placed.test.shapes)))
    unit = shapes / np.maximum(np.linalg.norm(shapes, axis=0), np.finfo(float).tiny)
    scatter: float | Floats = 0.0
    reading = 0.0
    if placed.errors is not None:
        scatter, reading = placed.errors.frequency, float(np.min(placed.errors.length))
    whole = Evidence(hz, unit, noise_of(placed.errors, noise, placed.weights), scatter, reading)
    e = whole.take(modes, sensors)
    basis = ground.basis
    observed = np.asarray(placed.weighted(placed.observation.matrix @ basis.motion))
    prior = Prior(
        np.append(request.spread, MODEL_ERROR.mesh),
        np.append(np.log([q.lower for q in model.parameters]), DISCOVERY.mesh_bounds[0]),
        np.append(np.log([q.upper for q in model.parameters]), DISCOVERY.mesh_bounds[1]),
    )
    mesh, size = ground.mesh.matrices[0], min(basis.size, DISCOVERY.modes)
    problem = Problem(
        e, whole, basis, observed[sensors], observed, mesh, (), (), prior, size, ground.columns
    )
    n = len(prior.spread)
    zero = fit(problem, np.zeros(n), (), (n - 1,), DISCOVERY.steps)
    null = fit(problem, np.zeros(n), (), tuple(range(n)), DISCOVERY.steps)
    columns = none_cut(null.eigenvalues, _targets(null.eigenvalues, hz) + DISCOVERY.band_more)
    return replace(problem, columns=columns), null, zero


def _catalogue(request: Request, hz: Floats, targets: int) -> list[Candidates]:
    """Return every kind of effect at every place."""
    s = request.solution
    energies = strain_energies(request.structure, s.vectors[:, :targets], s.eigenvalues[:targets])
    scale = Scale(
        request.mass,
        request.structure.model.geometry.size,
        float((2.0 * np.pi * np.median(hz)) ** 2),
        (float(hz.min()), float(hz.max())),
    )
    every = [c for kind in KINDS.values() for c in kind.places(request.structure, scale)]
    return [c.following(energies) if gives(c) else c for c in every]
