import numpy as np
import pytest
from hypothesis import given, strategies as st

from trueup.core.correlation.criteria import Criteria
from trueup.core.correlation.mode_pairing import correlate
from trueup.core.errors import InputError

ANGLE = np.linspace(0.0, 2.0 * np.pi, 36, endpoint=False)


def ring(orders=(2, 3, 4, 5)):
    """Mass-orthonormal pairs of a perfect ring, and their frequencies."""
    shapes = [f(n * ANGLE) / np.sqrt(18.0) for n in orders for f in (np.cos, np.sin)]
    hz = np.repeat([10.0 * n * n for n in orders], 2).astype(float)
    return hz, np.column_stack(shapes)


def spun(shapes, angles):
    out = shapes.copy()
    for k, a in enumerate(angles):
        c, s = np.cos(a), np.sin(a)
        out[:, 2 * k : 2 * k + 2] = shapes[:, 2 * k : 2 * k + 2] @ [[c, -s], [s, c]]
    return out


@given(st.lists(st.floats(0, np.pi), min_size=4, max_size=4))
def test_any_spin_of_the_pairs_of_a_ring_is_undone(angles):
    hz, shapes = ring()
    test_hz = hz * np.tile([0.99, 1.01], 4)
    found = correlate(hz, shapes, test_hz, 3.0 * spun(shapes, angles))
    assert len(found.pairs) == 8
    assert min(p.mac for p in found.pairs) > 1.0 - 1e-9
    np.testing.assert_allclose(found.transformation.T @ found.transformation, np.eye(8), atol=1e-12)


def test_without_rotation_a_ring_spun_by_half_its_lobe_pairs_badly():
    hz, shapes = ring()
    test = spun(shapes, [np.pi / 4] * 4)
    assert correlate(hz, shapes, hz, test, Criteria(rotate="none")).pairs == ()


def test_the_test_side_can_be_rotated_instead():
    hz, shapes = ring()
    test = spun(shapes, [0.5, 1.0, 0.2, 0.9])
    found = correlate(hz, shapes, hz, test, Criteria(rotate="test"))
    assert len(found.pairs) == 8
    assert min(p.mac for p in found.pairs) > 1.0 - 1e-9


def test_a_single_test_mode_of_a_pair_finds_its_place():
    hz, shapes = ring()
    test = spun(shapes, [0.3, 0.4, 0.5, 0.6])[:, [0, 2, 5]]
    found = correlate(hz, shapes, hz[[0, 2, 5]], test)
    assert [p.test for p in found.pairs] == [0, 1, 2]
    assert {p.analysis // 2 for p in found.pairs} == {0, 1, 2}
    assert found.unpaired_test == ()
    assert len(found.unpaired_analysis) == 5


def test_unrelated_shapes_stay_unpaired():
    hz, shapes = ring()
    other = np.cos(9 * ANGLE)[:, None]
    found = correlate(hz, shapes, np.array([40.0]), other)
    assert found.pairs == ()
    assert found.unpaired_test == (0,)


def test_the_frequency_tolerance_holds():
    hz, shapes = ring()
    far = correlate(hz, shapes, hz * 1.5, shapes, Criteria(frequency_tolerance=0.3))
    near = correlate(hz, shapes, hz * 1.3, shapes, Criteria(frequency_tolerance=0.3))
    assert len(far.pairs) == 0
    assert len(near.pairs) == 8


def test_rigid_body_modes_are_never_paired():
    hz, shapes = ring()
    found = correlate(hz, shapes, hz, shapes, rigid_body_modes=2)
    assert {p.analysis for p in found.pairs} == set(range(2, 8))


def test_the_deviation_is_of_the_analysis_from_the_test():
    hz, shapes = ring()
    found = correlate(1.02 * hz, shapes, hz, shapes)
    np.testing.assert_allclose([p.deviation_percent for p in found.pairs], 2.0)


def test_the_rotation_angle_is_reported():
    hz, shapes = ring((2,))
    found = correlate(hz, shapes, hz, spun(shapes, [np.radians(30.0)]))
    np.testing.assert_allclose([p.rotation_deg for p in found.pairs], 30.0)


def test_complex_test_shapes_pair_like_real_ones():
    hz, shapes = ring()
    test = spun(shapes, [0.3] * 4) * np.exp(1j * np.arange(8))
    assert len(correlate(hz, shapes, hz, test).pairs) == 8


@pytest.mark.parametrize(
    "wrong",
    [
        {"mac_min": 0.0},
        {"mac_min": 1.1},
        {"frequency_tolerance": 0.0},
        {"cluster_width": 1.0},
        {"rotate": "both"},
    ],
)
def test_criteria_out_of_range_are_refused(wrong):
    with pytest.raises(InputError, match=next(iter(wrong))):
        Criteria(**wrong)
