"""Expansions of parameter-dependent features: exact spaces are found, others reach tolerance."""

import numpy as np
import pytest

from trueup.core.errors import CheckError
from trueup.core.numerics.interpolative_expansion import expand

LOW, HIGH = np.array([0.2, 0.5]), np.array([5.0, 2.0])


def _error(sample, found, k, points):
    low, high = LOW[:k], HIGH[:k]
    at = sample(found.points) if len(found.points) else np.zeros((0, sample(points).shape[1]))
    return np.abs(found.values(points, low, high) @ found.weights @ at - sample(points)).max()


def _points(k, n=50):
    return LOW[:k] + (HIGH[:k] - LOW[:k]) * np.random.default_rng(3).random((n, k))


class TestExactSpaces:
    def test_what_is_proportional_takes_one_function_and_one_point(self):
        found = expand(lambda p: p[:, :1] * [[2.0, -3.0, 0.5]], LOW[:1], HIGH[:1], 1e-9)
        assert len(found.series) == len(found.points) == 1

    def test_linear_and_cubic_parts_take_one_function_each(self):
        def sample(p):
            return np.column_stack([p[:, 0], p[:, 0] ** 3, 3.0 * p[:, 0] - p[:, 0] ** 3])

        found = expand(sample, LOW[:1], HIGH[:1], 1e-9)
        assert len(found.series) == 2
        assert _error(sample, found, 1, _points(1)) < 1e-9

    def test_a_product_stays_one_term_and_a_sum_gets_no_product(self):
        def product(p):
            return (p[:, 0] * p[:, 1])[:, None] * [[1.0, 2.0]]

        def added(p):
            return np.column_stack([p[:, 0] + 2.0, p[:, 1], p[:, 0] - p[:, 1]])

        assert len(expand(product, LOW, HIGH, 1e-9).series) == 1
        found = expand(added, LOW, HIGH, 1e-9)
        assert len(found.series) == 3  # 1, p0, p1
        assert _error(added, found, 2, _points(2)) < 1e-9

    def test_features_that_are_zero_take_nothing(self):
        found = expand(lambda p: np.zeros((len(p), 4)), LOW[:1], HIGH[:1], 1e-9)
        assert found.series == ()

    def test_constants_are_marked_as_such(self):
        found = expand(lambda p: np.ones((len(p), 4)), LOW, HIGH, 1e-9)
        assert found.series == ((None, None),)


class TestGeneralFunctions:
    @pytest.mark.parametrize("tolerance", [1e-4, 1e-7, 1e-10])
    def test_a_family_of_rationals_reaches_the_tolerance(self, tolerance):
        poles = np.linspace(0.5, 2.0, 40)

        def sample(p):
            return p[:, :1] ** 3 / (p[:, :1] ** 2 + poles)

        found = expand(sample, LOW[:1], HIGH[:1], tolerance)
        assert _error(sample, found, 1, _points(1)) < 10.0 * tolerance
        assert len(found.series) <= 10

    def test_poles_that_move_with_the_other_parameter_are_seen(self):
        def sample(p):
            return (p[:, 0] ** 3 / (p[:, 0] ** 2 + p[:, 1]))[:, None] * np.ones((1, 2))

        found = expand(sample, LOW, HIGH, 1e-8)
        assert _error(sample, found, 2, _points(2)) < 1e-6

    def test_too_steep_a_dependence_is_an_error(self):
        with pytest.raises(CheckError, match=r"too steeply between 0\.2 and 5"):
            expand(lambda p: np.sign(p - 1.0), LOW[:1], HIGH[:1], 1e-9)

    def test_two_calls_agree(self):
        def sample(p):
            return np.column_stack([np.sin(p[:, 0] * p[:, 1]), p[:, 1]])

        first, second = (expand(sample, LOW, HIGH, 1e-8) for _ in range(2))
        np.testing.assert_array_equal(first.points, second.points)
