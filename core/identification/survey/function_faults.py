"""Functions that are worth less than the others: dead, of a high noise floor, cut off."""

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
    worst `noisy_part` of them.

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
