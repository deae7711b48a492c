"""Which elements of a frame are one bar."""

import numpy as np

from trueup.core.discovery.kinds.patches import _chains


def test_elements_between_two_joints_are_one_bar():
    xyz = np.array([[0.0, 0, 0], [1, 0, 0], [2, 0, 0], [2, 1, 0], [2, 2, 0]])
    ends = np.array([[0, 1], [1, 2], [2, 3], [3, 4]])
    through = np.array([False, True, False, True, False])
    assert [c.tolist() for c in _chains(ends, through, xyz)] == [[0, 1], [2, 3]]


def test_a_corner_ends_a_bar():
    xyz = np.array([[0.0, 0, 0], [1, 0, 0], [1, 1, 0]])
    ends = np.array([[0, 1], [1, 2]])
    assert len(_chains(ends, np.array([False, True, False]), xyz)) == 2
