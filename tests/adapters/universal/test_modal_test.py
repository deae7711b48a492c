"""A test for correlation: geometry, measured directions, units, and what must be refused."""

import numpy as np
import pytest

from trueup.adapters.universal import read_test, read_universal
from trueup.core.errors import InputError

NODES = [(k, np.cos(k), np.sin(k), 0.1 * k) for k in range(1, 9)]


def radial(uff, n_mode=6, nodes=NODES):
    """A test measured along the radius at each node, written as x, y, z."""
    rng = np.random.default_rng(2)
    axis = np.array([[x, y, 0.0] for _, x, y, _ in nodes])
    readings = rng.normal(size=(n_mode, len(nodes)))
    shapes = [
        uff.shape_55({n[0]: r * a for n, r, a in zip(nodes, reading, axis, strict=True)}, 10.0 + k)
        for k, reading in enumerate(readings)
    ]
    return axis, readings, "".join(shapes)


def test_sensors_askew_are_one_row_each_along_their_axis(uff, write):
    axis, readings, shapes = radial(uff)
    test = read_test(write(uff.units() + uff.nodes_15(NODES) + shapes))
    assert len(test.modes.dofs) == len(NODES)
    sign = np.sign(np.sum(test.modes.dofs.axis * axis, axis=1))
    np.testing.assert_allclose(test.modes.dofs.axis, sign[:, None] * axis, atol=1e-4)
    np.testing.assert_allclose(test.modes.shapes, sign[:, None] * readings.T, atol=1e-4)
    assert test.length_unit == test.geometry.length_unit == "m"
    assert test.warnings == ()


def test_geometry_in_a_file_of_its_own(uff, write):
    _, _, shapes = radial(uff)
    paths = [write(shapes, "modes.unv"), write(uff.nodes_15(NODES), "nodes.unv")]
    assert len(read_test(paths).modes.dofs) == len(NODES)


def test_local_displacement_systems_are_honoured(uff, write):
    """A radial sensor of a cylindrical system: one value a node, axis along the radius."""
    text = uff.systems_2420((1, 1, [*np.eye(3), [0, 0, 0]])) + uff.nodes_2411(NODES, displacement=1)
    text += uff.shape_55({n[0]: (float(n[0]), 0.0, 0.0) for n in NODES})
    dofs = read_test(write(text)).modes.dofs
    np.testing.assert_allclose(dofs.axis, [[x, y, 0.0] for _, x, y, _ in NODES], atol=1e-12)
    np.testing.assert_array_equal(dofs.component, 1)


def test_files_of_a_roving_survey_number_their_systems_for_themselves(uff, write):
    """System 4 is another one in each file; each file's nodes stand in their own."""
    turns = [np.eye(3), np.eye(3)[[1, 2, 0]]]
    paths = []
    for k, turn in enumerate(turns):
        nodes = NODES[4 * k : 4 * k + 4]
        text = uff.systems_2420((4, 0, [*turn, [0, 0, 0]]))
        text += uff.nodes_2411(nodes, displacement=4)
        paths.append(write(text, f"part{k}.unv"))
    shape = uff.shape_55({n[0]: (1.0, 2.0, 3.0) for n in NODES})
    modes = read_universal([*paths, write(shape, "shape.unv")]).modes
    axes = modes.dofs.axis.reshape(-1, 3, 3)
    np.testing.assert_allclose(axes[:4], np.tile(turns[0], (4, 1, 1)), atol=1e-12)
    np.testing.assert_allclose(axes[4:], np.tile(turns[1], (4, 1, 1)), atol=1e-12)


def test_a_node_in_two_systems_is_told(uff, write):
    one = uff.nodes_2411(NODES)
    turned = uff.systems_2420((4, 0, [*np.eye(3)[[1, 2, 0]], [0, 0, 0]]))
    turned += uff.nodes_2411(NODES[:2], displacement=4)
    content = read_universal([write(one, "one.unv"), write(turned, "two.unv")])
    assert any("node(s) 1, 2 are given again with another" in w for w in content.warnings)


def test_no_unit_is_told(uff, write):
    _, _, shapes = radial(uff)
    test = read_test(write(uff.nodes_15(NODES) + shapes))
    assert test.length_unit is None
    assert "length unit of the test is not declared" in test.warnings[-1]


def test_responses_with_geometry(uff, write):
    text = uff.nodes_15(NODES) + uff.function_58([1.0, 2.0], (1, 1), (2, 1))
    test = read_test(write(text))
    assert test.modes is None
    assert test.frfs.responses.labels == ["1:X"]


def test_a_node_that_is_zero_throughout_is_told(uff, write):
    text = uff.nodes_15(NODES) + uff.shape_55({1: (1, 1, 0), 2: (0, 0, 0)})
    test = read_test(write(text))
    assert set(test.modes.dofs.node.tolist()) == {1}
    assert any(": 2" in w for w in test.warnings)


@pytest.mark.parametrize(
    ("parts", "said"),
    [
        (("shape",), "a test with no geometry .*dataset 15 or 2411"),
        (("nodes",), "neither mode shapes .* nor frequency responses"),
        (("nodes", "far"), "use node 77, which has no position"),
        (("nodes", "zero"), "every mode shape is zero"),
    ],
)
def test_what_makes_no_test_is_one_clear_sentence(uff, write, parts, said):
    texts = {
        "nodes": uff.nodes_15(NODES),
        "shape": uff.shape_55({1: (1.0, 2.0, 3.0)}),
        "far": uff.shape_55({77: (1.0, 2.0, 3.0)}),
        "zero": uff.shape_55({1: (0.0, 0.0, 0.0)}),
    }
    with pytest.raises(InputError, match=said) as caught:
        read_test(write("".join(texts[p] for p in parts)))
    assert "test.unv" in str(caught.value)
    assert "\n" not in str(caught.value)
