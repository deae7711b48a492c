import numpy as np
import pytest

from trueup.core.discovery.sensors import find_faults

ANGLE = np.linspace(0.0, 2.0 * np.pi, 40, endpoint=False)
HZ = np.repeat(20.0 * np.arange(2, 9) ** 1.5, 2)


def ring():
    return np.column_stack([f(n * ANGLE) for n in range(2, 9) for f in (np.cos, np.sin)])


def measured(seed=0, noise=0.02):
    """Modes of a ring that the model does not have right: neighbours mixed, noise added."""
    rng = np.random.default_rng(seed)
    mix = np.eye(14) + 0.15 * rng.normal(size=(14, 14)) * np.exp(
        -np.abs(np.subtract.outer(np.arange(14), np.arange(14)))
    )
    shapes = ring() @ mix
    return shapes + noise * np.sqrt(np.mean(shapes**2, axis=0)) * rng.normal(size=shapes.shape)


def found(shapes):
    return find_faults(shapes, HZ, ring(), HZ)[0]


@pytest.mark.parametrize("seed", range(5))
def test_sound_sensors_are_not_accused(seed):
    assert found(measured(seed)) == ()


def test_a_sensor_wired_backwards_is_named():
    shapes = measured()
    shapes[7] *= -1.0
    (fault,) = found(shapes)
    assert (fault.kind, fault.sensors) == ("sensor_polarity", (7,))


def test_a_wrong_gain_is_named_with_its_factor():
    shapes = measured()
    shapes[11] *= 1.5
    (fault,) = found(shapes)
    assert (fault.kind, fault.sensors) == ("sensor_gain", (11,))
    assert fault.factor == pytest.approx(1.5, rel=0.1)


def test_two_swapped_sensors_are_named_together():
    shapes = measured()
    shapes[[5, 18]] = shapes[[18, 5]]
    (fault,) = found(shapes)
    assert (fault.kind, set(fault.sensors)) == ("sensor_swap", {5, 18})


def test_a_reading_counted_twice_is_not_called_a_gain():
    shapes = measured()
    shapes[3] *= 2.0
    (fault,) = found(shapes)
    assert (fault.kind, fault.sensors, fault.factor) == ("doubled", (3,), 2.0)


def test_the_noise_of_sound_sensors_is_estimated():
    _, noise = find_faults(measured(noise=0.03), HZ, ring(), HZ)
    assert 0.01 < noise < 0.06


def test_a_handful_of_sensors_cannot_judge_each_other():
    assert find_faults(measured()[:6], HZ, ring()[:6], HZ)[0] == ()
