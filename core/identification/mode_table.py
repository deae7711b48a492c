"""The modes of all bands in one table, and the same in physical units."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..arrays import Bools, Floats, Numbers
from .poles.band_sweeps import BandFit
from .poles.significance import significance
from .survey.real_shapes import known_components, real_shapes, turned_to_principal_phase
from .survey.survey_data import Survey
from .survey.survey_numbers import SURVEY
from .uncertainty.model_error import pole_errors
from .uncertainty.standard_errors import errors
from .uncertainty.uncertainty_numbers import UNCERTAINTY


@dataclass(frozen=True, eq=False)
class ModeTable:
    """All modes by rising frequency, still in the weighting of the survey.

    Parameters
    ----------
    poles : (n_mode,) complex
    participation : (n_input, n_mode) complex
    shapes : (n_output, n_mode) complex
    pole_covariance : (n_mode, 2, 2) float
    shape_covariance : (n_output, n_mode, 2, 2) float
    significance : (n_mode,) float
    blurred : (n_mode,) bool
        See `pole_errors`.
    """

    poles: Numbers
    participation: Numbers
    shapes: Numbers
    pole_covariance: Floats
    shape_covariance: Floats
    significance: Floats
    blurred: Numbers

    @property
    def hz(self) -> Floats:
        """Undamped natural frequencies."""
        return np.asarray(np.abs(self.poles) / (2.0 * np.pi))


def collect(fits: tuple[BandFit, ...]) -> ModeTable:
    """Join the modes that the bands answer for, with their covariances."""
    parts = []
    for b in fits:
        if b.core.any():
            e = errors(b.data, b.fit)
            of_poles = e.poles if b.measured is b.data else errors(b.measured, b.fit).poles
            of_model, blurred = pole_errors(b.measured, b.frequencies_hz, b.fit)
            f, c = b.fit, b.core
            parts.append(
                (f.poles[c], f.participation[:, c], f.shapes[:, c], (of_poles + of_model)[c],
                 e.shapes[:, c], significance(b.data, b.frequencies_hz, f)[c], blurred[c])
            )  # fmt: skip
    n_output, n_input = fits[0].data.weight.shape
    empty = (
        np.empty(0, complex), np.empty((n_input, 0), complex), np.empty((n_output, 0), complex),
        np.empty((0, 2, 2)), np.empty((n_output, 0, 2, 2)), np.empty(0), np.empty(0, bool),
    )  # fmt: skip
    axes = (0, 1, 1, 0, 1, 0, 0)
    joined = [
        np.concatenate([empty[k], *(p[k] for p in parts)], axis=a) for k, a in enumerate(axes)
    ]
    order = np.argsort(np.abs(joined[0]), kind="stable")
    return ModeTable(*(np.take(x, order, axis=a) for x, a in zip(joined, axes, strict=True)))


@dataclass(frozen=True, eq=False)
class Physical:
    """Modes in the units of the functions.

    Parameters
    ----------
    shapes : (n_output, n_mode) complex
        Turned to their principal phase, as large as they came.
    real : (n_output, n_mode) float
    participation : (n_input, n_mode) complex
        For `shapes`.
    size, real_size : (n_mode,) float
        Largest component of each, of those that are known.
    std : (n_output, n_mode) float
        Standard error of real / real_size.
    known : (n_output, n_mode) bool
        See `known_components`.
    """

    shapes: Numbers
    real: Floats
    participation: Numbers
    size: Floats
    real_size: Floats
    std: Floats
    known: Bools


def physical(survey: Survey, t: ModeTable) -> Physical:
    """Take the weighting of the survey out of a table, turn shapes and find real ones."""
    raw = t.shapes / survey.output_weight[:, None]
    known = known_components(t.shapes, t.shape_covariance)
    shapes = turned_to_principal_phase(raw, known)
    rotation = np.sum(shapes * raw.conj(), axis=0)
    rotation /= np.maximum(np.abs(rotation), 1e-300)
    participation = t.participation / survey.input_weight[:, None] / rotation
    real = real_shapes(t.hz, shapes, survey.output_weight, known)
    turn = np.stack([rotation.real, -rotation.imag], axis=1)
    variance = np.einsum("ka,okab,kb->ok", turn, t.shape_covariance, turn)
    std = np.sqrt(np.maximum(variance, 0.0)) / survey.output_weight[:, None]
    size, real_size = _largest(shapes, std), _largest(real, std)
    std = np.hypot(std / real_size, UNCERTAINTY.chain)
    return Physical(shapes, real, participation, size, real_size, std, known)


def _largest(shapes: Numbers, std: Floats) -> Floats:
    """Magnitude of the largest component of each shape that is known well enough to scale by."""
    magnitude = np.abs(shapes)
    known = np.where(std < SURVEY.known * magnitude, magnitude, 0.0).max(axis=0, initial=0.0)
    return np.asarray(np.where(known > 0.0, known, magnitude.max(axis=0, initial=0.0)))
