"""The root of a patch's matrix."""

import numpy as np

from trueup.core.discovery.effects.element_patches import root_of


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
