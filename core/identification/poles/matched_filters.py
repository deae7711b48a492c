"""Where the residual of a fit still shows a root: a bank of matched filters."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import scipy.fft
from scipy.special import chdtri

from ...arrays import Floats, Numbers
from .pole_numbers import POLES
from .pole_stabilisation import Candidate


@dataclass(frozen=True, eq=False)
class Traces:
    """What single modes of several decay rates, at every line, would explain of a residual.

    Parameters
    ----------
    frequencies_hz : (n_line,) float
    explained : (n_decay, n_line) float
        Largest squared singular value of the filtered matrix of functions, 1 being the mean of
        one function's noise.
    gram : (n_decay, n_line, n_input, n_input) complex
    decay : (n_decay,) float
        In line spacings.
    limit : (n_decay, n_line) float
        What white noise hardly reaches anywhere, nor the errors of the survey.
    """

    frequencies_hz: Floats
    explained: Floats
    gram: Numbers
    decay: Floats
    limit: Floats

    def shows(self, pole: complex) -> bool:
        """Tell whether there is a trace where a pole stands."""
        line = int(np.argmin(np.abs(2.0 * np.pi * self.frequencies_hz - pole.imag)))
        return bool((self.explained > self.limit)[:, max(line - 1, 0) : line + 2].any())

    def strongest(self, open_lines: Numbers) -> tuple[int, Candidate] | None:
        """Line and root of the strongest trace among `open_lines`; None when all is noise."""
        value = np.where(open_lines & (self.explained > self.limit), self.explained, 0.0)
        d, line = np.unravel_index(int(np.argmax(value)), value.shape)
        if value[d, line] == 0.0:
            return None
        # filtered = ψ lᵀ: the conjugate of the right singular vector is l
        participation = np.linalg.eigh(self.gram[d, line])[1][:, -1].conj()
        around = slice(max(int(line) - 2, 0), int(line) + 3)
        spacing = 2.0 * np.pi * float(np.median(np.diff(self.frequencies_hz[around])))
        omega = 2.0 * np.pi * float(self.frequencies_hz[line])
        pole = complex(-float(self.decay[d]) * spacing, omega)
        return int(line), Candidate(pole, participation, 0)


def traces(frequencies_hz: Floats, residual: Numbers, measured: Numbers, error: Floats) -> Traces:
    """Look for roots in a residual with a bank of matched filters.

    Single modes of several decay rates, at every line, are correlated with all functions at
    once; the largest singular value of the matrix of correlations (output by input) is what a
    mode with the best shape and participation would explain.

    Parameters
    ----------
    frequencies_hz : (n_line,) float
    residual : (n_output, n_input, n_line) complex
    measured : (n_output, n_input) bool
    error : (n_line,) float
        Energy that the errors of the survey leave at each line, of all functions.
    """
    n_output, n_input, n_line = residual.shape
    level = np.einsum("oif,oif->f", residual.real, residual.real)
    level += np.einsum("oif,oif->f", residual.imag, residual.imag)
    level /= np.count_nonzero(measured)
    width = min(POLES.filter_smoothed, n_line)
    window = np.ones(width)
    smooth = np.convolve(level, window, "same") / np.convolve(np.ones(n_line), window, "same")
    size = int(scipy.fft.next_fast_len(2 * n_line))
    scale = 1.0 / np.sqrt(np.maximum(smooth, 1e-300))
    offset = np.fft.fftfreq(size, 1.0 / size)
    widths, widest = POLES.filter_widths, POLES.filter_widest * n_line
    decay = np.array([w for w in widths if w <= widest] or [widths[0]])
    kernels = 1.0 / (1j * offset + decay[:, None])
    filters = scipy.fft.fft(kernels).conj().astype(np.complex64)  # enough to find a start
    grams = np.zeros((len(decay), n_line, n_input, n_input), complex)
    step = max(1, POLES.filter_at_once // (n_input * size))
    for first in range(0, n_output, step):
        functions = (residual[first : first + step] * scale).astype(np.complex64)
        spectrum = scipy.fft.fft(functions, size)
        for d in range(len(decay)):
            filtered = scipy.fft.ifft(spectrum * filters[d])[..., :n_line]
            by_line = np.ascontiguousarray(filtered.transpose(2, 1, 0))
            grams[d] += by_line.conj() @ by_line.transpose(0, 2, 1)
    energy = np.sum(np.abs(kernels) ** 2, axis=1)
    explained = np.linalg.eigvalsh(grams)[..., -1] / energy[:, None]
    freedom = (np.sqrt(2.0 * n_output) + np.sqrt(2.0 * n_input - 2.0)) ** 2
    white = 0.5 * float(chdtri(freedom, POLES.filter_risk / explained.size))
    of_errors = [
        _summed(error, 1 + int(2.0 * POLES.seen_widths * w)) / np.maximum(smooth, 1e-300)
        for w in decay
    ]
    return Traces(frequencies_hz, explained, grams, decay, np.maximum(white, of_errors))


def _summed(values: Floats, width: int) -> Floats:
    """Return sums over the lines around each, (n_line,)."""
    return np.asarray(np.convolve(values, np.ones(min(width, len(values))), "same"))
