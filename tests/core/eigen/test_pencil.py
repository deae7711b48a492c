"""Matrices as they come: what is rounding and what is wrong."""

from __future__ import annotations

import numpy as np
import pytest
import scipy.sparse as sp

from trueup.core.eigen.pencil import Pencil
from trueup.core.errors import InputError


def chain(mass):
    n = len(mass)
    K = sp.diags([np.full(n, 3.0), np.full(n - 1, -1.0), np.full(n - 1, -1.0)], [0, 1, -1])
    return sp.csr_matrix(K), sp.lil_matrix(np.diag(mass))


@pytest.mark.parametrize("noise", [-1e-17, 0.0, 1e-17])
def test_what_a_rotation_leaves_of_no_mass_is_no_mass(noise):
    K, M = chain([1.0, 2.0, noise, 1.0])
    M[2, 3] = M[3, 2] = 1e-16
    cleaned = Pencil(K, M).M
    np.testing.assert_array_equal(cleaned.toarray(), np.diag([1.0, 2.0, 0.0, 1.0]))


@pytest.mark.parametrize("noise", [-3e-18, 7e-18])
def test_massless_directions_mixed_with_each_other_are_massless(noise):
    """As the rotations of a lumped bar's grid in an oblique frame: one of three has mass."""
    K, M = chain([1.0, noise, 7e-18])
    M[0, 1] = M[1, 0] = -3e-16
    M[0, 2] = M[2, 0] = 1e-17
    M[1, 2] = M[2, 1] = -2.7e-18
    grid = Pencil(K, M, ("7:4", "7:5", "7:6"))
    np.testing.assert_array_equal(grid.M.toarray(), np.diag([1.0, 0.0, 0.0]))


def test_light_nodes_beside_a_heavy_one_have_mass():
    K, M = chain([1e9, 1e-6, 1e-6])
    M[0, 1] = M[1, 0] = M[1, 2] = M[2, 1] = 2e-7
    kept = Pencil(K, M, ("1:3", "2:3", "3:3")).M
    np.testing.assert_array_equal(kept.toarray(), M.toarray())


def test_a_small_mass_is_a_mass():
    K, M = chain([1.0, 2.0, 1e-6, 1.0])
    np.testing.assert_array_equal(Pencil(K, M).M.toarray(), M.toarray())


def test_a_negative_mass_is_refused():
    K, M = chain([1.0, 2.0, -1e-6, 1.0])
    with pytest.raises(InputError, match="mass at degree of freedom 3 is negative"):
        Pencil(K, M)
