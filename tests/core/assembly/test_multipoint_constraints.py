"""Elimination of dependent degrees of freedom, and finding those without stiffness."""

import numpy as np
import pytest
import scipy.sparse as sp
from hypothesis import given, strategies as st

from trueup.core.assembly.multipoint_constraints import Equations, reduction, unsupported
from trueup.core.errors import InputError, Place


def equations(n, rows):
    """Make equations from {dependent: {dof: coefficient}}."""
    matrix = sp.lil_matrix((len(rows), n))
    for k, terms in enumerate(rows.values()):
        for dof, value in terms.items():
            matrix[k, dof] = value
    owners = tuple(Place(card=f"MPC {k + 1}") for k in range(len(rows)))
    return Equations(np.array(list(rows), dtype=np.int64), matrix.tocsr(), owners)


def reduce(n, rows, fixed=()):
    mask = np.zeros(n, dtype=bool)
    mask[list(fixed)] = True
    return reduction(n, equations(n, rows), mask, lambda d: f"{d}:1")


@given(st.integers(0, 2**32 - 1))
def test_every_equation_holds_on_the_expansion(seed):
    rng = np.random.default_rng(seed)
    n = 12
    order = rng.permutation(n)
    dependent = order[:5]
    rows = {
        int(d): {int(j): float(rng.normal()) for j in rng.choice(order[k + 1 :], 3, replace=False)}
        for k, d in enumerate(dependent)
    }
    fixed = [int(order[-1])]
    found = reduce(n, rows, fixed)
    q = rng.normal(size=found.expansion.shape[1])
    u = found.expansion @ q
    for d, terms in rows.items():
        np.testing.assert_allclose(u[d], sum(a * u[j] for j, a in terms.items()), atol=1e-12)
    np.testing.assert_array_equal(u[fixed], 0.0)
    np.testing.assert_array_equal(u[found.kept], q)


def test_energy_is_that_of_the_expanded_displacements():
    rng = np.random.default_rng(1)
    n = 9
    A = rng.normal(size=(n, n))
    K = sp.csr_matrix(A @ A.T)
    found = reduce(n, {0: {3: 2.0, 4: -1.0}, 7: {0: 0.5}}, fixed=[8])
    E = found.expansion.toarray()
    np.testing.assert_allclose(found.apply([K])[0].toarray(), E.T @ K.toarray() @ E, atol=1e-12)
    less = found.drop(np.array([1]))
    np.testing.assert_allclose(less.expansion.toarray(), np.delete(E, 1, axis=1))


def test_equations_in_a_circle_are_solved_where_they_can_be():
    found = reduce(3, {0: {1: 0.5, 2: 1.0}, 1: {0: 0.5}})
    np.testing.assert_allclose(found.expansion.toarray()[:, 0], [4.0 / 3.0, 2.0 / 3.0, 1.0])


@pytest.mark.parametrize(
    ("rows", "fixed", "message"),
    [
        ({0: {1: 1.0}, 1: {0: 1.0}}, (), "MPC 1, MPC 2 depend on each other in a circle"),
        ({0: {1: 1.0}}, (0,), r"0:1 .* is dependent in MPC 1 and constrained by an SPC"),
    ],
)
def test_what_is_not_determined_is_named(rows, fixed, message):
    with pytest.raises(InputError, match=message):
        reduce(3, rows, fixed)


def test_two_equations_for_one_degree_of_freedom_are_named():
    owners = (Place(card="RBE2 1"), Place(card="RBE2 2"))
    twice = Equations(np.array([0, 0]), sp.csr_matrix(np.eye(3)[[1, 2]]), owners)
    with pytest.raises(InputError, match=r"0:1 .* made dependent by RBE2 1 and RBE2 2"):
        reduction(3, twice, np.zeros(3, bool), lambda d: f"{d}:1")


class TestUnsupported:
    def test_along_an_axis(self):
        K = sp.diags([2.0, 0.0, 3.0]).tocsr()
        assert unsupported(K, np.zeros(3, int), np.arange(3), None, 1e-8).tolist() == [1]

    def test_along_a_skew_direction_the_strongest_component_goes(self):
        v = np.array([0.6, 0.8, 0.0])
        K = sp.csr_matrix(np.eye(3) - np.outer(v, v))
        assert unsupported(K, np.zeros(3, int), np.arange(3), None, 1e-8).tolist() == [1]

    @pytest.mark.parametrize(("weak", "goes"), [(1e-10, False), (1e-15, True)])
    def test_a_weak_rotation_about_a_skew_direction_stays(self, weak, goes):
        v = np.array([0.6, 0.8, 0.0])
        K = sp.csr_matrix(np.eye(3) - (1.0 - weak) * np.outer(v, v))
        turning = np.ones(3, bool)
        found = unsupported(K, np.ones(3, int), np.arange(3), None, 1e-8, turning)
        assert found.tolist() == ([1] if goes else [])
        assert unsupported(K, np.zeros(3, int), np.arange(3), None, 1e-8, ~turning).tolist() == [1]

    def test_a_line_of_stiffness_leaves_one_component(self):
        v = np.array([1.0, 2.0, 2.0]) / 3.0
        K = sp.csr_matrix(np.outer(v, v))
        gone = unsupported(K, np.zeros(3, int), np.arange(3), None, 1e-8)
        left = np.setdiff1d(np.arange(3), gone)
        assert len(left) == 1
        assert K[left[0], left[0]] > 0.0

    def test_with_a_mass_given_only_massless_directions_go(self):
        K, M = sp.diags([2.0, 0.0, 0.0]).tocsr(), sp.diags([1.0, 1.0, 0.0]).tocsr()
        assert unsupported(K, np.zeros(3, int), np.arange(3), M, 1e-8).tolist() == [2]

    def test_scalar_points_stand_alone(self):
        K = sp.diags([0.0, 1e-12, 5.0]).tocsr()
        assert unsupported(K, np.full(3, -1), np.zeros(3, int), None, 1e-8).tolist() == [0]
