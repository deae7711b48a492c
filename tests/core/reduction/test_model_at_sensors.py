import numpy as np
import pytest
import scipy.linalg as sl
import scipy.sparse as sp
from tests.core.chains import chain, chain_exact

from trueup.core.errors import InputError
from trueup.core.reduction.model_at_sensors import METHODS, reduce_to_sensors

N = 30
KEPT = np.array([0, 7, 11, 20, 29])


def modes_of(K, M):
    return sl.eigh(K.toarray(), M.toarray())


def at(rows, n=N):
    return sp.identity(n, format="csr")[rows]


@pytest.fixture
def free():
    K, M = chain(N, k=3.0)
    return K, M, modes_of(K, M)[1]


def test_guyan_is_straight_between_the_sensors(free):
    K, M, X = free
    T = reduce_to_sensors("guyan", K, M, at(KEPT), X, 1).expansion
    straight = [np.interp(np.arange(N), KEPT, row) for row in np.eye(len(KEPT))]
    np.testing.assert_allclose(T, np.transpose(straight), atol=1e-12)


def test_irs_as_it_was_published(free):
    K, M, X = free
    kept = np.array([3, 7, 20, 26])
    found = reduce_to_sensors("irs", K, M, at(kept), X, 1)
    out = np.setdiff1d(np.arange(N), kept)
    K, M = K.toarray(), M.toarray()
    T = np.zeros((N, 4))
    T[kept], T[out] = np.eye(4), -np.linalg.solve(K[np.ix_(out, out)], K[np.ix_(out, kept)])
    S = np.zeros((N, N))
    S[np.ix_(out, out)] = np.linalg.inv(K[np.ix_(out, out)])
    T = T + S @ M @ T @ np.linalg.solve(T.T @ M @ T, T.T @ K @ T)
    np.testing.assert_allclose(found.expansion, T, atol=1e-10)


def test_serep_keeps_the_frequencies_of_its_modes(free):
    K, M, X = free
    found = reduce_to_sensors("serep", K, M, at(KEPT), X[:, :5], 1)
    np.testing.assert_allclose(
        sl.eigvalsh(found.stiffness, found.mass), 3.0 * chain_exact(N)[:5], atol=1e-10
    )


def test_irs_is_closer_than_guyan_and_both_are_above(free):
    K, M, X = free
    exact = 3.0 * chain_exact(N)[1:4]
    off = {}
    for method in ("guyan", "irs"):
        found = reduce_to_sensors(method, K, M, at(KEPT), X, 1)
        off[method] = sl.eigvalsh(found.stiffness, found.mass)[1:4] / exact - 1.0
        assert (off[method] > 0.0).all()
    assert (off["irs"][:2] < 0.1 * off["guyan"][:2]).all()


@pytest.mark.parametrize("method", METHODS)
def test_sensors_between_points_read_what_is_expanded(free, method):
    K, M, X = free
    between = 0.3 * at(KEPT[:4]) + 0.7 * at(KEPT[:4] + 1)
    T = reduce_to_sensors(method, K, M, between, X[:, :4], 1).expansion
    np.testing.assert_allclose(between @ T, np.eye(4), atol=1e-10)


@pytest.mark.parametrize("method", ["guyan", "irs"])
def test_what_no_sensor_sees_of_rigid_body_motion_stays_at_rest(free, method):
    K, M, X = free
    two_K, two_M = sp.block_diag([K, K], "csr"), sp.block_diag([M, M], "csr")
    rigid = sl.block_diag(X[:, :1], X[:, :1])
    T = reduce_to_sensors(method, two_K, two_M, at(KEPT, 2 * N), rigid, 2).expansion
    alone = reduce_to_sensors(method, K, M, at(KEPT), X, 1).expansion
    np.testing.assert_allclose(T[:N], alone, atol=1e-10)
    np.testing.assert_allclose(T[N:], 0.0, atol=1e-12)


def test_two_sensors_in_one_place_share_its_reading(free):
    K, M, X = free
    T = reduce_to_sensors("guyan", K, M, at([0, 7, 7, 29]), X, 1).expansion
    np.testing.assert_allclose(T[:, 1], T[:, 2], atol=1e-12)
    np.testing.assert_allclose(T[7], [0.0, 0.5, 0.5, 0.0], atol=1e-12)


def test_more_modes_than_the_sensors_tell_apart_are_refused(free):
    K, M, X = free
    with pytest.raises(InputError, match="tell 5 of 6 modes apart"):
        reduce_to_sensors("serep", K, M, at(KEPT), X[:, :6], 1)
    with pytest.raises(InputError, match="one of serep, guyan, irs"):
        reduce_to_sensors("static", K, M, at(KEPT), X, 1)
