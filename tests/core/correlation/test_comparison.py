"""A test laid onto a model and compared: units, sensors, modal mass."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from trueup.core.correlation.comparison import compare, mass_normalised, place_test
from trueup.core.data.dofs import Dofs
from trueup.core.data.frfs import Frfs
from trueup.core.data.geometry import Geometry
from trueup.core.data.measurement import Measurement
from trueup.core.data.modes import Modes
from trueup.core.eigen.normal_modes import modes_of, solve
from trueup.core.errors import InputError

NODES = np.arange(0, 13)


@pytest.fixture
def analysis(frame):
    """A bent mast of no symmetry, millimetre numbers not needed: lengths are metres."""
    t = np.linspace(0.0, 1.0, 13)
    xyz = np.column_stack([t, 0.3 * t**2, 0.2 * np.sin(2.0 * t)])
    bars = [(i, i + 1) for i in range(12)]
    model = frame(xyz, bars, fixed=[(0, c) for c in range(1, 7)], masses=[(7, 0.2)])
    solution = solve(model, 8)
    geometry = replace(model.geometry, elements={"line": np.array(bars)},
                       element_ids={"line": np.arange(1, 13)})  # fmt: skip
    return geometry, modes_of(model, solution)


def measured(analysis, unit="m", factor=1.0, scale=1.0, number=100) -> Measurement:
    """The first modes at every node in all three directions, in another length unit."""
    geometry, modes = analysis
    ids = geometry.ids[NODES] + number
    node = np.repeat(ids, 3)
    component = np.tile([1, 2, 3], len(NODES))
    rows = (6 * np.repeat(NODES, 3) + component - 1).astype(int)
    shapes = modes.shapes[rows, :5] * factor * scale
    test = Modes(modes.frequencies_hz[:5] * 0.97, shapes, Dofs(node, component))
    return Measurement(Geometry(ids, geometry.xyz[NODES] * factor, unit), test, None, unit)


def test_a_test_of_the_model_itself_pairs_mode_by_mode(analysis):
    geometry, modes = analysis
    placed = place_test(geometry, modes, measured(analysis), "m")
    found = compare(geometry, modes, placed).correlation
    assert [(p.test, p.analysis) for p in found.pairs] == [(k, k) for k in range(5)]
    assert all(p.mac > 1.0 - 1e-9 for p in found.pairs)
    assert all(p.deviation_percent == pytest.approx(100 / 0.97 - 100) for p in found.pairs)


@pytest.mark.parametrize(("unit", "factor"), [("mm", 1e3), ("in", 1 / 0.0254), ("ft", 1 / 0.3048)])
def test_lengths_and_shapes_are_converted_to_the_decks_unit(analysis, unit, factor):
    geometry, modes = analysis
    plain = place_test(geometry, modes, measured(analysis), "m")
    placed = place_test(geometry, modes, measured(analysis, unit, factor), "m")
    assert placed.length_factor == pytest.approx(1.0 / factor)
    assert placed.test_geometry.length_unit == "m"
    np.testing.assert_allclose(placed.observation.xyz, plain.observation.xyz, atol=1e-9)
    np.testing.assert_allclose(placed.test.shapes, plain.test.shapes, atol=1e-9)
    np.testing.assert_allclose(placed.observation.distance, 0.0, atol=1e-9)


def test_a_frequency_below_zero_is_refused_and_one_of_zero_pairs_with_nothing(analysis):
    geometry, modes = analysis
    test = measured(analysis)
    wrong, still = test.modes.frequencies_hz.copy(), test.modes.frequencies_hz.copy()
    wrong[2] *= -1.0
    still[2] = 0.0
    with pytest.raises(InputError, match=r"mode 3 of the test has a frequency of -\d"):
        place_test(geometry, modes, replace(test, modes=replace(test.modes, frequencies_hz=wrong)))
    placed = place_test(
        geometry, modes, replace(test, modes=replace(test.modes, frequencies_hz=still)), "m"
    )
    assert any("test mode 3: the frequency is 0 Hz or blank" in w for w in placed.warnings)
    found = compare(geometry, modes, placed).correlation
    assert [p.test for p in found.pairs] == [0, 1, 3, 4]


def test_nodes_all_in_one_place_are_no_geometry(analysis):
    geometry, modes = analysis
    test = measured(analysis)
    flat = replace(test, geometry=replace(test.geometry, xyz=0.0 * test.geometry.xyz))
    with pytest.raises(InputError, match="all 13 nodes of the test lie at one position"):
        place_test(geometry, modes, flat, "m")


def test_sensors_off_the_model_are_left_out_aloud(analysis):
    geometry, modes = analysis
    test = measured(analysis)
    far = test.geometry.xyz.copy()
    far[4] += [0.0, 0.25, 0.0]
    placed = place_test(geometry, modes, replace(test, geometry=replace(test.geometry, xyz=far)),
                        "m")  # fmt: skip
    assert int(geometry.ids[4]) + 100 not in placed.observation.sensors.node
    assert len(placed.test.shapes) == len(placed.observation.sensors) == 3 * (len(NODES) - 1)
    assert any("105" in w for w in placed.warnings)
    assert len(compare(geometry, modes, placed).correlation.pairs) == 5


def test_a_test_without_modes_is_refused(analysis):
    geometry, modes = analysis
    test = measured(analysis)
    dofs = test.modes.dofs
    frfs = Frfs(np.arange(3.0), dofs, dofs.take([0]), np.ones((len(dofs), 1, 3)))
    with pytest.raises(InputError, match="the test holds no modes"):
        place_test(geometry, modes, replace(test, modes=None, frfs=frfs), "m")


def test_a_test_a_thousand_times_too_small_is_refused(analysis):
    geometry, modes = analysis
    tiny = measured(analysis, "m", 1e-3)
    with pytest.raises(InputError, match="1000 times smaller than the model"):
        place_test(replace(geometry, length_unit="mm"), modes, tiny, "m")


def test_rigid_body_modes_never_pair(analysis):
    geometry, modes = analysis
    placed = place_test(geometry, modes, measured(analysis), "m")
    found = compare(geometry, modes, placed, rigid_body_modes=2).correlation
    assert {p.analysis for p in found.pairs} == {2, 3, 4}
    assert found.unpaired_test == (0, 1)
    assert not {0, 1} & set(found.unpaired_analysis)


def test_modes_of_known_modal_mass_are_brought_to_one(analysis):
    _, modes = analysis
    mass = np.array([4.0, 0.25, np.nan, 0.0, 1.0, 9.0, 1.0, 1.0])
    scaled = Modes(modes.frequencies_hz, modes.shapes, modes.dofs, generalized_mass=mass)
    found = mass_normalised(scaled)
    factor = [0.5, 2.0, 1.0, 1.0, 1.0, 1 / 3, 1.0, 1.0]
    np.testing.assert_allclose(found.shapes, modes.shapes * factor)
    np.testing.assert_array_equal(found.generalized_mass, [1, 1, np.nan, 0, 1, 1, 1, 1])
    assert scaled.generalized_mass[0] == 4.0


def test_scaling_of_the_test_shapes_does_not_matter(analysis):
    geometry, modes = analysis
    one, other = (
        compare(geometry, modes, place_test(geometry, modes, measured(analysis, scale=s), "m"))
        for s in (1.0, -1e-4)
    )
    np.testing.assert_allclose(one.correlation.mac, other.correlation.mac, atol=1e-12)
