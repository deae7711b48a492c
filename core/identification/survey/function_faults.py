"""Functions worth less than the others: dead, of a high noise floor, cut off, of a double hit."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from ...arrays import Bools, Floats, Numbers
from ...data.frfs import Frfs
from .survey_numbers import SURVEY


def dead(values: Numbers, measured: Bools) -> Bools:
    """Tell functions whose impulse response is as large before the impulse as after it.

    What a structure answers comes after the impulse and decays; noise of any colour, and hum,
    does not. The impulse itself and a constant are left out: they are what modes outside the range
    make. Told only where the typical function of the survey does decay.

    Parameters
    ----------
    values : (n_response, n_reference, n_line) complex
    measured : (n_response, n_reference) bool

    Returns
    -------
    (n_response, n_reference) bool
    """
    after, beside = np.ones(measured.shape), np.zeros(measured.shape)
    n_line = values.shape[2]
    near, half = SURVEY.impulse, n_line // 2
    for o in np.flatnonzero(measured.any(axis=1)):
        functions = values[o, measured[o]]
        functions = functions - functions.mean(axis=1, keepdims=True)
        power = np.abs(np.fft.ifft(functions * np.hanning(n_line), axis=1)) ** 2
        late, early = power[:, near:half].sum(axis=1), power[:, half : 1 - near].sum(axis=1)
        after[o, measured[o]] = late / (late + early)
        beside[o, measured[o]] = (late + early) / power.sum(axis=1)
    if not measured.any() or np.median(after[measured]) < SURVEY.decays:
        return np.zeros(measured.shape, bool)
    return np.asarray(measured & (after < SURVEY.goes_on) & (beside > SURVEY.beside))


def noise_ratio(values: Numbers, measured: Bools, roughness: Callable[[Numbers], Floats]) -> Floats:
    """Return how many times the noise of the survey each function has, (n_output, n_input).

    The smaller of two ratios to the median: of the noise itself among the functions of the same
    input, and of noise to size among all. A weak function has little noise, a strong one much.
    By parts of the range, as the notches of a force spectrum are: the ratio is exceeded in the
    worst `noisy_part` of them. What is smoother than a measurement has rounding, no noise: 0.

    Parameters
    ----------
    values : (n_output, n_input, n_line) complex
    measured : (n_output, n_input) bool
    roughness : callable
        Noise (n_output, n_input) of values.
    """
    parts = np.array_split(values, max(values.shape[2] // SURVEY.noise_lines, 1), axis=2)
    noise = np.stack([roughness(p) for p in parts], axis=2)
    noise[~measured] = np.nan
    size = np.sqrt(np.mean(np.abs(values) ** 2, axis=2))[:, :, None]
    relative = noise / np.maximum(size, 1e-300)
    among = np.nanmedian(noise, axis=0), np.nanmedian(relative, axis=(0, 1))
    both = np.minimum(noise / np.maximum(among[0], 1e-300), relative / np.maximum(among[1], 1e-300))
    both = np.where(relative < SURVEY.too_smooth, 0.0, both)
    found = np.zeros(measured.shape)
    found[measured] = np.quantile(both[measured], 1.0 - SURVEY.noisy_part, axis=1)
    return found


def cut_off(frfs: Frfs) -> Bools:
    """Tell functions that stop at one value, as after an overload, (n_response, n_reference).

    Several lines at the largest magnitude, real or imaginary part, or several samples at the
    largest value of the impulse response (where lines from near 0 Hz give it).
    """
    f = frfs.frequencies_hz
    step = float(np.median(np.diff(f)))
    even = np.ptp(np.diff(f)) < SURVEY.even * step
    first = round(f[0] / step) if even else SURVEY.impulse_from + 1
    found = np.zeros(frfs.values.shape[:2], bool)
    for o, row in enumerate(frfs.values):
        known = np.flatnonzero(np.isfinite(row).all(axis=1))
        values = row[known]
        seen = [np.abs(values), np.abs(values.real), np.abs(values.imag)]
        if first <= SURVEY.impulse_from:
            whole = np.hstack([np.zeros((len(known), first)), values])
            seen.append(np.abs(np.fft.irfft(whole)))
        for x in seen:
            top = x.max(axis=1, initial=0.0)[:, None]
            flat = np.count_nonzero(x >= (1.0 - SURVEY.flat) * top, axis=1)
            found[o, known] |= (flat >= SURVEY.flat_lines) & (flat < x.shape[1] // 2)
    return found


def second_hits(frequencies_hz: Floats, values: Numbers, measured: Bools) -> Floats:
    """Return the delay of a second hit in each function, 0 where there is none, s.

    A second hit of a times the force, a time τ after the first and not in the force signal,
    multiplies a function by 1 + a e^(−jωτ). Functions of normal modes have one phase between
    resonances, up to the sign, and go through a resonance together: what is left of the phase of
    one against all, weighted by how well all agree at a line, is the ripple a sin ωτ. One that no
    other function of its point has is to go on over the whole range: nodes turn a phase here and
    there.

    Parameters
    ----------
    frequencies_hz : (n_line,) float
    values : (n_output, n_input, n_line) complex
    measured : (n_output, n_input) bool

    Returns
    -------
    (n_output, n_input) float
    """
    n_line = len(frequencies_hz)
    step = float(np.median(np.diff(frequencies_hz)))
    fine = 4 * n_line  # of the Fourier transform: a quarter of a cycle in the range
    cycles = np.arange(round(4 * SURVEY.echo_cycles), round(fine * SURVEY.echo_line))
    found, goes_on = np.zeros(measured.shape), np.zeros(measured.shape, bool)
    for i in range(found.shape[1]):
        rows = np.flatnonzero(measured[:, i])
        if len(rows) < SURVEY.echo_functions:
            continue
        squared = values[rows, i] ** 2
        squared /= np.maximum(np.abs(squared), 1e-300)
        common = squared.mean(axis=0)
        weight = np.abs(common)
        phase = 0.5 * np.angle(squared * common.conj()) * weight
        total = float(np.sum(weight**2))
        spread = np.sum(phase**2, axis=1) / total
        if np.median(spread) > SURVEY.echo_phase**2:
            continue
        ripple = 2.0 * np.abs(np.fft.fft(phase * weight, n=fine, axis=1)[:, cycles]) / total
        best = ripple.argmax(axis=1)
        top = ripple[np.arange(len(rows)), best]
        sure = (top > SURVEY.echo_least) & (0.5 * top**2 > SURVEY.echo_share * spread)
        found[rows[sure], i] = cycles[best[sure]] / (fine * step)
        ripples = np.exp(-2j * np.pi * cycles[best[sure], None] * np.arange(n_line) / fine)
        goes_on[rows[sure], i] = _goes_on((phase * weight)[sure] * ripples, weight**2)
    alone = np.count_nonzero(found, axis=1, keepdims=True) < SURVEY.echo_together
    slow = found < SURVEY.echo_alone / (n_line * step)
    return np.where(alone & (slow | ~goes_on), 0.0, found)


def _goes_on(products: Numbers, weight: Floats) -> Bools:
    """Tell of products of phases and ripples whether no third of the range has much less of them.

    Parameters
    ----------
    products : (n_function, n_line) complex
    weight : (n_line,) float
    """
    whole = products.sum(axis=1, keepdims=True)
    along = (products * whole.conj()).real / np.maximum(np.abs(whole) ** 2, 1e-300)
    ends = np.searchsorted(np.cumsum(weight) / weight.sum(), [1.0 / 3.0, 2.0 / 3.0])
    parts = zip(np.split(along, ends, axis=1), np.split(weight, ends), strict=True)
    shares = [part.sum(axis=1) * weight.sum() / max(float(w.sum()), 1e-300) for part, w in parts]
    return np.asarray(np.min(shares, axis=0) > SURVEY.echo_third)
