"""Axes that turn with a structure, whatever order its grids have."""

import numpy as np
import pytest

from trueup.core.discovery.reduction.own_axes import own_axes

RNG = np.random.default_rng(4)
LOPSIDED = RNG.random((60, 3)) ** 3 * [9.0, 5.0, 2.0]
TURN = np.linalg.qr(RNG.standard_normal((3, 3)))[0]
ANGLES = np.arange(24) * np.pi / 12.0
RING = np.column_stack([3.0 * np.cos(ANGLES), np.zeros(24), 3.0 * np.sin(ANGLES)])
DUCT = np.concatenate([RING + np.array([0.0, y, 0.0]) for y in np.arange(0.0, 20.0, 2.0)])


def test_they_turn_with_the_points_and_do_not_hang_on_their_order():
    moved = (LOPSIDED @ TURN.T + [7.0, -3.0, 1.0])[RNG.permutation(60)]
    np.testing.assert_allclose(own_axes(moved), own_axes(LOPSIDED) @ TURN.T, atol=1e-9)


def test_the_longest_is_first_and_points_to_where_the_points_reach_further():
    axes, away = own_axes(LOPSIDED), LOPSIDED - LOPSIDED.mean(axis=0)
    np.testing.assert_allclose(axes @ axes.T, np.eye(3), atol=1e-12)
    assert np.all(np.diff(np.std(away @ axes.T, axis=0)) < 0.0)
    assert np.all(np.sum((away @ axes.T) ** 3, axis=0) > 0.0)


@pytest.mark.parametrize("noise", [0.0, 1e-9])
def test_round_ones_have_basic_axes_across(noise):
    axes = own_axes(DUCT + noise * RNG.standard_normal(DUCT.shape))
    np.testing.assert_allclose(axes, np.eye(3)[[1, 0, 2]], atol=1e-6)
