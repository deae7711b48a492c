"""The complex mode indicator function, and bands that hold a handful of modes each."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from ...arrays import Floats, Ints, Numbers
from .survey_numbers import SURVEY


@dataclass(frozen=True)
class Band:
    """A part of the measured range; modes are taken from the core, fits use the margins too.

    Parameters
    ----------
    low, high : float
        Core [Hz]; the cores of all bands tile the range.
    first, last : float
        With margins [Hz].
    """

    low: float
    high: float
    first: float
    last: float


def cmif(values: Numbers) -> Floats:
    """Complex mode indicator function: singular values of the response matrix at every line.

    Parameters
    ----------
    values : (n_output, n_input, n_line) complex

    Returns
    -------
    (n_line, n_value) float
        Largest first; n_value is the smaller of n_output and n_input.

    References
    ----------
    Shih, Tsuei, Allemang, Brown (1988), Complex mode indication function and its applications to
    spatial domain parameter estimation, MSSP 2, 367-377.
    """
    return np.asarray(np.linalg.svd(values.transpose(2, 0, 1), compute_uv=False))


def peaks(indicator: Floats, floor: float) -> Ints:
    """Lines at which a singular value peaks above the noise, rising; one may stand twice.

    Parameters
    ----------
    indicator : (n_line, n_value) float
    floor : float
        What noise alone makes of the singular values.
    """
    from scipy.signal import find_peaks

    found = []
    for column in np.maximum(indicator.T, 1e-300):
        lines, _ = find_peaks(20.0 * np.log10(column), prominence=SURVEY.prominence_db)
        out_of_noise, _ = find_peaks(column, height=2.0 * floor, prominence=floor)
        found.append(np.intersect1d(lines, out_of_noise))
    return np.sort(np.concatenate(found)) if found else np.empty(0, np.int64)


def split(frequencies_hz: Floats, indicator: Floats, floor: float) -> tuple[Band, ...]:
    """Split the range at valleys of the indicator until no band has many peaks.

    Parameters
    ----------
    frequencies_hz : (n_line,) float
    indicator : (n_line, n_value) float
        Singular values.
    floor : float
        What noise alone makes of the singular values.
    """
    lines = peaks(indicator, floor)
    widths = _widths(indicator, lines)
    valley = np.log(np.maximum(indicator[:, 0], 1e-300))
    edges = [0, *_cuts(valley, lines, widths, 0, len(frequencies_hz) - 1), len(frequencies_hz) - 1]
    f = frequencies_hz
    bands = []
    for a, b in pairwise(edges):
        some = f[min(a + SURVEY.margin_lines, len(f) - 1)] - f[a]
        margin = max(SURVEY.margin * (f[b] - f[a]), some)
        first, last = max(f[a] - margin, f[0]), min(f[b] + margin, f[-1])
        bands.append(Band(float(f[a]), float(f[b]), float(first), float(last)))
    return tuple(bands)


def _widths(indicator: Floats, lines: Ints) -> Floats:
    """Half-power widths of peaks, in lines, by the singular value that is narrowest there."""
    from scipy.signal import find_peaks, peak_widths

    result = np.full(len(lines), float(len(indicator)))
    for column in indicator.T:
        tops, _ = find_peaks(column)
        here = np.flatnonzero(np.isin(lines, tops))
        if len(here):
            width = peak_widths(column**2, lines[here], rel_height=0.5)[0]
            result[here] = np.minimum(result[here], width)
    return result


def _cuts(valley: Floats, lines: Ints, widths: Floats, a: int, b: int) -> list[int]:
    here = (lines > a) & (lines < b)
    inside = lines[here]
    wide = int(SURVEY.core_widths * np.median(widths[here])) if len(inside) else 0
    least = max(SURVEY.core_least, wide)
    low, high = a + least, b - least
    few = len(inside) <= SURVEY.peaks_most
    if (few and b - a <= SURVEY.core_most) or low >= high:
        return []
    if few:
        low, high = a + (b - a) // 3, b - (b - a) // 3
        cut = low + int(np.argmin(valley[low:high]))
        return [*_cuts(valley, lines, widths, a, cut), cut, *_cuts(valley, lines, widths, cut, b)]
    quarter = len(inside) // 4
    low, high = max(low, int(inside[quarter])), min(high, int(inside[-quarter - 1]))
    if low >= high:
        low, high = (a + b) // 2, (a + b) // 2 + 1
    cut = low + int(np.argmin(valley[low:high]))
    return [*_cuts(valley, lines, widths, a, cut), cut, *_cuts(valley, lines, widths, cut, b)]
