"""Which roots of a band stand: tested against the noise, one by one, out and in."""

from __future__ import annotations

import numpy as np

from ..arrays import Floats, Numbers
from .moments import BandData, basis
from .refinement import Fit, fit_shapes, refine, ridged, system_at
from .stabilisation import MAX_DAMPING, Candidate

_MARGIN = 1.5  # of the best that a pole fitted to noise can reach
_WIDEST = 0.3  # of the band: the half-power bandwidth of a mode
_DYNAMIC_RANGE = 3e-4  # of the level around: what is weaker is not a mode, however clean the data
_ROUNDS = 8  # of adding a root where the residual still shows one
_START_DAMPING = (0.001, 0.003, 0.01, 0.03)


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
        state = _try(data, f, state, c)
    for _ in range(_ROUNDS):
        candidate = _from_residual(data, f, state, low, high)
        if candidate is None:
            break
        grown = _try(data, f, state, candidate)
        if grown is state:
            break
        state = grown
    return state


def significance(data: BandData, f: Floats, fit: Fit) -> Floats:
    """What each mode explains, over what the best pole fitted to noise alone would explain.

    The sum of squares that would be lost without mode k, the others fitted again, over the
    variance of the residual around its frequency, is χ² with 2 n_output degrees of freedom for a
    pole given beforehand; one that was sought in n lines and with a free participation reaches
    about (√(2 n_output) + √(2 n_input) + √(2 ln n))².
    """
    m = len(fit.poles)
    if m == 0:
        return np.empty(0)
    n, F, _ = system_at(data, fit)
    inverse = np.linalg.inv(ridged(n.shape_shape)).reshape(-1, m, 2, m, 2)
    own = inverse[:, np.arange(m), :, np.arange(m), :].transpose(1, 0, 2, 3)
    x = np.stack([fit.shapes.real, fit.shapes.imag], axis=-1)
    lost = np.einsum("oka,oka->k", x, np.linalg.solve(own, x[..., None])[..., 0])
    n_output, n_input = data.weight.shape
    noise = (np.sqrt(2 * n_output) + np.sqrt(2 * n_input) + np.sqrt(2 * np.log(len(f)))) ** 2
    return np.asarray(lost / (_MARGIN * noise * local_variance(data, f, fit, F)))


def residual_lines(data: BandData, fit: Fit, F: Floats) -> Floats:
    """Return what the fit leaves, (n_output, n_input, 2 n_line), stacked."""
    r = fit.shapes[:, None, :] * fit.participation[None, :, :]
    coefficients = np.stack([r.real, r.imag], axis=-1).reshape(r.shape[:2] + (-1,))
    left = data.y - coefficients @ F[:, 0].reshape(len(F), -1).T
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
        floor = _DYNAMIC_RANGE**2 * power[near].mean()
        variance[k] = max(per_line[near].mean() / spent, floor, 1e-300)
    return variance


def start_from(data: BandData, candidates: tuple[Candidate, ...]) -> Fit:
    """Shapes for the candidates as proposed, participations completed."""
    n_output, n_input = data.weight.shape
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
    """Refine and drop the least credible mode until all stand."""
    while len(fit.poles):
        fit = refine(data, fit.poles, fit.participation)
        value = significance(data, f, fit) * plausible(f, fit)
        worst = int(np.argmin(value))
        if value[worst] >= 1.0:
            break
        keep = np.arange(len(fit.poles)) != worst
        fit = fit_shapes(data, fit.poles[keep], fit.participation[:, keep])
    return fit


def plausible(f: Floats, fit: Fit) -> Numbers:
    """Whether each root is a mode of the band: inside, damped a little, not its background."""
    magnitude = np.abs(fit.poles)
    hz, damping = magnitude / (2.0 * np.pi), -fit.poles.real / magnitude
    inside = (hz >= f[0]) & (hz <= f[-1])
    return inside & (damping < MAX_DAMPING) & (2.0 * damping * hz < _WIDEST * (f[-1] - f[0]))


def _try(data: BandData, f: Floats, fit: Fit, candidate: Candidate) -> Fit:
    """Add a root; return the same object when the data do not ask for it."""
    new = complete_participation(
        data,
        np.append(fit.poles, candidate.pole),
        np.column_stack([fit.participation, candidate.participation]),
    )
    grown = fit_shapes(data, np.append(fit.poles, candidate.pole), new)
    if significance(data, f, grown)[-1] < 0.5:
        return fit
    stood = significance(data, f, fit) * plausible(f, fit) >= 1.0
    grown = refine(data, grown.poles, grown.participation)
    stands = significance(data, f, grown) * plausible(f, grown) >= 1.0
    return grown if stands[-1] and (stands[:-1] | ~stood).all() else fit


def _from_residual(
    data: BandData, f: Floats, fit: Fit, low: float, high: float
) -> Candidate | None:
    """The root that a single-mode fit finds at the strongest peak of the residual."""
    F = basis(data, fit.poles)
    left = residual_lines(data, fit, F)
    n_line = len(f)
    lines = (left[..., :n_line] + 1j * left[..., n_line:]).transpose(2, 0, 1)
    _, value, vh = np.linalg.svd(lines, full_matrices=False)
    core = (f >= low) & (f <= high)
    peak = int(np.argmax(np.where(core, value[:, 0], 0.0)))
    participation = vh[peak, 0].conj()
    only = BandData(data.s, data.derivative, data.residual_terms, left, data.weight)
    omega = 2.0 * np.pi * f[peak]
    best: Candidate | None = None
    least = np.inf
    for zeta in _START_DAMPING:
        pole = omega * complex(-zeta, np.sqrt(1.0 - zeta**2))
        one = fit_shapes(only, np.array([pole]), participation[:, None])
        if one.misfit < least:
            best, least = Candidate(pole, participation, 0), one.misfit
    return best
