"""Which roots of a band stand: tested against the noise, one by one, out and in."""

from __future__ import annotations

import numpy as np
from scipy.stats import chi2

from ..arrays import Floats, Numbers
from .moments import BandData, basis, excerpt, parts_of, shape_normals
from .refinement import Fit, fit_shapes, refine, solve_shapes
from .search import strongest_root
from .stabilisation import MAX_DAMPING, Candidate

_RISK = 0.01  # that noise alone makes one root somewhere in a band
_MARGIN = 1.5  # beyond what that risk allows, since noise is never quite white
_MARGIN_OF_SPIKES = 6.0  # the same for a pole narrower than the lines are apart
_BEYOND_DOUBT = 50.0  # significance above which a root is not tested by refining without it
_WIDEST = 0.3  # of the band: the half-power bandwidth of a mode
_DYNAMIC_RANGE = 3e-4  # of the level around: what is weaker is not a mode, however clean the data
_ROUNDS = 12  # of trying a root where the residual still shows one
_FAILURES = 5  # in a row, after which no more is tried
_NEIGHBOURS = 8.0  # half bandwidths to either side that a trial root is fitted over
_LEAST_AROUND = 24  # lines to either side that a trial root is fitted over
_HOPELESS = 0.1  # significance of a root before any refinement, below which it is not tried
_PROMISING = 0.6  # significance of a root in a fit of the lines around it, to be tried at all
_TRIAL_ITERATIONS = 10  # after which a root that explains too little is given up
_AROUND = 4  # lines around a failed trial that are not tried again
_BACKGROUND = 2  # roots beside or beneath the modes of a band, which a fit may use


def select(
    data: BandData,
    frequencies_hz: Floats,
    start: Fit,
    spare: tuple[Candidate, ...],
    low: float,
    high: float,
) -> Fit:
    """Drop the roots that noise explains, add those that the data still ask for.

    Parameters
    ----------
    data : BandData
    frequencies_hz : (n_line,) float
    start : Fit
        Roots to begin with.
    spare : tuple of Candidate
        Roots to be tested first.
    low, high : float
        Where further roots are sought in the residual [Hz].
    """
    f = frequencies_hz
    state = prune(data, f, start)
    for c in spare:
        state = _try(data, f, state, c) or state
    open_lines = (f >= low) & (f <= high)
    failed = 0
    for _ in range(_ROUNDS):
        if not open_lines.any() or failed == _FAILURES:
            break
        line, candidate = _from_residual(data, f, state, open_lines)
        grown = None if candidate is None else _try(data, f, state, candidate)
        if grown is None:
            failed += 1
            open_lines[max(line - _AROUND, 0) : line + _AROUND + 1] = False
        else:
            failed = 0
            state = grown
    return prune(data, f, state)


def significance(data: BandData, f: Floats, fit: Fit) -> Floats:
    """Compare what each mode explains with what the best pole fitted to noise would explain.

    The sum of squares that would be lost without mode k, the others fitted again, over the
    variance of the residual around its frequency, is χ² with 2 n_output degrees of freedom for a
    pole given beforehand. A free participation makes them about (√(2 n_output) +
    √(2 n_input − 2))² (the largest eigenvalue of a Wishart matrix) and a free pole 2 more; the
    best of n lines is allowed for by the risk.
    """
    m = len(fit.poles)
    if m == 0:
        return np.empty(0)
    F = basis(data, fit.poles, derivative=False)
    flat = F.reshape(len(F), 2 * m)
    per_input = shape_normals((flat.T @ flat).reshape(1, m, 2, 1, m, 2), fit.participation)
    x = np.stack([fit.shapes.real, fit.shapes.imag], axis=-1)
    lost = np.zeros(m)
    for w, rows in data.patterns:
        inverse = solve_shapes(np.tensordot(w, per_input, axes=1), np.eye(2 * m))
        own = inverse.reshape(m, 2, m, 2)[np.arange(m), :, np.arange(m), :]
        lost += np.einsum("oka,kab,okb->k", x[rows], np.linalg.inv(own), x[rows])
    noise = _noise_of_one(data, f)
    narrow = -fit.poles.real / np.pi < np.median(np.diff(f))
    margin = np.where(narrow, _MARGIN_OF_SPIKES, _MARGIN)
    return np.asarray(lost / (margin * noise * local_variance(data, f, fit, F)))


def _noise_of_one(data: BandData, f: Floats) -> float:
    """Return what the best pole fitted to unit noise explains, see `significance`."""
    n_output, n_input = data.weight.shape
    freedom = (np.sqrt(2 * n_output) + np.sqrt(2 * n_input - 2)) ** 2 + 2
    return float(chi2.isf(_RISK / len(f), freedom))


def residual_lines(data: BandData, fit: Fit, F: Floats) -> Floats:
    """Return what the fit leaves, (n_output, n_input, 2 n_line), stacked."""
    model = parts_of(fit.shapes[:, None, :] * fit.participation[None, :, :])
    left = data.y - model @ F[:, 0].reshape(len(F), 2 * len(fit.poles)).T
    return np.asarray(left * data.weight[:, :, None])


def local_variance(data: BandData, f: Floats, fit: Fit, F: Floats) -> Floats:
    """Variance of one real number of the residual around each mode, (n_mode,)."""
    left = residual_lines(data, fit, F)
    per_line = np.einsum("oin,oin->n", left, left).reshape(2, -1).sum(axis=0)
    per_line /= 2.0 * data.weight.sum()
    hz = np.abs(fit.poles) / (2.0 * np.pi)
    half = np.maximum(2.0 * np.abs(fit.poles.real) / np.pi, 6.0 * np.median(np.diff(f)))
    variance = np.empty(len(hz))
    power = np.einsum("oin,oin->n", data.y, data.y).reshape(2, -1).sum(axis=0)
    power /= 2.0 * data.weight.sum()
    for k in range(len(hz)):
        near = np.abs(f - hz[k]) <= half[k]
        near[np.argsort(np.abs(f - hz[k]))[:12]] = True
        used = np.count_nonzero(np.abs(hz - hz[k]) <= half[k])
        lines = np.count_nonzero(near)
        spent = max(1.0 - used / lines / max(1.0, data.weight.sum(axis=1).mean()), 0.25)
        floor = _DYNAMIC_RANGE**2 * (power[near].mean() + 0.01 * power.mean())
        variance[k] = max(per_line[near].mean() / spent, floor, 1e-300)
    return variance


def start_from(data: BandData, candidates: tuple[Candidate, ...]) -> Fit:
    """Shapes for the candidates as proposed, participations completed."""
    n_input = data.weight.shape[1]
    poles = np.array([c.pole for c in candidates], dtype=complex)
    part = np.array([c.participation for c in candidates], dtype=complex)
    part = complete_participation(data, poles, part.reshape(-1, n_input).T)
    return fit_shapes(data, poles, part)


def complete_participation(data: BandData, poles: Numbers, part: Numbers) -> Numbers:
    """Fill in participations not known yet (NaN) from residues fitted input by input.

    Parameters
    ----------
    part : (n_input, n_mode) complex
    """
    unknown = np.isnan(part)
    if not unknown.any():
        return part
    n_output, n_input = data.weight.shape
    residues = np.zeros((n_output, n_input, len(poles)), complex)
    for i in range(n_input):
        rows = data.weight[:, i] > 0.0
        one = BandData(
            data.s, data.derivative, data.residual_terms, data.y[rows, i : i + 1],
            data.weight[rows, i : i + 1],
        )  # fmt: skip
        residues[rows, i] = fit_shapes(one, poles, np.ones((1, len(poles)), complex)).shapes
    part = np.where(unknown, 0.0, part)
    W = data.weight[:, :, None]
    for _ in range(10):
        weight = np.sum(W * np.abs(part) ** 2, axis=1)
        shape = np.sum(W * part.conj() * residues, axis=1) / np.maximum(weight, 1e-300)
        power = np.sum(W * np.abs(shape[:, None]) ** 2, axis=0)
        new = np.sum(W * shape.conj()[:, None] * residues, axis=0) / np.maximum(power, 1e-300)
        part = np.where(unknown, new, part)
    return np.asarray(part)


def prune(data: BandData, f: Floats, fit: Fit) -> Fit:
    """Refine and drop the least credible mode until all stand.

    `significance` leaves the other poles where they are, which flatters a root that stands close
    to others; so the weaker ones must also be missed when the others are refined without them.
    """
    cleared: set[complex] = set()
    while len(fit.poles):
        fit = refine(data, fit.poles, fit.participation)
        value = significance(data, f, fit)
        if np.count_nonzero(~plausible(f, fit)) > _BACKGROUND:
            value = value * plausible(f, fit)
        worst = int(np.argmin(value))
        if value[worst] < 1.0:
            fit = _without(data, fit, worst)
            continue
        F = basis(data, fit.poles, derivative=False)
        allowed = _MARGIN * _noise_of_one(data, f) * local_variance(data, f, fit, F)
        for k in np.argsort(value):
            if value[k] > _BEYOND_DOUBT or complex(fit.poles[k]) in cleared:
                continue
            rest = _without(data, fit, int(k))
            rest = refine(data, rest.poles, rest.participation)
            if rest.misfit - fit.misfit < allowed[k]:
                fit = rest
                break
            cleared.add(complex(fit.poles[k]))
        else:
            break
    return fit


def _without(data: BandData, fit: Fit, k: int) -> Fit:
    keep = np.arange(len(fit.poles)) != k
    return fit_shapes(data, fit.poles[keep], fit.participation[:, keep])


def plausible(f: Floats, fit: Fit) -> Numbers:
    """Whether each root is a mode of the band: inside, damped a little, not its background.

    Roots beyond the band or as wide as a good part of it stand for what the residual terms do
    not describe; they serve the fit and are not reported.
    """
    magnitude = np.abs(fit.poles)
    hz, damping = magnitude / (2.0 * np.pi), -fit.poles.real / magnitude
    inside = (hz >= f[0]) & (hz <= f[-1])
    narrow = 2.0 * damping * hz < _WIDEST * (f[-1] - f[0])
    return np.asarray(inside & (damping < MAX_DAMPING) & narrow)


def _try(data: BandData, f: Floats, fit: Fit, candidate: Candidate) -> Fit | None:
    """Add a root and refine; None when the data do not ask for it."""
    new = complete_participation(
        data,
        np.append(fit.poles, candidate.pole),
        np.column_stack([fit.participation, candidate.participation]),
    )
    grown = fit_shapes(data, np.append(fit.poles, candidate.pole), new)
    if significance(data, f, grown)[-1] < _HOPELESS:
        return None
    grown = refine(data, grown.poles, grown.participation, max_iterations=_TRIAL_ITERATIONS)
    if not grown.converged:
        if significance(data, f, grown)[-1] < 0.8:
            return None
        grown = refine(data, grown.poles, grown.participation)
    if significance(data, f, grown)[-1] < 1.0:
        return None
    grown = prune(data, f, grown)
    freedom = max(data.y.size - data.weight.size, 1)
    gained = (fit.misfit - grown.misfit) * freedom / max(grown.misfit, 1e-300)
    return grown if gained > 0.5 * _noise_of_one(data, f) else None


def _from_residual(
    data: BandData, f: Floats, fit: Fit, open_lines: Numbers
) -> tuple[int, Candidate | None]:
    """Find the root that explains most of the residual, and fit it with its neighbours.

    None instead of a root when a fit of the lines around it shows nothing but noise.
    """
    F = basis(data, fit.poles, derivative=False)
    left = residual_lines(data, fit, F)
    n_line = len(f)
    line, root = strongest_root(f, left[..., :n_line] + 1j * left[..., n_line:], open_lines)
    centre = root.pole.imag
    gap = np.abs(fit.poles.imag - centre)
    close = gap < _NEIGHBOURS * np.abs(fit.poles.real)
    decays = [-root.pole.real, *(-fit.poles.real[close])]
    spacing = 2.0 * np.pi * float(np.median(np.diff(f)))
    reach = max(_NEIGHBOURS * max(decays), _LEAST_AROUND * spacing)
    near = gap < reach
    first, last = np.searchsorted(2.0 * np.pi * f, [centre - reach, centre + reach])
    lines = slice(int(first), int(last))
    mine = parts_of((fit.shapes[:, None, :] * fit.participation[None, :, :])[..., near])
    functions = left + mine @ F[:, 0, near].reshape(len(F), -1).T
    local = excerpt(data, lines, functions)
    best, most = None, _PROMISING
    for decay in (decays[0], float(np.median(decays))):
        poles = np.append(fit.poles[near], complex(-decay, centre))
        part = np.column_stack([fit.participation[:, near], root.participation])
        trial = refine(local, poles, part, max_iterations=_TRIAL_ITERATIONS)
        value = float(significance(local, f[lines], trial)[-1])
        if value > most:
            best, most = Candidate(complex(trial.poles[-1]), trial.participation[:, -1], 0), value
    return line, best
