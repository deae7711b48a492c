"""Where the residual of a fit still shows a root: a bank of matched filters."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.stats import chi2

from ..arrays import Floats, Numbers
from .stabilisation import Candidate

_WIDTHS = (0.5, 1.5, 4.0, 12.0, 36.0)  # decay rates of the filters, in line spacings
_RISK = 0.1  # that noise shows a trace somewhere
_SMOOTHED = 15  # lines over which the level of the residual is taken


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
    limit : float
        What white noise hardly reaches anywhere.
    """

    frequencies_hz: Floats
    explained: Floats
    gram: Numbers
    decay: Floats
    limit: float

    def strongest(self, open_lines: Numbers) -> tuple[int, Candidate] | None:
        """Line and root of the strongest trace among `open_lines`; None when all is noise."""
        value = np.where(open_lines, self.explained, 0.0)
        d, line = np.unravel_index(int(np.argmax(value)), value.shape)
        if value[d, line] < self.limit:
            return None
        # filtered = ψ lᵀ: the conjugate of the right singular vector is l
        participation = np.linalg.eigh(self.gram[d, line])[1][:, -1].conj()
        around = slice(max(int(line) - 2, 0), int(line) + 3)
        spacing = 2.0 * np.pi * float(np.median(np.diff(self.frequencies_hz[around])))
        omega = 2.0 * np.pi * float(self.frequencies_hz[line])
        pole = complex(-float(self.decay[d]) * spacing, omega)
        return int(line), Candidate(pole, participation, 0)


def traces(frequencies_hz: Floats, residual: Numbers, measured: Numbers) -> Traces:
    """Look for roots in a residual with a bank of matched filters.

    Single modes of several decay rates, at every line, are correlated with all functions at
    once; the largest singular value of the matrix of correlations (output by input) is what a
    mode with the best shape and participation would explain.

    Parameters
    ----------
    frequencies_hz : (n_line,) float
    residual : (n_output, n_input, n_line) complex
    measured : (n_output, n_input) bool
    """
    n_output, n_input, n_line = residual.shape
    level = np.einsum("oif,oif->f", residual, residual.conj()).real / np.count_nonzero(measured)
    width = min(_SMOOTHED, n_line)
    window = np.ones(width)
    smooth = np.convolve(level, window, "same") / np.convolve(np.ones(n_line), window, "same")
    size = 2 * n_line
    spectrum = np.fft.fft(residual / np.sqrt(np.maximum(smooth, 1e-300)), size)
    offset = np.fft.fftfreq(size, 1.0 / size)
    decay = np.array([w for w in _WIDTHS if w <= 0.1 * n_line] or [_WIDTHS[0]])
    explained = np.empty((len(decay), n_line))
    grams = np.empty((len(decay), n_line, n_input, n_input), complex)
    for d in range(len(decay)):
        kernel = 1.0 / (1j * offset + decay[d])
        filtered = np.fft.ifft(spectrum * np.fft.fft(kernel).conj())[..., :n_line]
        by_line = filtered.transpose(2, 0, 1)
        grams[d] = by_line.conj().transpose(0, 2, 1) @ by_line
        explained[d] = np.linalg.eigvalsh(grams[d])[:, -1] / np.sum(np.abs(kernel) ** 2)
    freedom = (np.sqrt(2.0 * n_output) + np.sqrt(2.0 * n_input - 2.0)) ** 2
    limit = 0.5 * float(chi2.isf(_RISK / explained.size, freedom))
    return Traces(frequencies_hz, explained, grams, decay, limit)
