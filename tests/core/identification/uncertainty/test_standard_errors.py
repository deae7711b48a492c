"""Standard errors are those of repeated tests: error over standard error has an rms of 1."""

import numpy as np
import pytest

from trueup.core.identification.poles.moments import band_data
from trueup.core.identification.poles.variable_projection import refine
from trueup.core.identification.survey.modal_synthesis import modal_response, poles_from
from trueup.core.identification.uncertainty.standard_errors import (
    errors,
    frequency_and_damping_errors,
)

REFERENCES = [0, 15]


def normalised_errors(survey, runs, kind, smooth=False, n_line=600):
    clean, truth = survey(
        1,
        frequencies=[30, 33, 33.5, 50],
        n_response=16,
        band=(22, 70),
        n_line=n_line,
        outside=False,
        noise=0.0,
    )
    start = poles_from(truth.frequencies_hz, truth.damping)
    part = truth.shapes[REFERENCES]
    measured = np.ones(clean.values.shape[:2], bool)
    rng = np.random.default_rng(7)
    poles, shapes = [], []
    for _ in range(runs):
        H = clean.values
        e = rng.standard_normal(H.shape) + 1j * rng.standard_normal(H.shape)
        if smooth:
            e = (np.roll(e, 1, 2) + np.roll(e, -1, 2) + 2 * e) / np.sqrt(6)
        size = np.abs(H) if kind == "multiplicative" else np.sqrt(np.mean(np.abs(H) ** 2))
        data = band_data(clean.frequencies_hz, H + 0.02 * size * e, measured)
        fit = refine(data, start, part)
        found = errors(data, fit)
        f_std, z_std = frequency_and_damping_errors(fit.poles, found.poles)
        hz = np.abs(fit.poles) / (2 * np.pi)
        poles.append((hz - truth.frequencies_hz) / f_std)
        poles.append((-fit.poles.real / np.abs(fit.poles) - truth.damping) / z_std)
        t = truth.shapes
        factor = np.sum(t.conj() * fit.shapes, axis=0) / np.sum(np.abs(t) ** 2, axis=0)
        std = np.sqrt(found.shapes[..., 0, 0] + found.shapes[..., 1, 1])
        shapes.append(np.mean(np.abs(fit.shapes - t * factor) ** 2 / std**2))
    return np.sqrt(np.mean(np.square(poles))), np.sqrt(np.mean(shapes))


@pytest.mark.parametrize("kind", ["additive", "multiplicative"])
def test_errors_are_calibrated(survey, kind):
    """30 runs, 4 modes, frequency and damping: 240 numbers, so the rms is 1 within some 10 %."""
    poles, shapes = normalised_errors(survey, 30, kind)
    assert 0.8 < poles < 1.25
    assert 0.75 < shapes < 1.25


@pytest.mark.slow
@pytest.mark.parametrize(("smooth", "n_line"), [(True, 600), (False, 150)])
def test_errors_are_calibrated_with_correlated_lines_and_with_few(survey, smooth, n_line):
    poles, shapes = normalised_errors(survey, 80, "additive", smooth, n_line)
    assert 0.8 < poles < 1.25
    assert 0.75 < shapes < 1.35


def test_errors_grow_with_the_noise(survey):
    stds = []
    for noise in (0.01, 0.04):
        frfs, truth = survey(2, frequencies=[50.0], noise=noise, n_response=10, n_line=400)
        data = band_data(frfs.frequencies_hz, np.array(frfs.values), np.ones((10, 2), bool))
        fit = refine(data, poles_from(truth.frequencies_hz, truth.damping), truth.shapes[[0, 9]])
        stds.append(frequency_and_damping_errors(fit.poles, errors(data, fit).poles)[0][0])
    assert stds[1] == pytest.approx(4 * stds[0], rel=0.2)


def test_references_that_disagree_widen_the_errors(survey):
    """A frequency that moves with the shaker is no noise: the error covers the difference."""
    frfs, truth = survey(2, frequencies=[50.0], noise=0.001, n_response=10, n_line=400)
    shifted, _ = survey(2, frequencies=[50.05], noise=0.001, n_response=10, n_line=400)
    values = np.array(frfs.values)
    values[:, 1] = shifted.values[:, 1]
    stds = []
    for v in (np.array(frfs.values), values):
        data = band_data(frfs.frequencies_hz, v, np.ones((10, 2), bool))
        fit = refine(data, poles_from(truth.frequencies_hz, truth.damping), truth.shapes[[0, 9]])
        stds.append(frequency_and_damping_errors(fit.poles, errors(data, fit).poles)[0][0])
    assert stds[1] > 10 * stds[0]
    assert stds[1] > 0.005


def loaded(frequencies_of):
    """Fit one mode of 30 responses, each with a frequency of its own over that of the mode."""
    f = np.linspace(40.0, 60.0, 400)
    shapes = np.random.default_rng(3).standard_normal(30)
    poles = poles_from(50.0 * frequencies_of(shapes), np.full(30, 0.005))
    values = np.stack([
        modal_response(f, poles[o : o + 1], shapes[o : o + 1, None], shapes[[0, 29], None] / 2j)[0]
        for o in range(30)
    ])  # fmt: skip
    noise = np.random.default_rng(4).standard_normal(values.shape)
    values = values + 1e-3 * np.sqrt(np.mean(np.abs(values) ** 2)) * noise
    data = band_data(f, values, np.ones((30, 2), bool))
    fit = refine(data, poles_from([50.0], [0.005]), shapes[[0, 29], None] + 0j)
    std = frequency_and_damping_errors(fit.poles, errors(data, fit).poles)[0][0]
    return float(np.abs(fit.poles[0]) / (2 * np.pi)) - 50.0, float(std)


def test_what_the_mass_of_a_roving_sensor_takes_off_is_within_the_error():
    off, std = loaded(lambda shapes: 1.0 - 5e-4 * shapes**2)
    assert off < -0.02
    assert abs(off) < 2.0 * std


def test_runs_of_a_survey_do_not_average_out_as_its_points_do():
    """The same three frequencies, ten points after each other or in turn."""
    of_run = np.array([-1e-3, 0.3e-3, 0.7e-3])
    _, in_turn = loaded(lambda shapes: 1.0 + np.tile(of_run, 10))
    _, in_runs = loaded(lambda shapes: 1.0 + np.repeat(of_run, 10))
    assert in_runs > 1.3 * in_turn
