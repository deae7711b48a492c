import numpy as np
import pytest

from trueup.core.correlation.orthogonality import REQUIREMENTS, orthogonality, unmet
from trueup.core.errors import InputError

MASS = np.diag([1.0, 4.0])


def test_by_hand():
    a, t = np.array([[1.0, 0.0], [0.0, 1.0]]), np.array([[-3.0, 0.0], [2.0, 0.5]])
    found = orthogonality(a, t, MASS)
    np.testing.assert_allclose(found.cross, [[0.6, 0.8], [0.0, 1.0]])
    np.testing.assert_allclose(found.own, [[1.0, 0.8], [0.8, 1.0]])


def test_shapes_that_are_the_models_meet_every_requirement():
    a = np.eye(2)
    for asked in REQUIREMENTS:
        assert not unmet(orthogonality(a, -a, MASS), np.array([1.0, -2.9]), asked)


def test_what_is_not_met_is_named():
    nasa, air_force = REQUIREMENTS
    turned = np.array([[np.cos(0.35), 0.0], [np.sin(0.35) / 2.0, 1.0]])
    found = orthogonality(np.eye(2), turned, MASS)
    assert np.diag(found.cross)[0] == pytest.approx(np.cos(0.35))
    of_nasa = unmet(found, np.array([-4.0, 1.0]), nasa)
    assert of_nasa == ("beside 0.34", "own 0.34")
    of_air_force = unmet(found, np.array([-4.0, 1.0]), air_force)
    assert of_air_force[:2] == ("deviation 4.0 %", "cross 0.94")


def test_shapes_at_other_sensors_are_refused():
    with pytest.raises(InputError, match="do not belong together"):
        orthogonality(np.eye(2), np.eye(3), MASS)
