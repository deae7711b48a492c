"""What a root explains, against what the best root fitted to noise would explain."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from scipy.special import chdtri

from ...arrays import Floats, Numbers
from .moments import BandData, basis, onto, parts_of, shape_normals, unstacked
from .pole_numbers import POLES
from .variable_projection import Fit, solve_shapes


def significance(data: BandData, f: Floats, fit: Fit) -> Floats:
    """Compare what each mode explains with what the best pole fitted to noise would explain.

    The sum of squares that would be lost without mode k, the others fitted again, over the
    variance of the residual around its frequency (output by output), is χ² with 2 n_output
    degrees of freedom for a pole given beforehand. A free participation makes them about
    (√(2 n_output) + √(2 n_input − 2))² (the largest eigenvalue of a Wishart matrix) and a free
    pole 2 more; the best of n lines is allowed for by the risk. However clean the functions, a
    mode must also be seen in them, see `visibility`.
    """
    m = len(fit.poles)
    if m == 0:
        return np.empty(0)
    F = basis(data, fit.poles, derivative=False)
    flat = F.reshape(len(F), 2 * m)
    per_input = shape_normals((flat.T @ flat).reshape(1, m, 2, 1, m, 2), fit.participation)
    x = np.stack([fit.shapes.real, fit.shapes.imag], axis=-1)
    variance = row_variances(data, f, fit, F)
    lost = np.zeros(m)
    for w, rows in data.patterns:
        inverse = solve_shapes(np.tensordot(w, per_input, axes=1), np.eye(2 * m))
        own = inverse.reshape(m, 2, m, 2)[np.arange(m), :, np.arange(m), :]
        by_row = np.einsum("oka,kab,okb->ko", x[rows], np.linalg.inv(own), x[rows])
        lost += np.sum(by_row / variance[:, rows], axis=1)
    width = -fit.poles.real / np.pi / np.median(np.diff(f))
    margin = np.where(width < 1.0, POLES.margin_of_spikes, POLES.margin)
    margin = np.where(width < POLES.needle, POLES.margin_of_needles, margin)
    explained = lost / (margin * best_of_noise(data, f, len(x)))
    return np.asarray(np.minimum(explained, visibility(data, f, fit, F)))


def visibility(data: BandData, f: Floats, fit: Fit, F: Floats) -> Floats:
    """Compare the energy of each mode within its half-power band with that of the functions.

    Windows, leakage and small nonlinearities leave traces that noise does not explain and that
    are no modes. They are taken to reach 3 % of one function; a root on which n functions agree
    may be n times weaker. 1 where a mode is at that limit.
    """
    own = energy_by_line(data, fit, F[:, 0])
    hz, half = np.abs(fit.poles) / (2.0 * np.pi), np.abs(fit.poles.real) / (2.0 * np.pi)
    result = np.empty(len(hz))
    for k in range(len(hz)):
        gap = np.abs(f - hz[k])
        near = gap <= max(half[k], float(gap.min()))
        result[k] = own[near, k].sum() / max(float(data.by_line[near].sum()), 1e-300)
    return np.asarray(result * (data.weight.sum() / POLES.seen) ** 2)


def energy_by_line(data: BandData, fit: Fit, F: Floats) -> Floats:
    """Sum over the functions of the squares of each mode's part in them, (n_line, n_mode).

    Parameters
    ----------
    F : (2 n_line, n_mode, 2) float
        Of the values or of the derivative, see `basis`.
    """
    r = fit.shapes[:, None, :] * fit.participation[None, :, :]
    r = np.where(data.weight[:, :, None] > 0.0, r, 0.0)
    re, im = (np.einsum("oik,oik->k", a, a) for a in (r.real, r.imag))
    cross = np.einsum("oik,oik->k", r.real, r.imag)
    by_line = F[..., 0] ** 2 * re + F[..., 1] ** 2 * im + 2.0 * F[..., 0] * F[..., 1] * cross
    return np.asarray(by_line.reshape(2, len(F) // 2, len(fit.poles)).sum(axis=0))


def allowance(data: BandData, f: Floats, fit: Fit) -> Floats:
    """Return how much of the misfit each root must account for, the others refined without it.

    Outputs of unequal noise count for fewer, (Σ v)²/Σ v² of them (Satterthwaite).
    """
    variance = row_variances(data, f, fit, basis(data, fit.poles, derivative=False))
    total = variance.sum(axis=1)
    outputs = total**2 / np.sum(variance**2, axis=1)
    noise = np.array([best_of_noise(data, f, n) for n in outputs])
    return np.asarray(POLES.margin * noise * total / outputs)


def best_of_noise(data: BandData, f: Floats, n_output: float) -> float:
    """Return what the best pole fitted to unit noise explains, see `significance`."""
    n_input = data.weight.shape[1]
    freedom = (np.sqrt(2 * n_output) + np.sqrt(2 * n_input - 2)) ** 2 + 2
    return float(chdtri(freedom, POLES.risk / len(f)))


def residual_lines(data: BandData, fit: Fit, F: Floats) -> Floats:
    """Return what the fit leaves, (n_output, n_input, 2 n_line), stacked."""
    model = parts_of(fit.shapes[:, None, :] * fit.participation[None, :, :])
    left = onto(model, F[:, 0].reshape(len(F), 2 * len(fit.poles)).T)
    np.subtract(data.y, left, out=left)
    left[data.weight == 0.0] = 0.0
    return left


def row_variances(data: BandData, f: Floats, fit: Fit, F: Floats) -> Floats:
    """Variance of one real number of the residual around each mode, (n_mode, n_output).

    The inputs of an output count as the mode takes part in them. Few lines make the variance of
    one function uncertain, so it is drawn towards that of all.
    """
    left = residual_lines(data, fit, F)
    n_line = len(f)
    inflation = colour(left, f, fit)
    power = data.by_line / (2.0 * data.weight.sum())
    hz = np.abs(fit.poles) / (2.0 * np.pi)
    half = np.maximum(2.0 * np.abs(fit.poles.real) / np.pi, 6.0 * np.median(np.diff(f)))
    result = np.empty((len(hz), len(data.weight)))
    for k in range(len(hz)):
        mask = np.abs(f - hz[k]) <= half[k]
        mask[np.argsort(np.abs(f - hz[k]))[: POLES.near_least]] = True
        near = np.flatnonzero(mask)  # one stretch, for the lines rise
        used = np.count_nonzero(np.abs(hz - hz[k]) <= half[k])
        share = used / len(near) / max(1.0, data.weight.sum(axis=1).mean())
        spent = max(1.0 - share, POLES.spent_least)
        here = left.reshape(*data.weight.shape, 2, n_line)[..., near[0] : near[-1] + 1]
        squares = np.einsum("oicn,oicn->oi", here, here) / (2.0 * len(near) * spent)
        mean = squares.sum() / data.weight.sum()
        squares = (squares * 2.0 * len(near) + POLES.prior * mean) / (2.0 * len(near) + POLES.prior)
        part = data.weight * np.abs(fit.participation[:, k]) ** 2
        row = np.sum(part * squares, axis=1) / np.maximum(part.sum(axis=1), 1e-300)
        floor = POLES.dynamic_range**2 * (power[near].mean() + POLES.floor * power.mean())
        result[k] = np.maximum(row * inflation[k], max(floor, 1e-300))
    return result


def colour(left: Floats, f: Floats, fit: Fit) -> Floats:
    """Compare the residual's energy along each mode's decay with that of white noise, (n_mode,).

    Over time (the inverse transform of the lines) white noise is even. What windows, leakage or
    a faulty model leave stands in the beginning, where the modes are, and so looks like modes:
    its variance counts by the energy that a filter matched to the mode's decay would collect.

    Parameters
    ----------
    left : (n_output, n_input, 2 n_line) float
        Residual, stacked.
    """
    n_line = len(f)
    functions = left.reshape(-1, 2, n_line)
    functions = functions[:: max(1, len(functions) // POLES.listened)]
    over_time = np.fft.ifft(functions[:, 0] + 1j * functions[:, 1], axis=1)
    energy = np.sum(np.abs(over_time) ** 2, axis=0)
    mean = float(energy.mean())
    if mean <= 0.0:
        return np.ones(len(fit.poles))
    time = np.arange(n_line) / (f[-1] - f[0]) * (n_line - 1) / n_line
    envelope = np.exp(2.0 * np.outer(fit.poles.real, time))
    return np.asarray(np.maximum(envelope @ energy / envelope.sum(axis=1) / mean, 1.0))


@dataclass(frozen=True, eq=False)
class Memory:
    """What the residual around each mode holds besides noise of single lines.

    Parameters
    ----------
    ratio : (n_mode,) float
        Variance over that of the differences; about 1 for white noise.
    scatter : (n_mode,) float
        Standard deviation of the ratio for white noise.
    systematic : (n_mode,) float
        Sum of squares over all functions in excess of white noise.
    near : (n_line, n_mode) bool
        The lines looked at.
    excess : (n_line,) float
        Sum of squares over all functions at each line, less that of the differences there.
    """

    ratio: Floats
    scatter: Floats
    systematic: Floats
    near: Numbers
    excess: Floats


def memory_of_residual(data: BandData, f: Floats, fit: Fit) -> Memory:
    """Compare the residual around each mode with noise without memory from line to line.

    The variance of white noise equals that of its fourth difference over 70. What a faulty model
    leaves, and the noise of windowed records, changes slowly from line to line.
    """
    some = slice(None, None, max(1, int(data.weight.sum()) // POLES.listened))
    heard = replace(data, y=data.y[some], weight=data.weight[some])
    fitted = replace(fit, shapes=fit.shapes[some])
    left = residual_lines(heard, fitted, basis(heard, fit.poles, derivative=False))
    functions = unstacked(left).reshape(-1, len(f))
    square = np.sum(np.abs(functions) ** 2, axis=0)
    rough = np.sum(np.abs(np.diff(functions, n=4, axis=1)) ** 2, axis=0) / 70.0
    spacing = float(np.median(np.diff(f)))
    half = np.maximum(2.0 * np.abs(fit.poles.real) / np.pi, POLES.seen_least * spacing)
    centre = np.clip(np.abs(fit.poles) / (2.0 * np.pi), f[0], f[-1])
    near = np.abs(f[:, None] - centre) <= half
    count = near.sum(axis=0)
    level = square @ near / count
    white = rough @ near[2:-2] / near[2:-2].sum(axis=0)
    heard_of, all_of = float(heard.weight.sum()), float(data.weight.sum())
    return Memory(
        level / np.maximum(white, 1e-300),
        2.0 / np.sqrt(count * heard_of),
        np.maximum(level - white, 0.0) * count * all_of / heard_of,
        near,
        (square - np.pad(rough, 2, "edge")) * all_of / heard_of,
    )


def rough_part(f: Floats, fit: Fit, near: Numbers) -> Floats:
    """Part of what scatter of each pole leaves that differences of lines take for noise."""
    left = 1.0 / (2j * np.pi * f[:, None] - fit.poles) ** 2
    white = np.abs(np.diff(left, n=4, axis=0)) ** 2 / 70.0
    inner = near[2:-2]
    level = np.sum(np.abs(left) ** 2 * near, axis=0) / near.sum(axis=0)
    return np.asarray(np.sum(white * inner, axis=0) / inner.sum(axis=0) / level)


def residual_is_white(data: BandData, f: Floats, fit: Fit) -> Numbers:
    """Tell for each mode whether the residual around it is about noise without memory."""
    return np.asarray(memory_of_residual(data, f, fit).ratio < POLES.white)
