"""What is written reads back equal, by trueup and by pyuff."""

import numpy as np
import pytest
import pyuff
from hypothesis import given, settings, strategies as st
from hypothesis.extra import numpy as hnp
from scipy.spatial.transform import Rotation

from trueup.adapters.universal import Units, read_universal, write_universal
from trueup.core.data.dofs import Dofs
from trueup.core.data.frfs import Frfs
from trueup.core.data.geometry import Geometry
from trueup.core.data.modes import Modes
from trueup.core.errors import InputError

CORNERS = {"point": 1, "line": 2, "tria": 3, "quad": 4, "tetra": 4, "pyramid": 5, "penta": 6,
           "hexa": 8}  # fmt: skip
FINITE = st.floats(-1e12, 1e12, allow_subnormal=False)


@st.composite
def geometries(draw):
    n = draw(st.integers(8, 12))
    ids = draw(st.lists(st.integers(1, 2**31 - 1), min_size=n, max_size=n, unique=True))
    elements, numbers = {}, {}
    for shape in draw(st.lists(st.sampled_from(list(CORNERS)), unique=True)):
        count = draw(st.integers(1, 4))
        row = st.permutations(range(n)).map(lambda p, k=CORNERS[shape]: p[:k])
        elements[shape] = draw(st.lists(row, min_size=count, max_size=count))
        numbers[shape] = draw(st.lists(st.integers(1, 99), min_size=count, max_size=count))
    return Geometry(
        ids,
        draw(hnp.arrays(np.float64, (n, 3), elements=FINITE)),
        draw(st.sampled_from(["m", "mm", "in", "ft", None])),
        elements,
        numbers,
    )


@settings(max_examples=60, deadline=None)
@given(geometries())
def test_geometry_comes_back_equal(tmp_path_factory, geometry):
    path = tmp_path_factory.mktemp("g") / "g.unv"
    write_universal(path, geometry=geometry)
    content = read_universal(path)
    assert content.skipped == content.warnings == ()
    again = content.geometry
    np.testing.assert_array_equal(again.ids, geometry.ids)
    np.testing.assert_array_equal(again.xyz, geometry.xyz)
    assert again.length_unit == geometry.length_unit
    assert again.elements.keys() == geometry.elements.keys()
    for shape in geometry.elements:
        np.testing.assert_array_equal(again.elements[shape], geometry.elements[shape])
        np.testing.assert_array_equal(again.element_ids[shape], geometry.element_ids[shape])


def vectors(dofs, values):
    """Motion of each node as three or six components in the basic frame."""
    found = {}
    for node, component, axis, value in zip(
        dofs.node.tolist(), dofs.component.tolist(), dofs.axis, values, strict=True
    ):
        part = found.setdefault(node, np.zeros((6, values.shape[1]), values.dtype))
        part[3 * (component > 3) : 3 * (component > 3) + 3] += np.outer(axis, value)
    return found


@st.composite
def modes_of_sensors(draw):
    """Modes on any orthogonal axes, one to three directions a node, some rotations."""
    n, m = draw(st.integers(1, 5)), draw(st.integers(1, 4))
    seed = draw(st.integers(0, 10**6))
    rng = np.random.default_rng(seed)
    turns = Rotation.random(n, random_state=seed).as_matrix()
    if draw(st.booleans()):
        turns[:] = np.eye(3)
    rows = [
        (10 * k + 1, c, turns[k][(c - 1) % 3])
        for k in range(n)
        for c in sorted(draw(st.sets(st.integers(1, 6), min_size=1)))
    ]
    node, component, axis = zip(*rows, strict=True)
    shapes = rng.normal(size=(len(rows), m)) * 10.0 ** rng.integers(-20, 20, m)
    if draw(st.booleans()):
        shapes = shapes + 1j * rng.normal(size=shapes.shape)
    unknown = draw(st.booleans())
    return Modes(
        np.sort(rng.uniform(0.01, 5e4, m)),
        shapes,
        Dofs(node, component, np.array(axis)),
        np.full(m, np.nan) if unknown else rng.uniform(1e-4, 0.2, m),
        np.full(m, np.nan) if draw(st.booleans()) else rng.uniform(1e-6, 1e6, m),
        doubted=rng.random(m) < 0.5,
    )


@settings(max_examples=60, deadline=None)
@given(modes_of_sensors())
def test_modes_come_back_equal_to_the_digits_of_the_format(tmp_path_factory, modes):
    path = tmp_path_factory.mktemp("m") / "m.unv"
    write_universal(path, modes=modes)
    again = read_universal(path).modes
    np.testing.assert_allclose(again.frequencies_hz, modes.frequencies_hz, rtol=1e-7)
    np.testing.assert_allclose(again.damping, modes.damping, rtol=1e-5)
    np.testing.assert_allclose(again.generalized_mass, modes.generalized_mass, rtol=1e-6)
    np.testing.assert_array_equal(again.doubted, modes.doubted)
    expected, found = vectors(modes.dofs, modes.shapes), vectors(again.dofs, again.shapes)
    assert list(found) == list(expected)
    for node in expected:
        largest = np.abs(expected[node]).max(axis=0)
        assert np.all(np.abs(found[node] - expected[node]) <= 2e-5 * largest)


@st.composite
def surveys(draw):
    """Responses with missing combinations, negative and skew directions, even or uneven axes."""
    seed = draw(st.integers(0, 10**6))
    rng = np.random.default_rng(seed)
    n_line = draw(st.integers(1, 9))
    even = draw(st.booleans())
    x = 3.0 + 0.125 * np.arange(n_line) if even else np.sort(rng.uniform(1.0, 500.0, n_line))
    turn = Rotation.random(random_state=seed).as_matrix() if draw(st.booleans()) else np.eye(3)

    def dofs(nodes):
        rows = [(n, c) for n in nodes for c in draw(st.sets(st.integers(1, 6), min_size=1))]
        node, component = np.array(rows).T
        sign = rng.choice([-1.0, 1.0], len(rows))
        return Dofs(node, component, turn[(component - 1) % 3] * sign[:, None])

    responses, references = dofs([1, 2, 3]), dofs([4, 5])
    values = rng.normal(size=(len(responses), len(references), n_line, 2)) @ [1, 1j]
    missing = rng.uniform(size=values.shape[:2]) < 0.2
    missing[:, 0] = missing[0] = False
    values[missing] = np.nan
    quantity = draw(st.sampled_from(["displacement", "velocity", "acceleration"]))
    return Frfs(x, responses, references, values, quantity)


GRID = Geometry([1, 2, 3, 4, 5], np.random.default_rng(0).normal(size=(5, 3)), "m")


@settings(max_examples=60, deadline=None)
@given(surveys(), st.booleans(), st.booleans())
def test_responses_come_back_equal(tmp_path_factory, frfs, binary, single):
    path = tmp_path_factory.mktemp("f") / "f.unv"
    write_universal(path, geometry=GRID, frfs=frfs, binary=binary, single=single)
    content = read_universal(path)
    assert content.skipped == content.warnings == ()
    again = content.frfs
    assert again.quantity == frfs.quantity
    np.testing.assert_allclose(again.frequencies_hz, frfs.frequencies_hz, rtol=1e-7)
    for side in ("responses", "references"):
        found, expected = getattr(again, side), getattr(frfs, side)
        np.testing.assert_array_equal(found.node, expected.node)
        np.testing.assert_array_equal(found.component, expected.component)
        np.testing.assert_allclose(found.axis, expected.axis, atol=1e-12)
    if binary:
        kind = np.complex64 if single else np.complex128
        np.testing.assert_array_equal(again.values, frfs.values.astype(kind))
    else:
        size = np.nanmax(np.abs(frfs.values), axis=None)
        np.testing.assert_allclose(
            again.values, frfs.values, rtol=0, atol=size * (1e-5 if single else 1e-12)
        )


def test_an_even_axis_that_six_digits_cannot_hold(tmp_path):
    """0.01953125 Hz is printed 1.95312E-02 by E13.5: two lines off after 60,000."""
    x = 4.00390625 + 0.01953125 * np.arange(50_000)
    frfs = Frfs(x, Dofs([1], [3]), Dofs([2], [3]), np.ones((1, 1, len(x))))
    write_universal(tmp_path / "f.unv", frfs=frfs, binary=True)
    np.testing.assert_array_equal(read_universal(tmp_path / "f.unv").frfs.frequencies_hz, x)


def test_pyuff_reads_what_we_write(tmp_path):
    rng = np.random.default_rng(3)
    dofs = Dofs(np.repeat([1, 2], 3), [1, 2, 3] * 2)
    modes = Modes([10.0, 20.0], rng.normal(size=(6, 2)), dofs, [0.01, 0.02], [1.0, 2.0])
    values = rng.normal(size=(1, 1, 8, 2)) @ [1, 1j]
    frfs = Frfs(1.0 + 0.5 * np.arange(8), Dofs([1], [3]), Dofs([2], [1]), values)
    for binary in (False, True):
        path = tmp_path / f"{binary}.unv"
        write_universal(path, geometry=GRID, modes=modes, frfs=frfs, binary=binary)
        sets = {s["type"]: s for s in pyuff.UFF(str(path)).read_sets()}
        np.testing.assert_allclose(sets[164]["length"], 1.0)
        np.testing.assert_array_equal(sets[2411]["node_nums"], GRID.ids)
        np.testing.assert_allclose(sets[2411]["x"], GRID.xyz[:, 0], rtol=1e-15)
        np.testing.assert_allclose(sets[55]["r3"], modes.shapes[2::3, 1], rtol=1e-5)
        np.testing.assert_allclose(sets[55]["freq"], 20.0)
        np.testing.assert_allclose(sets[55]["modal_m"], 2.0)
        np.testing.assert_allclose(sets[58]["data"], values[0, 0], rtol=1e-11)
        np.testing.assert_allclose(sets[58]["x"], frfs.frequencies_hz)
        assert (sets[58]["rsp_node"], sets[58]["rsp_dir"], sets[58]["ref_dir"]) == (1, 3, 1)


def test_nodes_as_dataset_15_and_units_of_ones_own(tmp_path):
    own = Units(9, "own", 7.5)
    write_universal(tmp_path / "g.unv", geometry=GRID, units=own, node_dataset=15, description="d")
    content = read_universal(tmp_path / "g.unv")
    np.testing.assert_allclose(content.geometry.xyz, GRID.xyz, rtol=1e-5)
    assert content.units.length_factor == 7.5
    assert content.headers[0].description == "d"
    assert {d.number for d in content.datasets} == {15, 151, 164}


def test_a_file_takes_its_name_only_when_it_is_whole(tmp_path):
    path = tmp_path / "f.unv"
    path.write_text("precious")
    askew = Dofs([1, 1], [1, 2], [[1, 0, 0], [1, 0, 0]])
    with pytest.raises(InputError, match="node 1 has 2 values along axes that contradict"):
        write_universal(path, modes=Modes([1.0], [[1.0], [2.0]], askew))
    assert path.read_text() == "precious"
    assert list(tmp_path.iterdir()) == [path]


def test_what_cannot_be_written_is_refused(tmp_path):
    path = tmp_path / "f.unv"
    with pytest.raises(InputError, match="nothing to write"):
        write_universal(path)
    with pytest.raises(InputError, match="dataset 2411 or 15"):
        write_universal(path, geometry=GRID, node_dataset=781)
    with pytest.raises(InputError, match="'cm' is none of"):
        write_universal(path, geometry=GRID, units="cm")
    with pytest.raises(InputError, match="cannot be written"):
        write_universal(tmp_path / "absent" / "f.unv", geometry=GRID)
    skew = Dofs([1], [1], [[0.6, 0.8, 0.0]])
    frfs = Frfs([1.0], skew, Dofs([2], [1]), np.ones((1, 1, 1)))
    with pytest.raises(InputError, match="need a geometry"):
        write_universal(path, frfs=frfs)
    crooked = Dofs([1, 1], [1, 2], [[0.6, 0.8, 0.0], [1.0, 0.0, 0.0]])
    frfs = Frfs([1.0], crooked, Dofs([2], [1]), np.ones((2, 1, 1)))
    with pytest.raises(InputError, match="axes at node 1 are not orthogonal"):
        write_universal(path, geometry=GRID, frfs=frfs)
    assert list(tmp_path.iterdir()) == []
