"""Which roots are modes of the structure, where a survey leaves more than noise.

Functions of a real survey do not share one exact set of poles, lines are cut by windows, a hammer
blow is never the same twice. What this leaves over looks like roots: satellites of a resonance that
repeat its one direction, and roots, mostly wide and complex, on which its errors are hung.
"""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np

from ...arrays import Bools, Floats
from ..quality import phase_collinearity
from .moments import BandData, basis
from .pole_numbers import POLES
from .significance import energy_by_line, memory_of_residual
from .variable_projection import Fit


def survey_error(fits: Iterable[tuple[BandData, Floats, Fit]]) -> float:
    """Median over the roots of the part of the energy around them left over beyond noise."""
    shares: list[float] = []
    for data, f, fit in (x for x in fits if len(x[2].poles)):
        memory = memory_of_residual(data, f, fit)
        power = np.einsum("oin,oin->n", data.y, data.y).reshape(2, -1).sum(axis=0)
        shares += list(memory.systematic / np.maximum(power @ memory.near, 1e-300))
    return float(np.median(shares)) if shares else 0.0


def sound(data: BandData, f: Floats, fit: Fit) -> Bools:
    """Tell which roots are more than the errors of the survey, (n_mode,) bool.

    Two estimates of the error in a root, over its own energy: what is left over around it and is
    not noise, and what of its shape is in quadrature (errors have as much in phase). Their
    geometric mean is to stay below a limit. All are sound where the survey leaves noise only.
    """
    if not len(fit.poles) or data.error == 0.0:
        return np.ones(len(fit.poles), bool)
    left = left_over(data, f, fit)
    collinear = np.sqrt(phase_collinearity(fit.shapes))
    error = left * (1.0 - collinear) / np.maximum(collinear, 1e-300)
    return np.asarray(error < POLES.error_most**2)


def left_over(data: BandData, f: Floats, fit: Fit) -> Floats:
    """Energy that is left over around each root and is not noise, over the root's own there.

    Returns
    -------
    (n_mode,) float
    """
    memory = memory_of_residual(data, f, fit)
    own = energy_by_line(data, fit, basis(data, fit.poles, derivative=False)[:, 0])
    here = np.sum(own * memory.near, axis=0)
    excess = np.where(memory.ratio > 1.0 + POLES.sure * memory.scatter, memory.systematic, 0.0)
    return np.asarray(excess / np.maximum(here, 1e-300))


def resonances(f: Floats, fit: Fit) -> list[list[int]]:
    """Roots by rising frequency, in groups that stand within each other's width."""
    spacing = 2.0 * np.pi * float(np.median(np.diff(f)))
    order = np.argsort(fit.poles.imag)
    decay, omega = -fit.poles.real, fit.poles.imag
    groups: list[list[int]] = []
    for k in order:
        if groups:
            last = groups[-1][-1]
            reach = POLES.one_resonance * min(decay[k], decay[last]) + spacing
            if omega[k] - omega[last] < reach:
                groups[-1].append(int(k))
                continue
        groups.append([int(k)])
    return groups


def directions(f: Floats, fit: Fit, group: list[int], error: float) -> int:
    """Count the independent directions of a resonance, at least one.

    A frequency that scatters from output to output makes many roots of one participation, one
    that scatters from input to input many of one shape; two modes differ in both. Where they
    differ in one only (as all do before a single reference), directions must be stronger than
    such scatter makes them; but where a survey without error has no more inputs (or outputs) than
    they show, all roots count.

    Parameters
    ----------
    error : float
        Energy of what a resonance leaves over, of its own.
    """
    poles, omega = fit.poles[group], 2.0 * np.pi * f
    lines = (np.abs(omega[:, None] - poles.imag) < POLES.seen_widths * -poles.real).any(axis=1)
    lines[[int(np.argmin(np.abs(omega - w))) for w in poles.imag]] = True
    near = 1.0 / (1j * omega[lines] - poles[:, None])
    functions = np.einsum(
        "ok,ik,kn->oin", fit.shapes[:, group], fit.participation[:, group], near, optimize=True
    )
    told, strong = [], []
    for matrix in (functions, functions.transpose(1, 0, 2)):
        energy = np.linalg.svd(matrix.reshape(len(matrix), -1), compute_uv=False) ** 2
        limit = POLES.direction * max(error, POLES.error_least) * energy[0]
        count = int(np.count_nonzero(energy > limit))
        if count == len(matrix) and error == 0.0:
            return len(group)
        told.append(count)
        strong.append(int(np.count_nonzero(energy > POLES.scatter * error * energy[0])))
    return max(min(told), *strong) if error > 0.0 else min(told)


def satellites(data: BandData, f: Floats, fit: Fit, strength: Floats) -> Bools:
    """Weakest root of each resonance that has more roots than directions, (n_mode,) bool."""
    found = np.zeros(len(fit.poles), bool)
    for group in resonances(f, fit):
        if len(group) > 1 and len(group) > directions(f, fit, group, data.error):
            found[group[int(np.argmin(strength[group]))]] = True
    return found
