"""Functions of the wrong sign: those that contradict the others of their output."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from .survey_data import Survey
from .survey_numbers import SURVEY


def signs_mended(survey: Survey) -> Survey:
    """Turn the functions whose sign contradicts the others, and name them.

    Where one mode rules, the functions of every output go as its participation, which is the
    first right singular vector of all functions at the line. Where those of one output follow it
    far better with one of them turned, that one has the wrong sign. Two references cannot tell
    which of them it is.
    """
    n_input = survey.values.shape[1]
    if n_input < SURVEY.signs_inputs:
        return survey
    _, size, vh = np.linalg.svd(survey.values.transpose(2, 0, 1), full_matrices=False)
    clear = size[:, 0] > SURVEY.signs_clear * size[:, 1]
    part = survey.values[..., clear] * vh[clear, 0].conj().T
    own = np.sum(np.abs(survey.values[..., clear]) ** 2, axis=(1, 2))
    signs = np.vstack([np.ones(n_input), 1.0 - 2.0 * np.eye(n_input)])
    left = own - np.sum(np.abs(np.einsum("si,oin->son", signs, part)) ** 2, axis=2)
    best = np.argmin(left, axis=0)
    wrong = (best > 0) & (left[best, np.arange(len(best))] < SURVEY.signs_better * left[0])
    wrong &= survey.measured.all(axis=1)
    if not wrong.any():
        return survey
    rows, columns = np.flatnonzero(wrong), best[wrong] - 1
    values = survey.values.copy()
    values[rows, columns] *= -1.0
    pairs = [(survey.outputs.labels[a], survey.inputs.labels[b])
             for a, b in zip(rows, columns, strict=True)]  # fmt: skip
    names = ", ".join("/".join(p[::-1] if survey.roving_hammer else p) for p in pairs)
    warning = f"{names}: of the wrong sign, as the other functions of that point say; turned"
    return replace(survey, values=values, warnings=(*survey.warnings, warning))
