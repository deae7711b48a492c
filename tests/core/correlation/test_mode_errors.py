"""Standard errors of identified modes weigh: by mode in the residuals, by sensor in the MAC."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
import scipy.sparse as sp
from tests.core.correlation.test_comparison import analysis, measured
from tests.core.updating.spring_chain import HALVES, chain, measured as target_of
from tests.core.updating.weighing import eigenvalue_residuals, shape_residuals

from trueup.core.correlation.comparison import compare, place_test
from trueup.core.correlation.mode_errors import (
    ModeErrors,
    mode_errors,
    told,
    with_scatter,
)
from trueup.core.correlation.mode_pairing import Pair
from trueup.core.errors import InputError
from trueup.core.updating.residuals import Weights
from trueup.core.updating.update import Stage, update

__all__ = ["analysis"]


def test_errors_are_relative_to_frequencies_and_rms_readings():
    shapes = np.array([[3.0, 0.2], [4.0, 0.2]])
    std = np.array([[0.5, 0.0], [0.0, 0.02]])
    found = mode_errors(np.array([10.0, 20.0]), shapes, np.array([0.1, 0.02]), std)
    np.testing.assert_allclose(found.frequency, [0.01, 0.001])
    rms = np.sqrt(12.5)
    np.testing.assert_allclose(found.shape, [[0.5 / rms, 0.0], [0.0, 0.1]])
    np.testing.assert_allclose(found.length, np.linalg.norm(std, axis=0) / [5.0, np.sqrt(0.08)])


def test_sensors_alike_weigh_alike_and_a_poor_one_less():
    alike = ModeErrors(np.zeros(3), np.full((5, 3), 0.02))
    np.testing.assert_allclose(alike.sensors, 1.0)
    shape = np.full((5, 3), 0.02)
    shape[2] = 0.5
    weight = ModeErrors(np.zeros(3), shape).sensors
    assert weight[2] == pytest.approx((0.05**2 + 0.02**2) / (0.05**2 + 0.5**2))
    assert "sensor(s) c count less than half" in told(ModeErrors(np.zeros(3), shape), "abcde")
    assert "less than half" not in told(alike, "abcde")


def test_each_residual_is_over_the_deviation_of_its_own_pair():
    hz, sigma = np.array([10.0, 20.0]), np.array([0.01, 0.04])
    pairs = [Pair(0, 0, 10.0, 11.0, 1.0), Pair(1, 1, 20.0, 22.0, 1.0)]
    lam = (2.0 * np.pi * hz * 1.1) ** 2
    found = eigenvalue_residuals(pairs, lam, lam[:, None], sigma)
    np.testing.assert_allclose(found.values, 0.21 / (2.0 * sigma))
    np.testing.assert_allclose(found.gradient[:, 0], 1.21 / (2.0 * sigma))
    rng = np.random.default_rng(0)
    a, t, slope = rng.standard_normal((6, 2)), rng.standard_normal((6, 2)), np.ones((6, 2, 1))
    each = shape_residuals(a, slope, t, sigma)
    for k in range(2):
        one = shape_residuals(a[:, [k]], slope[:, [k]], t[:, [k]], float(sigma[k]))
        np.testing.assert_allclose(each.values[6 * k : 6 * k + 6], one.values)
        np.testing.assert_allclose(each.gradient[6 * k : 6 * k + 6], one.gradient)


def test_an_uncertain_frequency_hardly_moves_the_parameters():
    """One wrong frequency of six; its standard error tells how wrong it may be."""
    model, truth = chain(HALVES), [1.3, 0.8]
    target = target_of(model, truth)
    wrong = np.array(target.frequencies_hz)
    wrong[0] *= 1.08
    stage = Stage((0, 1), "frequencies", 15)
    off = {}
    for name, std in (("unknown", None), ("known", [0.5, *[1e-5] * 5])):
        t = replace(
            target, frequencies_hz=wrong, frequency_std=None if std is None else np.array(std)
        )
        done = update(model, t, [stage], weights=Weights({"frequency_sigma": 1e-3}), n_modes=8)
        off[name] = np.abs(done.factors / truth - 1.0).max()
    assert off["known"] < 1e-3
    assert off["unknown"] > 10.0 * off["known"]


def test_errors_of_a_test_come_to_the_sensors_on_the_model(analysis):
    geometry, modes = analysis
    test = measured(analysis)
    assert place_test(geometry, modes, test, "m").errors is None
    std = np.full(test.modes.shapes.shape, 1e-4) * np.abs(test.modes.shapes).max()
    f_std = 1e-3 * test.modes.frequencies_hz
    placed = place_test(geometry, modes, replace(test, frequency_std=f_std, shape_std=std), "m")
    np.testing.assert_allclose(placed.errors.frequency, 1e-3)
    assert placed.errors.shape.shape == placed.test.shapes.shape
    assert any("weigh by their standard errors" in w for w in placed.warnings)


def test_a_sensor_that_reads_noise_spoils_no_mac_when_its_error_says_so(analysis):
    geometry, modes = analysis
    test = measured(analysis)
    shapes = np.array(test.modes.shapes)
    rms = np.sqrt(np.mean(shapes**2, axis=0))
    shapes[4] += 3.0 * rms
    spoilt = replace(test, modes=replace(test.modes, shapes=shapes))
    std = np.full(shapes.shape, 1e-3) * rms
    std[4] = 3.0 * rms
    weighed = replace(spoilt, frequency_std=np.full(5, 1e-3), shape_std=std)
    mac = {}
    for name, m in (("as it is", spoilt), ("weighed", weighed)):
        placed = place_test(geometry, modes, m, "m")
        assert sp.issparse(placed.weighted(placed.observation.matrix))
        mac[name] = compare(geometry, modes, placed).correlation.mac.diagonal().min()
    assert mac["as it is"] < 0.9
    assert mac["weighed"] > 0.99


def test_scatter_that_the_user_states_adds_to_the_errors_of_identification():
    alone = with_scatter(None, 3, 2, 0.01, 0.05)
    np.testing.assert_allclose(alone.frequency, [0.01, 0.01])
    np.testing.assert_allclose(alone.sensors, 1.0)
    identified = ModeErrors(np.array([0.0, 0.03]), np.zeros((3, 2)))
    np.testing.assert_allclose(with_scatter(identified, 3, 2, 0.04, 0.0).frequency, [0.04, 0.05])


def test_scatter_below_zero_is_refused():
    with pytest.raises(InputError, match="zero or more"):
        with_scatter(None, 3, 2, -0.1, 0.0)
