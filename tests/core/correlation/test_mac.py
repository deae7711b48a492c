import numpy as np
import pytest
from hypothesis import given, strategies as st
from hypothesis.extra.numpy import arrays

from trueup.core.correlation.mac import deviation_percent, mac, realised
from trueup.core.errors import InputError


def test_orthogonal_shapes_have_an_identity_mac():
    np.testing.assert_allclose(mac(np.eye(4), np.eye(4)), np.eye(4))


def test_mac_of_two_vectors_is_the_squared_cosine_of_their_angle():
    a = np.array([[1.0], [0.0]])
    b = np.array([[np.cos(0.3)], [np.sin(0.3)]])
    assert mac(a, b)[0, 0] == pytest.approx(np.cos(0.3) ** 2)


@given(
    arrays(float, (5, 3), elements=st.floats(-10, 10)),
    st.floats(0.01, 100),
    st.floats(0, 2 * np.pi),
)
def test_mac_does_not_depend_on_scale_or_phase(shapes, scale, phase):
    other = shapes[:, ::-1] + 0.5
    turned = other * scale * np.exp(1j * phase)
    np.testing.assert_allclose(mac(shapes, turned), mac(shapes, other), atol=1e-9)


def test_a_zero_shape_has_no_mac():
    assert mac(np.zeros((3, 1)), np.ones((3, 1)))[0, 0] == 0.0


def test_shapes_at_different_sensors_are_refused():
    with pytest.raises(InputError, match="same sensors"):
        mac(np.ones((3, 1)), np.ones((4, 1)))


def test_deviation_is_relative_to_the_test():
    assert deviation_percent(np.array([101.0]), np.array([100.0]))[0] == pytest.approx(1.0)


def test_a_turned_real_shape_is_found_again():
    shape = np.array([[1.0], [-2.0], [0.5]])
    found = realised(shape * np.exp(0.7j))
    assert mac(found, shape)[0, 0] == pytest.approx(1.0)
    assert np.linalg.norm(found) == pytest.approx(np.linalg.norm(shape))
