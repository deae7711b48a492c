from dataclasses import replace

import numpy as np
import pytest
import scipy.linalg as la

from trueup.core.correlation.mode_errors import ModeErrors
from trueup.core.discovery.likelihood.hypothesis import Prior, Problem, softened
from trueup.core.discovery.likelihood.likelihood_numbers import LIKELIHOOD
from trueup.core.discovery.likelihood.mode_likelihood import (
    Evidence,
    joint_macs,
    least_sums,
    matched,
    mixing,
    mode_costs,
    noise_of,
    robust,
)

RNG = np.random.default_rng(0)
SHAPES = np.linalg.qr(RNG.normal(size=(30, 4)))[0]


def macs(eigenvalues, test, size=0.012):
    return joint_macs(np.asarray(eigenvalues), test.T @ SHAPES, SHAPES.T @ SHAPES, size)


def test_modes_far_apart_count_by_their_own_mac():
    np.testing.assert_allclose(macs([1.0, 2.0, 4.0, 9.0], SHAPES), np.eye(4), atol=1e-3)


def test_a_repeated_pair_counts_as_its_subspace():
    turned = (SHAPES[:, :2] @ [[0.6, -0.8], [0.8, 0.6]])[:, :1]
    got = macs([1.0, 1.0, 4.0, 9.0], turned)
    np.testing.assert_allclose(got[0, :2], 1.0, atol=1e-5)


def test_a_joint_mac_is_never_below_the_mac():
    A = RNG.normal(size=(30, 6))
    t = RNG.normal(size=(30, 3))
    t /= np.linalg.norm(t, axis=0)
    lam = np.sort(RNG.uniform(1.0, 1.1, 6))
    own = (t.T @ A) ** 2 / np.sum(A**2, axis=0)
    assert np.all(joint_macs(lam, t.T @ A, A.T @ A, 0.012) >= own - 1e-9)


def test_mixing_is_half_where_the_gap_is_the_size():
    assert mixing(np.array([1.0, np.exp(0.02)]), 0.02)[0, 1] == pytest.approx(0.5)


def test_a_perfect_model_costs_nothing_and_matches_in_order():
    e = Evidence(np.array([1.0, 2.0, 3.0, 4.0]), SHAPES, noise_of(None, 0.03))
    lam = (2.0 * np.pi * e.frequencies_hz) ** 2
    total, match = matched(mode_costs(e, lam, SHAPES.T @ SHAPES, SHAPES.T @ SHAPES))
    assert total == pytest.approx(0.0, abs=1e-2)
    assert match.tolist() == [0, 1, 2, 3]


def test_parts_of_the_evidence_have_unit_shapes():
    e = Evidence(np.arange(1.0, 5.0), SHAPES, noise_of(None, 0.03)).take(
        np.array([0, 2]), np.arange(20)
    )
    np.testing.assert_allclose(np.linalg.norm(e.shapes, axis=0), 1.0)


def test_a_mode_known_badly_counts_less():
    """Twice the standard deviation, a quarter of the misfit."""
    errors = ModeErrors(np.array([0.0, 0.03]), np.zeros((30, 2)))
    e = Evidence(np.array([1.0, 2.0]), SHAPES[:, :2], noise_of(errors, 0.02))
    lam = (2.0 * np.pi * e.frequencies_hz * 1.002) ** 2
    cross = SHAPES[:, :2].T @ SHAPES[:, :2]
    one, two = np.diag(mode_costs(e, lam, cross, cross))
    usual = LIKELIHOOD.frequency
    assert two / one == pytest.approx(usual**2 / (usual**2 + 0.03**2), rel=0.02)


def test_errors_of_a_shape_add_to_what_a_model_always_leaves():
    errors = ModeErrors(np.zeros(2), np.array([[0.0, 0.3], [0.0, 0.3]]))
    shape = noise_of(errors, 0.02).shape
    np.testing.assert_allclose(shape, np.hypot(noise_of(None, 0.02).shape, [0.0, 0.3]))


def test_noise_goes_with_its_modes():
    errors = ModeErrors(np.array([0.01, 0.02, 0.03]), np.zeros((30, 3)))
    e = Evidence(np.arange(1.0, 4.0), SHAPES[:, :3], noise_of(errors, 0.02))
    part = e.take(np.array([True, False, True]), np.arange(20))
    np.testing.assert_allclose(part.noise.frequency, np.asarray(e.noise.frequency)[[0, 2]])
    assert e.noise.of(np.array([1])).robust == LIKELIHOOD.robust


def test_a_pair_that_parameters_to_come_will_turn_does_not_hide_a_place():
    """Two modes 6 % apart in frequency, turned by 30 degrees: looked for, they count as a pair."""
    turned = SHAPES @ la.block_diag([[0.866, -0.5], [0.5, 0.866]], np.eye(2))
    e = Evidence(np.array([1.0, 1.06, 3.0, 4.0]), turned, noise_of(None, 0.03))
    lam = (2.0 * np.pi * e.frequencies_hz) ** 2

    def cost(evidence):
        return matched(mode_costs(evidence, lam, turned.T @ SHAPES, SHAPES.T @ SHAPES))[0]

    soft = softened(bare_problem(e)).evidence
    narrow = replace(soft, noise=replace(soft.noise, mixing=e.noise.mixing))
    assert cost(soft) < 0.75 * cost(narrow)


def bare_problem(e):
    none = np.zeros((0, 0))
    prior = Prior(np.ones(1), -np.ones(1), np.ones(1))
    return Problem(e, e, None, none, none, none, (), (), prior, 4, 4)


def test_sums_of_many_matches_are_those_of_each():
    """Where two test modes want one analysis mode as well."""
    squares = np.random.default_rng(3).integers(0, 6, (200, 4, 6)).astype(float)
    own = squares.argmin(axis=-1)
    shared = [len(set(row)) < 4 for row in own.tolist()]
    assert 0 < sum(shared) < 200
    np.testing.assert_array_equal(
        least_sums(squares, 5.0), [matched(each)[0] for each in robust(squares, 5.0)]
    )
