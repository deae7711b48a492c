"""Which roots are modes, and which repeat another one or stand for the background."""

from __future__ import annotations

import numpy as np

from ...arrays import Bools, Floats, Numbers
from .moments import BandData
from .pole_numbers import POLES
from .shared_noise import is_shared_noise
from .significance import residual_is_white
from .soundness import satellites, sound
from .variable_projection import Fit


def split_roots(data: BandData, f: Floats, fit: Fit, value: Floats) -> Numbers:
    """Roots that repeat a stronger one close by, (n_mode,) bool.

    Leakage splits one mode into a strong root and weak satellites of the same shape. A frequency
    that moves from reference to reference splits it into roots of one shape but different
    participation, which no structure has: a driving point is a sensor, too. Two modes that the
    sensors cannot tell apart (sparse sensors alias) agree in both; they stay when they are of
    like strength or leave nothing but white noise, which few split modes do; unless they stand
    a line apart, as the halves do that a window makes of a mode narrower than the lines. A few
    sensors tell nothing of shapes: there only what is very much weaker goes.

    Parameters
    ----------
    value : (n_mode,) float
        Significance: the noise in a shape of little significance lowers its MAC.
    """
    if len(fit.poles) < 2:
        return np.zeros(len(fit.poles), bool)
    mode, size = plausible(f, fit), strength(fit)
    surplus = satellites(data, f, fit, size)
    ratio = size / np.maximum(size[:, None], 1e-300)
    decay, omega = np.abs(fit.poles.real), fit.poles.imag
    gap = np.abs(omega - omega[:, None])
    spacing = 2.0 * np.pi * float(np.median(np.diff(f)))
    if len(fit.shapes) < POLES.telling:
        repeats = ratio < POLES.faint
    else:
        noise = 1.0 / np.maximum(2.0 * value, 1.0)
        attainable = 1.0 / ((1.0 + noise[:, None]) * (1.0 + noise))
        contradict = _mac(fit.participation) < POLES.one_participation * attainable
        white = residual_is_white(data, f, fit)
        satellite = ~white & (ratio < POLES.satellite)
        repeats = (ratio < 1.0) & (contradict | satellite | (gap < POLES.touching * spacing))
        repeats &= _mac(fit.shapes) > POLES.one_shape * attainable
    reach = POLES.split_widths * np.maximum(decay, decay[:, None]) + POLES.split_lines * spacing
    return np.asarray(surplus | (repeats & (gap < reach) & mode & mode[:, None]).any(axis=0))


def _mac(vectors: Numbers) -> Floats:
    unit = vectors / np.maximum(np.linalg.norm(vectors, axis=0), 1e-300)
    return np.asarray(np.abs(unit.conj().T @ unit) ** 2)


def strength(fit: Fit) -> Floats:
    """Energy of each mode by itself, (n_mode,)."""
    residues = np.sum(np.abs(fit.shapes) ** 2, axis=0) * np.sum(np.abs(fit.participation) ** 2, 0)
    return np.asarray(residues / np.abs(fit.poles.real))


def modes_of(data: BandData, f: Floats, fit: Fit) -> Numbers:
    """Whether each root is a mode of the structure in this band, (n_mode,) bool."""
    return np.asarray(plausible(f, fit) & sound(data, f, fit) & ~is_shared_noise(data, f, fit))


def plausible(f: Floats, fit: Fit) -> Numbers:
    """Whether each root is a mode of the band: inside, damped a little, no tone nor background.

    Roots beyond the band or as wide as a good part of it stand for what the residual terms do
    not describe; they serve the fit and are not reported.
    """
    magnitude = np.abs(fit.poles)
    hz, damping = magnitude / (2.0 * np.pi), -fit.poles.real / magnitude
    inside = (hz >= f[0]) & (hz <= f[-1])
    narrow = 2.0 * damping * hz < POLES.widest * (f[-1] - f[0])
    damped = (damping < POLES.damping_most) & ~tones(f, fit)
    return np.asarray(inside & damped & narrow)


def tones(f: Floats, fit: Fit) -> Bools:
    """Tell which roots stand in one line only, which shows no resonance, (n_mode,) bool.

    Mains and machines that do not stop make such lines, alike in all functions.
    """
    energy = 1.0 / np.abs(2j * np.pi * f[:, None] - fit.poles) ** 2
    return np.asarray(energy.max(axis=0) > POLES.one_line * energy.sum(axis=0))
