"""The noise of measured shapes is found beside model errors and faulty sensors."""

import numpy as np
import pytest

from trueup.core.errors import InputError
from trueup.core.localisation.shape_noise import estimate_noise, given_noise

N, MODES = 45, 40
RNG = np.random.default_rng(12)
X = np.sort(RNG.uniform(0, 1, N))


def waves():
    """Shapes at the sensors: two rigid-body motions, then waves of growing number."""
    rigid = np.stack([np.ones(N), X - 0.5], axis=1)
    elastic = [np.cos(np.pi * k * X + 0.3 * k) for k in range(1, MODES - 1)]
    hz = np.array([0, 0, *(20.0 * np.arange(1, MODES - 1) ** 1.3)])
    return hz, np.column_stack([rigid, *elastic])


def measured(noise, mixing=0.0, modes=12, seed=0):
    """Test shapes: analysis shapes with neighbours mixed in, and noise by the rms reading."""
    rng = np.random.default_rng(seed)
    hz, shapes = waves()
    pick = np.arange(2, 2 + modes)
    blend = np.eye(MODES)[:, pick]
    for j, k in enumerate(pick):
        near = np.clip(k + np.array([-3, -2, -1, 1, 2, 3]), 0, MODES - 1)
        np.add.at(blend[:, j], near, mixing * rng.normal(size=6))
    test = shapes @ blend
    test += noise * np.sqrt((test**2).mean(axis=0)) * rng.normal(size=test.shape)
    return hz, shapes, hz[pick] * 0.98, test


@pytest.mark.parametrize("noise", [0.005, 0.02, 0.08])
@pytest.mark.parametrize("mixing", [0.0, 0.2], ids=["true model", "wrong model"])
def test_noise_is_found_within_a_fifth_whatever_the_model_error(noise, mixing):
    found = estimate_noise(*measured(noise, mixing), rigid_body_modes=2)
    rms = np.sqrt((measured(noise, mixing)[3] ** 2).mean(axis=0))
    assert np.median(found.sigma / rms) == pytest.approx(noise, rel=0.2)
    assert found.relative == pytest.approx(noise, rel=0.3)
    assert not found.outlier.any()
    np.testing.assert_allclose(found.gain, 1.0, atol=6 * noise)


def test_noise_of_many_draws_is_right_on_average():
    sizes = [
        np.sqrt(np.mean((found.sigma / np.sqrt((t[3] ** 2).mean(axis=0))) ** 2))
        for t in (measured(0.02, 0.1, seed=k) for k in range(20))
        for found in [estimate_noise(*t, rigid_body_modes=2)]
    ]
    assert np.mean(sizes) == pytest.approx(0.02, rel=0.05)


def test_faulty_sensors_are_named_and_do_not_count():
    hz, shapes, test_hz, test = measured(0.02, 0.1)
    test = test.copy()
    test[7] *= -1.0
    test[19] *= 2.0
    test[[30, 35]] = test[[35, 30]]
    found = estimate_noise(hz, shapes, test_hz, test, rigid_body_modes=2)
    assert list(np.flatnonzero(found.outlier)) == [7, 19, 30, 35]
    assert found.gain[7] == pytest.approx(-1.0, abs=0.1)
    assert found.gain[19] == pytest.approx(2.0, abs=0.1)
    assert found.relative == pytest.approx(0.02, rel=0.35)


def test_scale_of_the_shapes_does_not_matter():
    hz, shapes, test_hz, test = measured(0.02, 0.1)
    scale = 10.0 ** np.arange(-6, 6)
    a = estimate_noise(hz, shapes, test_hz, test, 2)
    b = estimate_noise(hz, shapes * 1e3, test_hz, test * scale, 2)
    np.testing.assert_allclose(b.sigma, a.sigma * scale, rtol=1e-6)
    assert b.relative == pytest.approx(a.relative)


def test_prediction_of_a_sensor_does_not_use_its_own_reading():
    hz, shapes, test_hz, test = measured(0.02)
    spoilt = test.copy()
    spoilt[11] += 0.1  # too little to be an outlier
    a = estimate_noise(hz, shapes, test_hz, test, 2)
    b = estimate_noise(hz, shapes, test_hz, spoilt, 2)
    rms = np.sqrt((test**2).mean(axis=0)) / np.sqrt((spoilt**2).mean(axis=0))
    np.testing.assert_allclose(b.explained[11], a.explained[11], atol=1e-9)
    assert rms.min() < 1.01


def test_a_mode_without_a_frequency_is_fitted_by_the_lowest_shapes():
    """A blank field reads as 0 Hz; nothing divides by it, the other modes stay as they were."""
    hz, shapes, test_hz, test = measured(0.02)
    plain = estimate_noise(hz, shapes, test_hz, test, rigid_body_modes=2)
    still = estimate_noise(hz, shapes, [0.0, *test_hz[1:]], test, rigid_body_modes=2)
    np.testing.assert_allclose(still.sigma[1:], plain.sigma[1:])
    assert still.sigma[0] == pytest.approx(plain.sigma[0], rel=0.5)


def test_given_noise():
    test = measured(0.02)[3]
    noise = given_noise(test, 0.03)
    np.testing.assert_allclose(noise.sigma, 0.03 * np.sqrt((test**2).mean(axis=0)))
    assert not noise.outlier.any()
    with pytest.raises(InputError, match="share above 0"):
        given_noise(test, 0.0)


def test_too_few_sensors_are_refused():
    hz, shapes, test_hz, test = measured(0.02)
    with pytest.raises(InputError, match="cannot be estimated from 5 sensors"):
        estimate_noise(hz, shapes[:5], test_hz, test[:5])
