"""Which roots are modes of the structure, where a survey leaves more than noise.

Functions of a real survey do not share one exact set of poles, lines are cut by windows, a hammer
blow is never the same twice. What this leaves over looks like roots: satellites of a resonance that
repeat its one direction, and roots, mostly wide and complex, on which its errors are hung.
"""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np

from ...arrays import Bools, Floats, Numbers
from ..quality import phase_collinearity
from .moments import BandData, basis
from .pole_numbers import POLES
from .significance import energy_by_line, memory_of_residual, rough_part
from .variable_projection import Fit


def survey_error(fits: Iterable[tuple[BandData, Floats, Fit]]) -> float:
    """Median over the roots of the part of the energy around them left over beyond noise.

    What scatter of a pole leaves over a few lines is as rough as noise; roots that the lines
    resolve tell, if there are any.
    """
    shares: list[Floats] = []
    rough: list[Floats] = []
    for data, f, fit in (x for x in fits if len(x[2].poles)):
        memory = memory_of_residual(data, f, fit)
        shares.append(memory.systematic / np.maximum(data.by_line @ memory.near, 1e-300))
        rough.append(rough_part(f, fit, memory.near))
    if not shares:
        return 0.0
    share, part = np.concatenate(shares), np.concatenate(rough)
    resolved = part < POLES.resolved
    if not resolved.any():
        return float(np.median(share))
    return float(np.median(share[resolved] / (1.0 - part[resolved])))


def sound(data: BandData, f: Floats, fit: Fit) -> Bools:
    """Tell which roots are more than the errors of the survey, (n_mode,) bool.

    Two estimates of the error in a root, over its own energy: what is left over around it and is
    not noise, and what of its shape is in quadrature (errors have as much in phase), at the outputs
    measured with most inputs, which know it best. Their geometric mean is to stay below a limit.
    All are sound where the survey leaves noise only.
    """
    if not len(fit.poles) or data.error == 0.0:
        return np.ones(len(fit.poles), bool)
    left = left_over(data, f, fit)
    outputs, _ = data.blocks[0]
    collinear = np.sqrt(phase_collinearity(fit.shapes[outputs]))
    error = left * (1.0 - collinear) / np.maximum(collinear, 1e-300)
    return np.asarray(error < POLES.error_most**2)


def left_over(data: BandData, f: Floats, fit: Fit) -> Floats:
    """Energy that is left over where each root stands and is not noise, over the root's own.

    Lines count by the energy of the root, so a narrow one does not answer for what is beside it.

    Returns
    -------
    (n_mode,) float
    """
    memory = memory_of_residual(data, f, fit)
    own = energy_by_line(data, fit, basis(data, fit.poles, derivative=False)[:, 0])
    left = np.maximum(memory.excess @ own, 0.0) / np.maximum(np.sum(own**2, axis=0), 1e-300)
    return np.asarray(np.where(memory.ratio > 1.0 + POLES.sure * memory.scatter, left, 0.0))


def resonances(f: Floats, fit: Fit, widths: float) -> list[list[int]]:
    """Roots by rising frequency, in groups that stand within some half bandwidths."""
    spacing = 2.0 * np.pi * float(np.median(np.diff(f)))
    order = np.argsort(fit.poles.imag)
    decay, omega = -fit.poles.real, fit.poles.imag
    groups: list[list[int]] = []
    for k in order:
        if groups:
            last = groups[-1][-1]
            reach = widths * min(decay[k], decay[last]) + spacing
            if omega[k] - omega[last] < reach:
                groups[-1].append(int(k))
                continue
        groups.append([int(k)])
    return groups


def directions(data: BandData, f: Floats, fit: Fit, group: list[int], strict: bool) -> int:
    """Count the independent directions of a resonance, at least one.

    A frequency that scatters from output to output makes many roots of one participation, one
    that scatters from input to input many of one shape; two modes differ in both. Where they
    differ in one only (as all do before a single reference), directions must be stronger than
    such scatter makes them; but where a survey without error has no more inputs (or outputs) than
    they show, all roots count. Only functions measured tell it, by blocks that are complete: a
    root that serves some functions alone says nothing of the others.

    Parameters
    ----------
    strict : bool
        No direction counts that outputs or inputs alone tell, but for a single one of them.
    """
    error, told, strong = data.error, [], []
    poles, omega = fit.poles[group], 2.0 * np.pi * f
    lines = (np.abs(omega[:, None] - poles.imag) < POLES.seen_widths * -poles.real).any(axis=1)
    lines[[int(np.argmin(np.abs(omega - w))) for w in poles.imag]] = True
    near = 1.0 / (1j * omega[lines, None] - poles)
    for outputs, inputs in data.blocks:
        shapes, part = fit.shapes[outputs][:, group], fit.participation[inputs][:, group]
        both: list[int] = []
        for matrix, other in ((shapes, part), (part, shapes)):
            energy = _energies(matrix, other, near)
            limit = POLES.direction * max(error, POLES.error_least) * energy[0]
            both.append(int(np.count_nonzero(energy > limit)))
            single = len(matrix) == 1
            if both[-1] == len(matrix) and error == 0.0 and (single or not strict):
                return len(group)
            strong.append(int(np.count_nonzero(energy > POLES.scatter * error * energy[0])))
        told.append(min(both))
    return max(*told, *strong) if error > 0.0 and not strict else max(told)


def _energies(one: Numbers, other: Numbers, lines: Numbers) -> Floats:
    """Squared singular values of Σ_k one_k (other_k ⊗ lines_k)ᵀ, from triangular factors."""
    a, b, c = (_triangle(x) for x in (one, other, lines))
    beside = _triangle((b[:, None, :] * c).reshape(-1, one.shape[1]))
    return np.asarray(np.linalg.svd(a @ beside.T, compute_uv=False) ** 2)


def _triangle(columns: Numbers) -> Numbers:
    return np.asarray(np.linalg.qr(columns, mode="r"))


def satellites(
    data: BandData, f: Floats, fit: Fit, strength: Floats, strict: bool = False
) -> Bools:
    """Weakest root of each resonance that has more roots than directions, (n_mode,) bool."""
    found = np.zeros(len(fit.poles), bool)
    for group in resonances(f, fit, POLES.overlapping if strict else POLES.one_resonance):
        if len(group) > 1 and len(group) > directions(data, f, fit, group, strict):
            found[group[int(np.argmin(strength[group]))]] = True
    return found
