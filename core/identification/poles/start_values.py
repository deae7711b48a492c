"""Start values of a fit from candidates that some inputs took no part in."""

from __future__ import annotations

import numpy as np

from ...arrays import Numbers
from .moments import BandData
from .pole_numbers import POLES
from .pole_stabilisation import Candidate
from .variable_projection import Fit, fit_shapes


def start_from(data: BandData, candidates: tuple[Candidate, ...]) -> Fit:
    """Shapes for the candidates as proposed, participations completed."""
    n_input = data.weight.shape[1]
    poles = np.array([c.pole for c in candidates], dtype=complex)
    part = np.array([c.participation for c in candidates], dtype=complex)
    part = complete_participation(data, poles, part.reshape(-1, n_input).T)
    return fit_shapes(data, poles, part)


def complete_participation(data: BandData, poles: Numbers, part: Numbers) -> Numbers:
    """Fill in participations not known yet (NaN) from residues fitted input by input.

    Parameters
    ----------
    part : (n_input, n_mode) complex
    """
    unknown = np.isnan(part)
    if not unknown.any():
        return part
    n_output, n_input = data.weight.shape
    residues = np.zeros((n_output, n_input, len(poles)), complex)
    for i in range(n_input):
        rows = data.weight[:, i] > 0.0
        one = BandData(
            data.s, data.residual_terms, data.y[rows, i : i + 1],
            data.weight[rows, i : i + 1],
        )  # fmt: skip
        residues[rows, i] = fit_shapes(one, poles, np.ones((1, len(poles)), complex)).shapes
    part = np.where(unknown, 0.0, part)
    W = data.weight[:, :, None]
    for _ in range(POLES.start_rounds):
        weight = np.sum(W * np.abs(part) ** 2, axis=1)
        shape = np.sum(W * part.conj() * residues, axis=1) / np.maximum(weight, 1e-300)
        power = np.sum(W * np.abs(shape[:, None]) ** 2, axis=0)
        new = np.sum(W * shape.conj()[:, None] * residues, axis=0) / np.maximum(power, 1e-300)
        part = np.where(unknown, new, part)
    return np.asarray(part)
