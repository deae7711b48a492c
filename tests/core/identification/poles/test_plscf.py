"""The linear estimator by itself: exact on clean data, and what it cannot explain is unstable."""

import numpy as np
import pytest

from trueup.core.identification.poles.plscf import poles_by_order
from trueup.core.identification.poles.pole_stabilisation import stabilise
from trueup.core.identification.survey.modal_synthesis import modal_response, poles_from


def functions(frequencies, damping, n_output=12, n_input=2, seed=0, lines=None):
    rng = np.random.default_rng(seed)
    lines = np.linspace(40.0, 60.0, 801) if lines is None else lines
    shapes = rng.standard_normal((n_output, len(frequencies))).astype(complex)
    part = rng.standard_normal((n_input, len(frequencies))).astype(complex)
    poles = poles_from(np.asarray(frequencies, float), np.asarray(damping, float))
    return lines, modal_response(lines, poles, shapes, part), poles, part


@pytest.mark.parametrize("n_input", [1, 2, 3])
def test_poles_of_clean_functions_are_exact(n_input):
    lines, values, poles, _ = functions([44.0, 50.0, 53.0], [0.004, 0.01, 0.007], n_input=n_input)
    (found,) = poles_by_order(lines, values, [20])
    for pole in poles:
        assert np.abs(found.values - pole).min() < 1e-5 * abs(pole)


def test_participation_goes_with_its_pole():
    lines, values, poles, part = functions([48.0, 48.2], [0.005, 0.005])
    (found,) = poles_by_order(lines, values, [16])
    for k, pole in enumerate(poles):
        w = found.participation[np.argmin(np.abs(found.values - pole))]
        assert abs(np.vdot(w, part[:, k])) > (1 - 1e-4) * np.linalg.norm(part[:, k])


def test_lines_need_not_be_even():
    lines = 40.0 + 20.0 * np.linspace(0.0, 1.0, 700) ** 1.3
    lines, values, poles, _ = functions([45.0, 52.0], [0.004, 0.006], lines=lines)
    (found,) = poles_by_order(lines, values, [16])
    for pole in poles:
        assert np.abs(found.values - pole).min() < 1e-5 * abs(pole)


def test_poles_that_describe_noise_are_unstable():
    lines, values, poles, _ = functions([44.0, 50.0, 53.0], [0.004, 0.01, 0.007])
    rng = np.random.default_rng(1)
    noise = rng.standard_normal(values.shape) + 1j * rng.standard_normal(values.shape)
    values = values + 0.02 * np.sqrt(np.mean(np.abs(values) ** 2)) * noise
    (found,) = poles_by_order(lines, values, [30])
    stable = found.values[found.values.real < 0.0]
    assert len(found.values) > 20
    assert len(stable) == len(poles)


def test_stabilisation_follows_a_pair_as_two_tracks():
    lines, values, poles, _ = functions([50.0, 50.1], [0.005, 0.006])
    rng = np.random.default_rng(2)
    noise = rng.standard_normal(values.shape) + 1j * rng.standard_normal(values.shape)
    values = values + 0.01 * np.sqrt(np.mean(np.abs(values) ** 2)) * noise
    candidates, chart = stabilise(poles_by_order(lines, values, range(1, 21)), 40.0, 60.0)
    assert len(candidates) == 2
    for c, pole in zip(candidates, poles, strict=True):
        assert abs(c.pole - pole) < 0.1 * abs(pole.real)
    assert chart.stable.sum() >= 2 * 12
    assert np.all(np.diff(chart.order) >= 0)
