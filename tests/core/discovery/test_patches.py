"""Which elements of a frame are one bar, and the root of a patch's matrix."""

import numpy as np

from trueup.core.discovery.kinds.patches import _chains, root_of


def test_elements_between_two_joints_are_one_bar():
    xyz = np.array([[0.0, 0, 0], [1, 0, 0], [2, 0, 0], [2, 1, 0], [2, 2, 0]])
    ends = np.array([[0, 1], [1, 2], [2, 3], [3, 4]])
    through = np.array([False, True, False, True, False])
    assert [c.tolist() for c in _chains(ends, through, xyz)] == [[0, 1], [2, 3]]


def test_a_corner_ends_a_bar():
    xyz = np.array([[0.0, 0, 0], [1, 0, 0], [1, 1, 0]])
    ends = np.array([[0, 1], [1, 2]])
    assert len(_chains(ends, np.array([False, True, False]), xyz)) == 2


def test_a_root_leaves_next_to_nothing_of_a_patch():
    spread = np.geomspace(1.0, 1e-9, 40)
    Q, _ = np.linalg.qr(np.random.default_rng(2).normal(size=(40, 40)))
    A = (Q * spread) @ Q.T
    U = root_of(A)
    left = np.linalg.eigvalsh(A - U.T @ U)
    assert len(U) < 30
    assert np.trace(A - U.T @ U) < 40 * 1e-5 * np.trace(A)
    assert left[0] > -1e-12


def test_a_root_of_a_few_elements_is_exact():
    W = np.random.default_rng(3).normal(size=(5, 40))
    U = root_of(W.T @ W)
    assert U.shape == (5, 40)
    np.testing.assert_allclose(U.T @ U, W.T @ W, atol=1e-10)
