"""Where the residual of a fit still shows a root: a bank of matched filters."""

from __future__ import annotations

import numpy as np

from ..arrays import Floats, Numbers
from .stabilisation import Candidate

_WIDTHS = (0.5, 1.5, 4.0, 12.0, 36.0)  # decay rates of the filters, in line spacings
_SMOOTHED = 15  # lines over which the level of the residual is taken


def strongest_root(
    frequencies_hz: Floats, residual: Numbers, open_lines: Numbers
) -> tuple[int, Candidate]:
    """Find the root that explains most of a residual, by itself.

    Single modes of several decay rates, at every line, are correlated with all functions at
    once; the largest singular value of the matrix of correlations (output by input) is what a
    mode with the best shape and participation would explain.

    Parameters
    ----------
    frequencies_hz : (n_line,) float
    residual : (n_output, n_input, n_line) complex
    open_lines : (n_line,) bool
        Where roots are sought.

    Returns
    -------
    line : int
    root : Candidate
    """
    n_line = len(frequencies_hz)
    level = np.sqrt(np.einsum("oif,oif->f", residual, residual.conj()).real)
    width = min(_SMOOTHED, n_line)
    window = np.ones(width)
    smooth = np.convolve(level, window, "same") / np.convolve(np.ones(n_line), window, "same")
    white = residual / np.maximum(smooth, 1e-300)
    size = 2 * n_line
    spectrum = np.fft.fft(white, size)
    offset = np.fft.fftfreq(size, 1.0 / size)
    best = (-1.0, 0, 0.0, np.ones(residual.shape[1], complex))
    for decay in _WIDTHS:
        if decay > 0.1 * n_line:
            continue
        kernel = 1.0 / (1j * offset + decay)
        filtered = np.fft.ifft(spectrum * np.fft.fft(kernel).conj())[..., :n_line]
        by_line = filtered.transpose(2, 0, 1)
        gram = by_line.conj().transpose(0, 2, 1) @ by_line
        value = np.linalg.eigvalsh(gram)[:, -1] / np.sum(np.abs(kernel) ** 2)
        value = np.where(open_lines, value, -1.0)
        line = int(np.argmax(value))
        if value[line] > best[0]:
            # filtered = ψ lᵀ: the conjugate of the right singular vector is l
            participation = np.linalg.eigh(gram[line])[1][:, -1].conj()
            best = (float(value[line]), line, decay, participation)
    _, line, decay, participation = best
    around = slice(max(line - 2, 0), line + 3)
    spacing = 2.0 * np.pi * float(np.median(np.diff(frequencies_hz[around])))
    pole = complex(-decay * spacing, 2.0 * np.pi * frequencies_hz[line])
    return line, Candidate(pole, participation, 0)
