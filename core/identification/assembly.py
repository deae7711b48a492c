"""From fitted bands to the result: physical units, quality, scale, remarks."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..arrays import Bools, Floats, Numbers
from ..geometry import Geometry
from ..modes import Modes
from .bands import cmif
from .model_error import CHAIN, pole_errors
from .quality import correlation, multivariate_indicator, phase_collinearity, phase_deviation
from .result import Background, Identification, Indicator, background_response, residual_terms
from .rigid import rigid_share
from .scaling import driving_points, scale
from .shapes import known_components, real_shapes, turned_to_principal_phase
from .stabilisation import Chart
from .survey import Survey
from .sweeps import BandFit
from .synthesis import modal_response
from .uncertainty import errors, frequency_and_damping_errors

_POOR_QUALITY = 0.9
_POOR_MPC = 0.7
_WEAK = 0.05  # relative standard error of the shape above which it is called uncertain
_KNOWN = 0.3  # relative standard error of a component that a shape may be scaled by
_INPUT_RANK = 0.02  # singular value ratio below which references see one and the same


@dataclass(frozen=True, eq=False)
class _Table:
    """All modes by rising frequency, still in the weighting of the survey."""

    poles: Numbers
    participation: Numbers
    shapes: Numbers
    pole_covariance: Floats
    shape_covariance: Floats
    significance: Floats
    blurred: Numbers


def _collect(fits: tuple[BandFit, ...]) -> _Table:
    parts = []
    for b in fits:
        if b.core.any():
            e = errors(b.data, b.fit)
            of_model, blurred = pole_errors(b.data, b.frequencies_hz, b.fit)
            f, c = b.fit, b.core
            parts.append(
                (f.poles[c], f.participation[:, c], f.shapes[:, c], (e.poles + of_model)[c],
                 e.shapes[:, c], b.significance[c], blurred[c])
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
    return _Table(*(np.take(x, order, axis=a) for x, a in zip(joined, axes, strict=True)))


def assemble(
    survey: Survey,
    fits: tuple[BandFit, ...],
    charts: tuple[Chart, ...],
    geometry: Geometry | None = None,
) -> Identification:
    """Bring the modes of all bands into physical units, judge them, find their scale.

    Parameters
    ----------
    survey : Survey
    fits : tuple of BandFit
    charts : tuple of Chart
        Stabilisation of each band.
    geometry : Geometry, optional
        For driving points under two numbers.
    """
    t = _collect(fits)
    hz = np.abs(t.poles) / (2.0 * np.pi)
    damping = -t.poles.real / np.abs(t.poles)
    raw = t.shapes / survey.output_weight[:, None]
    known = known_components(t.shape_covariance)
    shapes = turned_to_principal_phase(raw, known)
    rotation = np.sum(shapes * raw.conj(), axis=0)
    rotation /= np.maximum(np.abs(rotation), 1e-300)
    participation = t.participation / survey.input_weight[:, None] / rotation
    real = real_shapes(hz, shapes, survey.output_weight, known)
    turn = np.stack([rotation.real, -rotation.imag], axis=1)
    variance = np.einsum("ka,okab,kb->ok", turn, t.shape_covariance, turn)
    shape_std = np.sqrt(np.maximum(variance, 0.0)) / survey.output_weight[:, None]
    size, real_size = _largest(shapes, shape_std), _largest(real, shape_std)
    shape_std = np.hypot(shape_std / real_size, CHAIN)
    points = driving_points(survey.outputs, survey.inputs, geometry)
    scaling = scale(t.poles, shapes, participation, points, survey.inputs)
    shapes, participation = shapes / size, participation * size
    warnings = [*survey.warnings, *(scaling.warnings if len(hz) else ())]
    f_std, z_std = frequency_and_damping_errors(t.poles, t.pole_covariance)
    backgrounds, quality = _backgrounds(survey, fits, t, hz)
    pair = _pair_possible(survey, t, warnings)
    mpc = phase_collinearity(np.where(known, shapes, 0.0))
    physical = survey.values / survey.output_weight[:, None, None]
    physical /= survey.input_weight[None, :, None]
    mif = multivariate_indicator(survey.values, survey.order)
    near = np.array([int(np.argmin(np.abs(survey.frequencies_hz - x))) for x in hz], dtype=int)
    at_mode = np.array([mif[max(k - 2, 0) : k + 3].min() for k in near])
    remarks = _remarks(survey, hz, t, quality, mpc, shape_std, real / real_size, known)
    warnings += _blurred(hz, t.blurred)
    if not len(hz):
        warnings.append("no mode stands out of the noise")
    source = survey.source

    def modes(s: Numbers, mass_scale: Floats) -> Modes:
        mass = scaling.modal_mass / mass_scale**2
        return Modes(hz, s, survey.outputs, damping, mass, source)

    return Identification(
        modes=modes(shapes, size),
        real_modes=modes(real / real_size, real_size),
        frequency_std=f_std,
        damping_std=z_std,
        shape_std=shape_std,
        participation=participation,
        references=survey.inputs,
        mpc=mpc,
        mpd=phase_deviation(np.where(known, shapes, 0.0)),
        mode_indicator=1.0 - at_mode,
        quality=quality,
        significance=t.significance,
        close_pair_possible=pair,
        rigid_share=rigid_share(real, survey.outputs, geometry),
        remarks=remarks,
        bands=backgrounds,
        chart=_joined_chart(fits, charts),
        cmif=Indicator(survey.frequencies_hz, cmif(physical)),
        quantity=survey.quantity,
        warnings=tuple(warnings),
    )


def _largest(shapes: Numbers, std: Floats) -> Floats:
    """Magnitude of the largest component of each shape that is known well enough to scale by."""
    magnitude = np.abs(shapes)
    known = np.where(std < _KNOWN * magnitude, magnitude, 0.0).max(axis=0, initial=0.0)
    return np.asarray(np.where(known > 0.0, known, magnitude.max(axis=0, initial=0.0)))


def _backgrounds(
    survey: Survey, fits: tuple[BandFit, ...], t: _Table, hz: Floats
) -> tuple[tuple[Background, ...], Floats]:
    """Residual terms of each band at the final modes, and how well each mode is synthesised."""
    found = []
    quality = np.zeros(len(hz))
    out, inp = survey.output_weight[:, None], survey.input_weight[:, None]
    for b in fits:
        lines = survey.lines(b.band.first, b.band.last)
        f = survey.frequencies_hz[lines]
        measured = survey.values[:, :, lines]
        modal = modal_response(f, t.poles, t.shapes, t.participation, survey.quantity)
        aside = b.background
        roots = b.fit.poles[aside], b.fit.shapes[:, aside], b.fit.participation[:, aside]
        left = measured - modal
        if aside.any():
            left = left - modal_response(f, *roots, survey.quantity)
        terms = residual_terms(f, survey.quantity)
        size = np.linalg.norm(terms, axis=1)
        residuals = left @ np.linalg.pinv(terms / size[:, None]) / size
        weighted = Background(b.band, residuals.transpose(2, 0, 1), *roots)
        synthesised = modal + background_response(f, weighted, survey.quantity)
        for k in np.flatnonzero((hz >= b.band.low) & (hz <= b.band.high)):
            half = max(2.0 * abs(t.poles[k].real) / np.pi, 5.0 * float(np.median(np.diff(f))))
            near = np.abs(f - hz[k]) <= half
            used = survey.measured
            quality[k] = correlation(measured[:, :, near][used], synthesised[:, :, near][used])
        found.append(
            Background(
                b.band,
                weighted.residuals / out / inp.T,
                roots[0],
                roots[1] / out,
                roots[2] / inp,
            )
        )
    return tuple(found), quality


def _pair_possible(survey: Survey, t: _Table, warnings: list[str]) -> Numbers:
    """Flag the modes behind which the references cannot see a second root."""
    n = len(t.poles)
    if not n:
        return np.zeros(0, bool)
    part = t.participation / np.linalg.norm(t.participation, axis=0)
    singular = np.linalg.svd(part, compute_uv=False)
    if len(t.participation) == 1:
        warnings.append(
            "one reference cannot tell two roots at the same frequency apart: a close pair may "
            "hide behind any of the modes"
        )
        return np.ones(n, bool)
    if n > 1 and len(singular) > 1 and singular[1] < _INPUT_RANK * singular[0]:
        warnings.append(
            "all references excite the same combination of modes, as one reference would: a "
            "close pair may hide behind any of the modes"
        )
        return np.ones(n, bool)
    return np.zeros(n, bool)


def _blurred(hz: Floats, blurred: Numbers) -> list[str]:
    if not blurred.any():
        return []
    which = ", ".join(f"{f:.2f}" for f in hz[blurred][:5])
    which += ", ..." if np.count_nonzero(blurred) > 5 else ""
    return [
        f"{np.count_nonzero(blurred)} mode(s) ({which} Hz) are narrow for the lines and leave a "
        "residual that is not noise (leakage): their damping may be too high, as its standard "
        "error says"
    ]


def _remarks(
    survey: Survey,
    hz: Floats,
    t: _Table,
    quality: Floats,
    mpc: Floats,
    std: Floats,
    real: Floats,
    known: Bools,
) -> tuple[str, ...]:
    texts = []
    f, labels = survey.frequencies_hz, survey.outputs.labels
    for k in range(len(hz)):
        found = []
        if quality[k] < _POOR_QUALITY:
            found.append(f"synthesised and measured functions agree to {quality[k]:.2f} only")
        if mpc[k] < _POOR_MPC:
            found.append(f"complex shape (phase collinearity {mpc[k]:.2f})")
        sure = known[:, k]
        spread = np.sqrt(np.mean(std[sure, k] ** 2) / np.mean(real[sure, k] ** 2))
        if not sure.all() and (std[~sure, k] > _KNOWN * np.abs(real[:, k][sure]).max()).any():
            where = [labels[o] for o in np.flatnonzero(~sure)[:5]]
            found.append(f"its shape is hardly known at {', '.join(where)}")
        if spread > _WEAK:
            found.append(f"uncertain shape ({100 * spread:.0f} %)")
        width = abs(t.poles[k].real) / np.pi
        if hz[k] - f[0] < width or f[-1] - hz[k] < width:
            found.append("at the edge of the measured range")
        texts.append("; ".join(found))
    return tuple(texts)


def _joined_chart(fits: tuple[BandFit, ...], charts: tuple[Chart, ...]) -> Chart:
    order, hz, damping, stable = [], [], [], []
    for fit, c in zip(fits, charts, strict=True):
        here = (c.frequency_hz >= fit.band.low) & (c.frequency_hz <= fit.band.high)
        order.append(c.order[here])
        hz.append(c.frequency_hz[here])
        damping.append(c.damping[here])
        stable.append(c.stable[here])
    return Chart(*(np.concatenate(x) for x in (order, hz, damping, stable)))
