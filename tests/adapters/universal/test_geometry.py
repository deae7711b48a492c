"""Nodes, coordinate systems, elements and trace lines come out in the basic frame."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from trueup.adapters.universal import read_test, read_universal
from trueup.core.errors import InputError

NODES = [(1, 1.0, 2.0, 3.0), (7, -4.0, 5.5, 0.0), (3, 0.0, 0.0, 9.0)]
TURN = Rotation.from_euler("xyz", [20, -35, 50], degrees=True).as_matrix()  # columns: local axes
ORIGIN = np.array([0.3, -1.0, 2.0])


@pytest.mark.parametrize("kind", ["nodes_15", "nodes_2411"])
def test_nodes_in_file_order(uff, write, kind):
    geometry = read_universal(write(getattr(uff, kind)(NODES))).geometry
    np.testing.assert_array_equal(geometry.ids, [1, 7, 3])
    np.testing.assert_allclose(geometry.xyz, [n[1:] for n in NODES], rtol=1e-15)
    assert geometry.length_unit is None


@pytest.mark.parametrize(
    ("factor", "unit"),
    [(1.0, "m"), (1000.0, "mm"), (39.37008, "in"), (39.370079, "in"), (3.2808, "ft"), (7.0, None)],
)
def test_length_unit_by_its_factor(uff, write, factor, unit):
    content = read_universal(write(uff.units(factor, 9) + uff.nodes_15(NODES)))
    assert content.length_unit == content.geometry.length_unit == unit
    assert content.units.length_factor == pytest.approx(factor)
    assert bool(content.warnings) == (unit is None)


def test_factor_upside_down_is_turned_as_the_code_says_and_told(uff, write):
    content = read_universal(write(uff.units(0.001, 10)))
    assert content.length_unit == "mm"
    assert "upside down" in content.warnings[0]


def test_a_code_that_contradicts_its_factor_is_told(uff, write):
    content = read_universal(write(uff.units(1.0, 5)))
    assert content.length_unit == "m"
    assert "the factor is used" in content.warnings[0]


def test_files_in_different_units_are_listed_and_refused_as_a_test(uff, write):
    both = uff.nodes_15(NODES) + uff.shape_55({n[0]: (1, 0, 0) for n in NODES})
    paths = [write(uff.units(1.0) + both, "a.unv"), write(uff.units(1000.0, 5), "b.unv")]
    content = read_universal(paths)
    assert content.length_unit == "m"
    (listed,) = content.skipped
    assert (listed.path, listed.line) == (str(paths[1]), 2)
    with pytest.raises(InputError, match=r"b\.unv line 2: .*a\.unv line 2.*different length"):
        read_test(paths)


def system_18(number, kind, reference, points):
    lines = [f"{number:10d}{kind:10d}{reference:10d}{8:10d}{1:10d}", f"SYS{number}"]
    values = np.ravel(points)
    return [*lines, *("".join(f"{v:13.5E}" for v in values[k : k + 6]) for k in (0, 6))]


def test_definition_system_of_dataset_18_moves_and_turns_nodes(uff, write):
    points = [ORIGIN, ORIGIN + 2 * TURN[:, 0], ORIGIN + TURN[:, 2] - 0.7 * TURN[:, 0]]
    text = uff.dataset(18, *system_18(5, 0, 0, points)) + uff.nodes_15(NODES, definition=5)
    geometry = read_universal(write(text)).geometry
    expected = np.array([n[1:] for n in NODES]) @ TURN.T + ORIGIN
    np.testing.assert_allclose(geometry.xyz, expected, atol=1e-4)


def test_a_system_of_dataset_18_may_refer_to_another(uff, write):
    first = system_18(5, 0, 0, [[1, 0, 0], [2, 0, 0], [1, 0, 1]])
    second = system_18(6, 0, 5, [[0, 1, 0], [0, 2, 0], [0, 1, 1]])  # x along basic y
    text = uff.dataset(18, *first, *second) + uff.nodes_15([(1, 1.0, 0.0, 0.0)], definition=6)
    np.testing.assert_allclose(read_universal(write(text)).geometry.xyz, [[1, 2, 0]], atol=1e-12)


def test_cylindrical_and_spherical_coordinates_are_in_degrees(uff, write):
    points = [[0, 0, 0], [1, 0, 0], [1, 0, 1]]
    text = uff.dataset(18, *system_18(2, 1, 0, points), *system_18(3, 2, 0, points))
    text += uff.nodes_15([(1, 2.0, 90.0, 5.0)], definition=2)
    text += uff.nodes_15([(2, 2.0, 60.0, 90.0)], definition=3)
    content = read_universal(write(text))
    expected = [[0, 2, 5], [0, np.sqrt(3), 1]]
    np.testing.assert_allclose(content.geometry.xyz, expected, atol=1e-5)
    assert "in degrees" in content.warnings[0]


def axes_at(uff, write, kind, nodes, origin=ORIGIN):
    """Axes of three values of a shape at nodes whose displacement system is of a kind."""
    text = uff.systems_2420((4, kind, [*TURN.T, origin])) + uff.nodes_2411(nodes, displacement=4)
    text += uff.shape_55({n[0]: (1.0, 2.0, 3.0) for n in nodes})
    return read_universal(write(text)).modes.dofs.axis.reshape(-1, 3, 3)


def test_cartesian_displacement_axes_of_2420_are_the_rows_of_its_matrix(uff, write):
    axes = axes_at(uff, write, 0, NODES)
    np.testing.assert_allclose(axes, np.tile(TURN.T, (3, 1, 1)), atol=1e-14)


@pytest.mark.parametrize("kind", [1, 2])
def test_curved_displacement_axes_follow_the_position(uff, write, kind):
    """Axis k is the direction of motion when the k-th coordinate grows (central difference)."""
    rng = np.random.default_rng(1)
    r, a, b = rng.uniform(0.5, 2.0, 6), rng.uniform(0.3, 2.8, 6), rng.uniform(-3.0, 3.0, 6)

    def place(q):
        r, a, b = q
        if kind == 1:
            local = [r * np.cos(a), r * np.sin(a), b]
        else:
            local = [r * np.sin(a) * np.cos(b), r * np.sin(a) * np.sin(b), r * np.cos(a)]
        return np.array(local).T @ TURN.T + ORIGIN

    q, h = np.array([r, a, b]), 1e-6
    moved = [place(q + h * e[:, None]) - place(q - h * e[:, None]) for e in np.eye(3)]
    expected = np.array([m / np.linalg.norm(m, axis=1)[:, None] for m in moved])
    nodes = [(k + 1, *xyz) for k, xyz in enumerate(place(q))]
    axes = axes_at(uff, write, kind, nodes)
    np.testing.assert_allclose(axes, np.swapaxes(expected, 0, 1), atol=1e-8)


def test_a_node_on_the_axis_is_told(uff, write):
    text = uff.systems_2420((4, 1, [*np.eye(3), [0, 0, 0]]))
    text += uff.nodes_2411([(1, 0.0, 0.0, 1.0), (2, 1.0, 0.0, 1.0)], displacement=4)
    content = read_universal(write(text))
    assert "node(s) 1 lie on the axis" in content.warnings[0]


def test_an_undefined_system_is_told_and_not_guessed_silently(uff, write):
    content = read_universal(write(uff.nodes_2411(NODES, displacement=12)))
    assert "coordinate system 12, used by 3 node(s), is not defined" in content.warnings[0]


def test_system_1_of_ideas_is_the_basic_frame(uff, write):
    assert read_universal(write(uff.nodes_2411(NODES, displacement=1))).warnings == ()


def test_systems_may_come_in_a_later_file(uff, write):
    first = write(uff.nodes_15(NODES, definition=5), "a.unv")
    points = [[10, 0, 0], [11, 0, 0], [10, 0, 1]]
    second = write(uff.dataset(18, *system_18(5, 0, 0, points)), "b.unv")
    geometry = read_universal([first, second]).geometry
    np.testing.assert_allclose(geometry.xyz[:, 0], [11, 6, 10])


def test_the_same_node_twice(uff, write):
    content = read_universal(write(uff.nodes_15(NODES) + uff.nodes_2411(NODES[:2])))
    np.testing.assert_array_equal(content.geometry.ids, [1, 7, 3])
    assert "2 node(s) are given more than once" in content.warnings[0]


def test_the_same_node_at_two_places_is_listed_and_refused_as_a_test(uff, write):
    shape = uff.shape_55({n[0]: (1, 0, 0) for n in NODES})
    path = write(uff.nodes_15([*NODES, (1, 0.0, 0.0, 0.0)]) + shape)
    content = read_universal(path)
    np.testing.assert_array_equal(content.geometry.xyz[0], NODES[0][1:])
    (listed,) = content.skipped
    assert (listed.what, listed.line) == ("node 1", 2)
    with pytest.raises(InputError, match=r"line 2: node 1 .*twice at different positions"):
        read_test(path)


def test_a_damaged_dataset_does_not_take_the_others_with_it(uff, write):
    """Listed with the line of the damage; a test without it is refused."""
    values = {n[0]: (1, 0, 0) for n in NODES}
    good_lines = uff.shape_55(values, 7.0)
    bad = "********".join(good_lines.rsplit("1.00000E+00", 1))
    assert bad != good_lines
    good = uff.nodes_15(NODES) + uff.shape_55(values, 5.0)
    path = write(good + bad + uff.shape_55(values, 9.0))
    content = read_universal(path)
    assert content.modes.frequencies_hz.tolist() == [5.0, 9.0]
    (listed,) = content.skipped
    lines = path.read_text().splitlines()
    assert "****" in lines[listed.line - 1]
    with pytest.raises(InputError, match=f"line {listed.line}: "):
        read_test(path)
    cut = write(good + uff.dataset(2420, "         1", "name", "         5         0"), "cut.unv")
    assert read_universal(cut).skipped[0].harm == "test"
    with pytest.raises(InputError, match="system 5 needs 12 values"):
        read_test(cut)


@pytest.mark.parametrize(
    ("lines", "said"),
    [
        ((" 1 0 0 11  0.0 1.0",), "line 3.*does not hold 7 numbers"),
        ((" 1 0 0 11  0.0 1.0 nan",), "line 3.*not finite"),
        ((" 1 0 0 11  0.0 1.0 2.0", " 2 0 0 11  0.0 1.0 ****"), "line 4.*does not hold 7"),
    ],
)
def test_damaged_nodes_name_their_line(uff, write, lines, said):
    with pytest.raises(InputError, match=said):
        read_universal(write(uff.dataset(15, *lines)))


def test_a_node_cut_in_two(uff, write):
    with pytest.raises(InputError, match="middle of a node"):
        read_universal(write(uff.dataset(2411, "         1         1         1        11")))


def test_points_on_one_line_make_no_system(uff, write):
    points = [[0, 0, 0], [1, 0, 0], [2, 0, 0]]
    with pytest.raises(InputError, match=r"line 3.*system 5: the three points lie on one line"):
        read_universal(write(uff.dataset(18, *system_18(5, 0, 0, points))))


def test_headers_of_151_and_2400(uff, write):
    lines = [
        "model.unv",
        "a wing",
        "program 1",
        "21-Nov-26 10:00:00         0",
        "",
        "program 2",
        "",
    ]
    text = uff.dataset(151, *lines)
    text += uff.dataset(2400, "1", "wing", "part 7", "0", "22-Nov-26 11:00:00 0 0 0", "3")
    found = read_universal(write(text)).headers
    assert [(h.name, h.description, h.program) for h in found] == [
        ("model.unv", "a wing", "program 2"),
        ("wing", "part 7", ""),
    ]
    assert found[0].created == "21-Nov-26 10:00:00"


def test_axes_that_are_not_orthogonal_are_refused(uff, write):
    skew = [[1, 0, 0], [0.5, 1, 0], [0, 0, 1], [0, 0, 0]]
    with pytest.raises(InputError, match="system 4 are not orthogonal"):
        read_universal(write(uff.systems_2420((4, 0, skew))))


def test_trace_lines_draw_segments_where_the_pen_is_down(uff, write):
    trace = uff.dataset(
        82, f"{3:10d}{6:10d}{1:10d}", "NONE", "".join(f"{n:10d}" for n in (1, 7, 0, 7, 3, 3))
    )
    content = read_universal(write(uff.nodes_15(NODES) + trace))
    np.testing.assert_array_equal(content.geometry.elements["line"], [[0, 1], [1, 2]])
    np.testing.assert_array_equal(content.geometry.element_ids["line"], [3, 3])
    assert content.traces[0].number == 3


def test_a_trace_line_through_a_missing_node_is_told(uff, write):
    trace = uff.dataset(
        82, f"{3:10d}{3:10d}{1:10d}", "NONE", "".join(f"{n:10d}" for n in (1, 99, 7))
    )
    content = read_universal(write(uff.nodes_15(NODES) + trace))
    assert "line" not in content.geometry.elements
    assert "node(s) 99" in content.warnings[0]


def element(number, descriptor, nodes, beam=False):
    lines = ["".join(f"{v:10d}" for v in (number, descriptor, 1, 1, 7, len(nodes)))]
    lines += [f"{0:10d}{1:10d}{1:10d}"] if beam else []
    return lines + ["".join(f"{n:10d}" for n in nodes[k : k + 8]) for k in range(0, len(nodes), 8)]


@pytest.mark.parametrize(
    ("descriptor", "n", "shape", "corners", "beam"),
    [
        (161, 1, "point", [1], False),
        (11, 2, "line", [1, 2], True),
        (24, 3, "line", [1, 3], True),
        (91, 3, "tria", [1, 2, 3], False),
        (92, 6, "tria", [1, 3, 5], False),
        (94, 4, "quad", [1, 2, 3, 4], False),
        (95, 8, "quad", [1, 3, 5, 7], False),
        (111, 4, "tetra", [1, 2, 3, 4], False),
        (118, 10, "tetra", [1, 3, 5, 10], False),
        (112, 6, "penta", [1, 2, 3, 4, 5, 6], False),
        (115, 8, "hexa", [1, 2, 3, 4, 5, 6, 7, 8], False),
        (116, 20, "hexa", [1, 3, 5, 7, 13, 15, 17, 19], False),
    ],
)
def test_elements_by_their_corners(uff, write, descriptor, n, shape, corners, beam):
    nodes = uff.nodes_15([(k, float(k), 0.0, 0.0) for k in range(1, 21)])
    lines = element(8, descriptor, list(range(1, n + 1)), beam)
    content = read_universal(write(nodes + uff.dataset(2412, *lines, *lines)))
    found = content.geometry.elements[shape]
    np.testing.assert_array_equal(content.geometry.ids[found], [corners, corners])
    np.testing.assert_array_equal(content.geometry.element_ids[shape], [8, 8])


def test_elements_that_cannot_be_drawn_are_listed(uff, write):
    text = uff.nodes_15(NODES) + uff.dataset(2412, *element(1, 117, [1] * 32))
    content = read_universal(write(text))
    assert "1 element(s) of descriptor 117" in content.skipped[0].what


def test_an_element_cut_off_names_its_line(uff, write):
    with pytest.raises(InputError, match="line 3: dataset 2412: element 1 announces 4 nodes"):
        read_universal(write(uff.dataset(2412, *element(1, 94, [1, 2, 3, 4])[:1], "         1")))
