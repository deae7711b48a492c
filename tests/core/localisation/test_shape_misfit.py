"""Maps of disagreement: 1 is noise alone, and they point to where something is."""

import numpy as np
import pytest

from trueup.core.correlation.criteria import Criteria
from trueup.core.correlation.mac import mac
from trueup.core.correlation.mode_pairing import correlate
from trueup.core.errors import InputError
from trueup.core.localisation.shape_misfit import misfit, paired_shapes, spread
from trueup.core.localisation.shape_noise import given_noise

N, M = 60, 8
RNG = np.random.default_rng(5)
HZ = np.array([20.0, 33, 51, 70.0, 70.3, 95, 120, 150])


def analysis():
    return np.linalg.qr(np.random.default_rng(1).normal(size=(N, M)))[0] * 3.0


def measured(noise=0.0, seed=2, scale=None):
    """Analysis shapes with the close pair turned by 35 degrees, scaled and with noise."""
    shapes = analysis().copy()
    c, s = np.cos(0.61), np.sin(0.61)
    shapes[:, 3:5] = shapes[:, 3:5] @ np.array([[c, -s], [s, c]])
    scale = np.array([1, -2, 0.5, 3, 1, -1, 10, 0.1]) if scale is None else scale
    shapes *= scale
    rms = np.sqrt((shapes**2).mean(axis=0))
    return shapes + noise * rms * np.random.default_rng(seed).normal(size=shapes.shape)


@pytest.mark.parametrize("side", ["analysis", "test"])
def test_paired_shapes_are_turned_and_scaled_onto_each_other(side):
    test = measured()
    found = correlate(HZ, analysis(), HZ, test, Criteria(rotate=side))
    pairs = paired_shapes(found, analysis(), test)
    assert pairs.analysis.shape == pairs.test.shape == (N, M)
    np.testing.assert_allclose(pairs.analysis, pairs.test, atol=1e-9)
    np.testing.assert_allclose(test @ pairs.mixing, pairs.test, atol=1e-12)


def test_without_rotation_the_close_pair_stays_apart():
    test = measured()
    found = correlate(HZ, analysis(), HZ, test, Criteria(rotate="none", mac_min=0.5))
    pairs = paired_shapes(found, analysis(), test)
    left = np.linalg.norm(pairs.test - pairs.analysis, axis=0) / np.linalg.norm(pairs.test, axis=0)
    np.testing.assert_allclose(
        left**2, [1 - p.mac for p in found.pairs], atol=1e-9
    )  # what the modal scale factor leaves is 1 - MAC
    assert left.max() > 0.5


@pytest.mark.parametrize("side", ["analysis", "test", "none"])
def test_noise_alone_gives_one_everywhere_on_average(side):
    chi, modes, sensors = [], [], []
    for seed in range(300):
        test = measured(0.02, seed)
        if side == "none":
            test[:, 3:5] = measured(0.02, seed, np.ones(M))[:, 3:5]
        found = correlate(HZ, analysis(), HZ, test, Criteria(rotate=side, mac_min=0.5))
        noise = given_noise(measured(), 0.02)
        got = misfit(found, paired_shapes(found, analysis(), test), noise)
        keep = [k for k, p in enumerate(found.pairs) if side != "none" or p.test not in (3, 4)]
        chi.append(np.sum(got.normalised[:, keep] ** 2))
        modes.append(got.by_mode[keep])
        sensors.append(got.by_sensor)
    # A turned pair fits one more number than the scales counted: an angle.
    kept = len(keep)
    assert np.mean(chi) == pytest.approx((N - 1) * kept, rel=0.012)
    np.testing.assert_allclose(np.mean(modes, axis=0), 1.0, atol=0.03)
    if side != "none":
        np.testing.assert_allclose(np.mean(sensors, axis=0), 1.0, atol=0.1)


def test_maps_point_at_the_sensor_and_at_the_mode_that_differ():
    test = measured(0.02)
    test[17] += 0.6 * np.sqrt((test**2).mean(axis=0)) * (-1.0) ** np.arange(M)
    test[:, 6] += 0.2 * np.sqrt((test[:, 6] ** 2).mean()) * np.sin(np.arange(N))
    found = correlate(HZ, analysis(), HZ, test)
    got = misfit(found, paired_shapes(found, analysis(), test), given_noise(test, 0.02))
    assert np.argmax(got.by_sensor) == 17
    assert np.argmin(got.comac) == 17
    assert np.argmax(got.by_mode) == [p.test for p in found.pairs].index(6)
    assert np.mean(got.by_mode**2) > 3.0


def test_outliers_of_the_noise_do_not_count_for_the_modes():
    from dataclasses import replace

    test = measured(0.02)
    test[17] *= -1.0
    found = correlate(HZ, analysis(), HZ, test)
    shapes = paired_shapes(found, analysis(), test)
    noise = given_noise(test, 0.02)
    flagged = replace(noise, outlier=np.arange(N) == 17)
    assert misfit(found, shapes, noise).by_mode.max() > 3.0
    got = misfit(found, shapes, flagged)
    rest = np.delete(got.normalised, 17, axis=0)
    np.testing.assert_allclose(got.by_mode, np.sqrt(np.sum(rest**2, axis=0) / (N - 2)))
    assert got.by_sensor[17] > 5.0
    assert got.by_mode.max() < misfit(found, shapes, noise).by_mode.max()


def test_frequencies_in_standard_deviations():
    found = correlate(HZ * 1.01, analysis(), HZ, measured())
    shapes = paired_shapes(found, analysis(), measured())
    noise = given_noise(measured(), 0.02)
    got = misfit(found, shapes, noise, frequency_sigma=0.005)
    np.testing.assert_allclose(got.frequency, 2.0, rtol=1e-9)
    sigmas = np.full(M, 0.02)
    np.testing.assert_allclose(misfit(found, shapes, noise, sigmas).frequency, 0.5, rtol=1e-9)


def test_complex_shapes_enter_by_their_real_part():
    test = measured() * np.exp(0.4j)
    found = correlate(HZ, analysis(), HZ, test)
    pairs = paired_shapes(found, analysis(), test)
    assert not np.iscomplexobj(pairs.test)
    np.testing.assert_allclose(pairs.analysis, pairs.test, atol=1e-9)


def test_no_pairs_is_refused():
    noise = RNG.normal(size=(N, M))
    found = correlate(HZ, analysis(), HZ, noise)
    assert not found.pairs
    with pytest.raises(InputError, match="no pair of modes"):
        misfit(found, paired_shapes(found, analysis(), noise), given_noise(noise, 0.02))


def test_constant_maps_stay_constant_also_far_away():
    sensors = RNG.uniform(0, 1, (30, 3))
    grids = RNG.uniform(-5, 6, (200, 3))
    np.testing.assert_allclose(spread(np.full(30, 2.5), sensors, grids), 2.5)


def test_a_grid_near_a_lone_sensor_takes_its_value_and_one_between_two_their_mean():
    sensors = np.array([[0.0, 0, 0], [1.0, 0, 0], [2.0, 0, 0], [3.0, 0, 0], [400.0, 0, 0]])
    values = np.array([1.0, 2.0, 3.0, 4.0, 9.0])
    drawn = spread(values, sensors, np.array([[400.0, 0.5, 0], [1.5, 0, 0]]))
    np.testing.assert_allclose(drawn, [9.0, 2.5], atol=1e-6)


def test_the_map_peaks_where_the_sensors_peak():
    sensors = np.stack([*np.meshgrid(np.arange(10.0), np.arange(10.0)), np.zeros((10, 10))], -1)
    sensors = sensors.reshape(-1, 3)
    values = np.exp(-0.5 * ((sensors - [6.3, 2.2, 0]) ** 2).sum(axis=1))
    grids = RNG.uniform(0, 9, (4000, 3)) * [1, 1, 0]
    drawn = spread(values, sensors, grids)
    np.testing.assert_allclose(grids[np.argmax(drawn)], [6.3, 2.2, 0], atol=0.6)


def test_silent_sensors_say_nothing():
    sensors = RNG.uniform(0, 1, (30, 3))
    values = np.full(30, 2.5)
    values[3] = np.nan
    np.testing.assert_allclose(spread(values, sensors, sensors), 2.5)
    assert np.isnan(spread(np.full(30, np.nan), sensors, sensors)).all()


def test_a_map_needs_sensors():
    with pytest.raises(InputError):
        spread(np.zeros(0), np.zeros((0, 3)), np.zeros((2, 3)))


def test_residual_is_one_minus_mac():
    test = measured(0.05)
    found = correlate(HZ, analysis(), HZ, test)
    pairs = paired_shapes(found, analysis(), test)
    left = np.sum((pairs.test - pairs.analysis) ** 2, axis=0) / np.sum(pairs.test**2, axis=0)
    np.testing.assert_allclose(left, 1 - np.diag(mac(pairs.test, pairs.analysis)), atol=1e-12)
