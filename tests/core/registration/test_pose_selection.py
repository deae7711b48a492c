"""Choosing among positions of a test on a surface."""

import numpy as np

from trueup.core.data.geometry import Geometry
from trueup.core.registration.pose_selection import choose
from trueup.core.registration.poses import Poses
from trueup.core.registration.surface_registration import cloud_of
from trueup.core.sensors.outer_surface import surface_of


def test_points_that_lie_exactly_on_the_surface_are_judged_by_no_quotient_of_zeros():
    x, y = np.meshgrid(np.arange(5.0), np.arange(4.0), indexing="ij")
    k = np.arange(20).reshape(5, 4)
    quads = np.stack([k[:-1, :-1], k[1:, :-1], k[1:, 1:], k[:-1, 1:]], axis=-1).reshape(-1, 4)
    xyz = np.stack([x, y, 0.0 * x], axis=-1).reshape(-1, 3)
    surface = surface_of(Geometry(np.arange(20) + 1, xyz, None, {"quad": quads}))
    as_it_stands = Poses(np.eye(3)[None], np.zeros((1, 3)), np.zeros(1))
    found = choose(cloud_of(surface), xyz[[0, 6, 13, 19]], None, as_it_stands)
    np.testing.assert_allclose(found.candidates[0].pose.rotation[0], np.eye(3), atol=1e-6)
