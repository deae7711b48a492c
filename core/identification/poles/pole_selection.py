"""Which roots of a band stand: tested against the noise, one by one, out and in."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np

from ...arrays import Floats, Numbers
from .matched_filters import Traces, traces
from .moments import BandData, basis, excerpt, onto, parts_of, unstacked
from .pole_numbers import POLES
from .pole_splitting import plausible, split_roots, strength
from .pole_stabilisation import Candidate
from .shared_noise import without_shared_noise
from .significance import allowance, best_of_noise, residual_lines, significance
from .soundness import sound
from .start_values import complete_participation
from .variable_projection import Fit, fit_shapes, refine


def select(
    data: BandData,
    frequencies_hz: Floats,
    start: Fit,
    more: Callable[[], tuple[Candidate, ...]],
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
    more : callable
        Returns roots to be tested, called when the residual shows any.
    low, high : float
        Where further roots are sought in the residual [Hz].
    """
    f = frequencies_hz
    state = prune(data, f, start)
    open_lines = (f >= low) & (f <= high)
    left, found = _look(data, f, state)
    if found.strongest(open_lines) is None:
        return state
    for c in more():
        if not found.shows(c.pole):
            continue
        poles = np.append(state.poles, c.pole)
        part = np.column_stack([state.participation, c.participation])
        spare = fit_shapes(data, poles, complete_participation(data, poles, part))
        if significance(data, f, spare)[-1] > POLES.hopeless:
            state = _try(data, f, state, spare) or state
    left, found = _look(data, f, state)
    failed = 0
    for _ in range(POLES.rounds):
        trace = found.strongest(open_lines)
        if trace is None or failed == POLES.failures:
            break
        line, root = trace
        trial = _with_neighbours(data, f, state, left, root)
        grown = None if trial is None else _try(data, f, state, trial)
        if grown is None:
            failed += 1
            open_lines[max(line - POLES.failed_around, 0) : line + POLES.failed_around + 1] = False
        else:
            failed = 0
            state = grown
            left, found = _look(data, f, state)
    return prune(data, f, state)


def prune(data: BandData, f: Floats, fit: Fit) -> Fit:
    """Refine and drop the least credible mode until all stand.

    `significance` leaves the other poles where they are, which flatters a root that stands close
    to others; so the weaker ones must also be missed when the others are refined without them.
    """
    tested = np.zeros(len(fit.poles), bool)
    while len(fit.poles):
        fit = refine(data, fit.poles, fit.participation)
        value = significance(data, f, fit)
        if np.count_nonzero(~plausible(f, fit)) > POLES.background:
            value = value * plausible(f, fit)
        drop = int(np.argmin(value))
        if value[drop] >= 1.0:
            doubles = split_roots(data, f, fit, value)
            if doubles.any():
                drop = int(np.argmin(np.where(doubles, strength(fit), np.inf)))
            else:
                doubtful = np.flatnonzero((value < POLES.beyond_doubt) & ~tested)
                missed = [k for k in doubtful if not _is_missed(data, f, fit, int(k))]
                tested[doubtful] = True
                if not missed:
                    break
                drop = int(missed[int(np.argmin(value[missed]))])
        keep = np.arange(len(fit.poles)) != drop
        fit = fit_shapes(data, fit.poles[keep], fit.participation[:, keep])
        tested = tested[keep]
    return fit


def _is_missed(data: BandData, f: Floats, fit: Fit, k: int) -> bool:
    """Tell whether the lines around a root are explained worse when its neighbours replace it.

    Poles are refined on half of the outputs, with and without the root, and judged on those that
    they have not seen (twofold cross-validation); few outputs are judged by themselves.
    """
    poles, part = fit.poles, fit.participation
    local, near, lines = _around(data, f, fit, residual_of(data, fit), complex(poles[k]))
    near[k] = True
    place = int(np.count_nonzero(near[:k]))
    others = near & (np.arange(len(near)) != k)
    gained = allowed = 0.0
    for seen, unseen in _halves(local):
        with_it = refine(seen, poles[near], part[:, near], max_iterations=POLES.trial_steps)
        without = refine(seen, poles[others], part[:, others], max_iterations=POLES.trial_steps)
        judged = fit_shapes(unseen, with_it.poles, with_it.participation)
        gained -= judged.misfit
        gained += fit_shapes(unseen, without.poles, without.participation).misfit
        allowed += float(allowance(unseen, f[lines], judged)[place])
    return bool(gained >= allowed)


def _halves(data: BandData) -> list[tuple[BandData, BandData]]:
    """Two halves of the outputs, in both orders; all of few outputs.

    Pairs of outputs go to either half in turn: of sensors along two axes both halves have both.
    """
    if len(data.weight) < 2 * POLES.responses_enough:
        return [(data, data)]
    second = np.arange(len(data.weight)) // 2 % 2 == 1
    one, other = (replace(data, y=data.y[k], weight=data.weight[k]) for k in (~second, second))
    return [(one, other), (other, one)]


def residual_of(data: BandData, fit: Fit) -> Floats:
    """Return what the fit leaves, (n_output, n_input, 2 n_line), stacked."""
    return residual_lines(data, fit, basis(data, fit.poles, derivative=False))


def _around(
    data: BandData, f: Floats, fit: Fit, left: Floats, pole: complex
) -> tuple[BandData, Numbers, slice]:
    """Cut out the lines around a pole, with the residual and the modes that stand there.

    Returns
    -------
    local : BandData
        What `left` and the near modes make of the lines.
    near : (n_mode,) bool
    lines : slice
    """
    centre = pole.imag
    gap = np.abs(fit.poles.imag - centre)
    close = gap < POLES.neighbours * np.abs(fit.poles.real)
    spacing = 2.0 * np.pi * float(np.median(np.diff(f)))
    widest = max([-pole.real, *(-fit.poles.real[close])])
    reach = max(POLES.neighbours * widest, POLES.around_least * spacing)
    near = gap < reach
    first, last = np.searchsorted(2.0 * np.pi * f, [centre - reach, centre + reach])
    if last - first < POLES.around_least:
        first = max(int(last) - POLES.around_least, 0)
    lines = slice(int(first), int(max(last, first + POLES.around_least)))
    F = basis(data, fit.poles[near], derivative=False)
    mine = parts_of((fit.shapes[:, None, :] * fit.participation[None, :, :])[..., near])
    functions = left + onto(mine, F.reshape(len(F), -1).T)
    return excerpt(data, lines, functions), near, lines


def _try(data: BandData, f: Floats, fit: Fit, start: Fit) -> Fit | None:
    """Refine a fit with one root more (the last); None when the data do not ask for it."""
    grown = refine(data, start.poles, start.participation, max_iterations=POLES.trial_steps)
    if not grown.converged:
        if significance(data, f, grown)[-1] < POLES.nearly:
            return None
        grown = refine(data, grown.poles, grown.participation)
    value = significance(data, f, grown)
    new = len(grown.poles) - 1
    if value[new] < 1.0 or split_roots(data, f, grown, value)[new]:
        return None
    if not sound(data, f, grown)[new]:
        return None
    if value[new] < POLES.beyond_doubt and not _is_missed(data, f, grown, new):
        return None
    grown = prune(data, f, grown)
    freedom = max(data.y.size - data.weight.size, 1)
    gained = (fit.misfit - grown.misfit) * freedom / max(grown.misfit, 1e-300)
    return grown if gained > 0.5 * best_of_noise(data, f, len(data.weight)) else None


def _look(data: BandData, f: Floats, fit: Fit) -> tuple[Floats, Traces]:
    """Return the residual of a fit and the traces of roots in it."""
    left = residual_of(data, fit)
    functions = without_shared_noise(unstacked(left))
    return left, traces(
        f, functions, data.weight > 0.0, POLES.direction * data.error * data.by_line
    )


def _with_neighbours(
    data: BandData, f: Floats, fit: Fit, left: Floats, root: Candidate
) -> Fit | None:
    """Add a root to a fit, at the place where a fit with its neighbours puts it (last).

    None when the fit of the lines around it shows nothing but noise.
    """
    centre = root.pole.imag
    close = np.abs(fit.poles.imag - centre) < POLES.neighbours * np.abs(fit.poles.real)
    decays = [-root.pole.real, *(-fit.poles.real[close])]
    local, near, lines = _around(data, f, fit, left, root.pole)
    best, most = None, POLES.promising
    for decay in (decays[0], float(np.median(decays))):
        poles = np.append(fit.poles[near], complex(-decay, centre))
        part = np.column_stack([fit.participation[:, near], root.participation])
        trial = refine(local, poles, part, max_iterations=POLES.trial_steps)
        values = significance(local, f[lines], trial)
        value = 0.0 if split_roots(local, f[lines], trial, values)[-1] else float(values[-1])
        if value > most:
            best, most = trial, value
    if best is None:
        return None
    poles, part = np.array(fit.poles), np.array(fit.participation)
    poles[near], part[:, near] = best.poles[:-1], best.participation[:, :-1]
    part = np.column_stack([part, best.participation[:, -1]])
    return fit_shapes(data, np.append(poles, best.poles[-1]), part)
