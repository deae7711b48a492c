import numpy as np

from trueup.core.correlation.mode_pairing import assign


def test_the_assignment_is_best_in_sum_not_greedy():
    score = np.array([[0.95, 0.94], [0.94, 0.10]])
    assert assign(score, np.ones((2, 2), bool)) == ((0, 1), (1, 0))


def test_a_forbidden_pair_is_never_formed():
    score = np.array([[0.9, 0.8]])
    assert assign(score, np.array([[False, True]])) == ((0, 1),)
    assert assign(score, np.array([[False, False]])) == ()


def test_nothing_to_assign():
    assert assign(np.zeros((0, 3)), np.zeros((0, 3), bool)) == ()
