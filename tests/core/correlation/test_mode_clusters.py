import numpy as np
from hypothesis import given, strategies as st

from trueup.core.correlation.subspace_rotation import clusters_by_bandwidth


def test_a_pair_is_a_cluster_and_a_lone_mode_is_not():
    assert clusters_by_bandwidth(np.array([10.0, 20.0, 20.1]), 0.01) == ((0,), (1, 2))


def test_closest_neighbours_are_joined_first():
    found = clusters_by_bandwidth(np.array([100.0, 101.9, 102.0, 103.9]), 0.02)
    assert (1, 2) in [g[-2:] for g in found] or (1, 2) in [g[:2] for g in found]


def test_a_chain_is_not_swallowed_whole():
    f = 100.0 * 1.01 ** np.arange(20)
    assert max(len(g) for g in clusters_by_bandwidth(f, 0.02)) <= 3


def test_rigid_body_modes_are_left_out():
    assert clusters_by_bandwidth(np.array([0.0, 0.0, 5.0]), 0.1) == ((2,),)


def test_no_width_joins_nothing():
    assert clusters_by_bandwidth(np.array([5.0, 5.0]), 0.0) == ((0,), (1,))


@given(st.lists(st.floats(1, 1000), min_size=1, max_size=30), st.floats(0.0, 0.3))
def test_every_mode_is_in_one_group_and_no_group_is_wider_than_asked(values, width):
    f = np.array(values)
    groups = clusters_by_bandwidth(f, width)
    assert sorted(i for g in groups for i in g) == list(range(len(f)))
    for g in groups:
        assert f[list(g)].max() - f[list(g)].min() <= width * f[list(g)].max() + 1e-9
