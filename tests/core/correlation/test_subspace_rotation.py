import numpy as np
import pytest

from trueup.core.correlation.mac import mac
from trueup.core.correlation.subspace_rotation import combinations, rotate_cluster, subspace_mac

ANGLE = np.linspace(0.0, 2.0 * np.pi, 24, endpoint=False)


def harmonics(n, count=2):
    return np.column_stack([np.cos(n * ANGLE), np.sin(n * ANGLE)])[:, :count] / np.sqrt(12.0)


def turned(angle):
    c, s = np.cos(angle), np.sin(angle)
    return np.array([[c, -s], [s, c]])


def test_a_ring_pair_turned_by_any_angle_is_turned_back():
    pair = harmonics(3)
    test = pair @ turned(0.6) * np.array([2.0, -5.0])
    found = rotate_cluster(pair, test, (0, 1))
    np.testing.assert_allclose(np.diag(mac(pair @ found.matrix, test)), 1.0)


def test_the_transformation_keeps_mass_orthonormality():
    rng = np.random.default_rng(0)
    pair = harmonics(2)
    test = pair @ rng.normal(size=(2, 2)) + 0.05 * rng.normal(size=(24, 2))
    matrix = rotate_cluster(pair, test, (0, 1)).matrix
    np.testing.assert_allclose(matrix.T @ matrix, np.eye(2), atol=1e-12)


def test_one_measured_mode_of_a_pair_is_enough():
    pair = harmonics(4)
    test = (pair @ turned(1.1))[:, :1]
    found = rotate_cluster(pair, test, (0,))
    assert mac(pair @ found.matrix, test)[0, 0] == pytest.approx(1.0)
    np.testing.assert_allclose(found.matrix.T @ found.matrix, np.eye(2), atol=1e-12)


def test_a_cluster_of_three_is_turned_at_once():
    rng = np.random.default_rng(1)
    cluster = np.linalg.qr(rng.normal(size=(30, 3)))[0]
    orthogonal = np.linalg.qr(rng.normal(size=(3, 3)))[0]
    test = cluster @ orthogonal
    found = rotate_cluster(cluster, test, (0, 1, 2))
    np.testing.assert_allclose(np.diag(mac(cluster @ found.matrix, test)), 1.0)


def test_two_measurements_of_the_same_shape_do_not_share_a_pair():
    pair = harmonics(3)
    same = (pair @ turned(0.4))[:, [0, 0]]
    same = same + 0.02 * np.random.default_rng(2).normal(size=same.shape)
    found = rotate_cluster(pair, same, (0, 1), mac_min=0.7)
    assert len(found.test) == 1
    assert mac(pair @ found.matrix, same)[0, found.test[0]] > 0.95


def test_the_subspace_mac_is_what_the_best_combination_reaches():
    rng = np.random.default_rng(3)
    cluster, test = rng.normal(size=(20, 3)), rng.normal(size=(20, 4))
    best = cluster @ combinations(cluster, test)
    np.testing.assert_allclose(subspace_mac(cluster, test), np.diag(mac(best, test)))
