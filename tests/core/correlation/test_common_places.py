"""Grids of two models that are in one place."""

import numpy as np

from trueup.core.correlation.common_places import common_places
from trueup.core.data.geometry import Geometry


def test_of_grids_in_one_place_the_one_of_the_same_number_is_taken():
    xyz = np.repeat(np.arange(6.0), 2)[:, None] * [1.0, 0.0, 0.0]  # two sides of six joints
    one = Geometry(np.arange(1, 13), xyz)
    other = Geometry(np.arange(12, 0, -1), xyz[::-1])
    a, b = common_places(one, other)
    np.testing.assert_array_equal(one.ids[a], other.ids[b])
    assert len(a) == 12
