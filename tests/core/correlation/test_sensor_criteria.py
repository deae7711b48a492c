import numpy as np
import pytest

from trueup.core.correlation.sensor_criteria import comac, ecomac


def test_comac_by_hand():
    a = np.array([[1.0, 2.0], [1.0, 1.0], [0.0, 0.0]])
    t = np.array([[1.0, 2.0], [1.0, 2.0], [0.0, 0.0]])
    length = np.linalg.norm(t, axis=0)
    x, y = a / length, t / length
    by_hand = (abs(x[1] * y[1]).sum()) ** 2 / ((x[1] ** 2).sum() * (y[1] ** 2).sum())
    np.testing.assert_allclose(comac(a, t), [1.0, by_hand, np.nan])
    assert by_hand < 1.0
    np.testing.assert_allclose(comac(a, -t), comac(a, t))


# ------------------------------------------------------------------ spreading


def test_a_reversed_sensor_shows_in_the_enhanced_criterion_alone():
    shapes = np.random.default_rng(3).standard_normal((12, 5))
    test = 7.0 * shapes * [1.0, -1.0, 1.0, -1.0, 1.0]
    np.testing.assert_allclose(ecomac(shapes, test), 0.0, atol=1e-15)
    test[4] *= -1.0
    assert comac(7.0 * shapes, test)[4] == pytest.approx(1.0)
    assert np.argmax(ecomac(shapes, test)) == 4


def test_enhanced_criterion_by_hand():
    a, t = np.array([[3.0], [4.0]]), np.array([[2.0], [0.0]])
    scale = 3.0 / 25.0
    np.testing.assert_allclose(ecomac(a, t), [(1.0 - 3.0 * scale) / 2.0, 4.0 * scale / 2.0])


def test_without_pairs_nothing_is_known():
    assert np.isnan(ecomac(np.zeros((2, 0)), np.zeros((2, 0)))).all()
