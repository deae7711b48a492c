"""Real files of many vendors: everything is read, or listed with its line and why it was not."""

import warnings
from collections import Counter

import numpy as np
import pytest
import pyuff

from trueup.adapters.universal import read_test, read_universal
from trueup.core.errors import InputError

CASES = {
    "duct": (70, 24, 71),
    "panel_parameters": (40, 14, 40),
    "panel_spring": (40, 14, 40),
    "panel_stiffness": (40, 14, 40),
    "tower_frame": (20, 14, 40),
    "tower_joint": (20, 14, 40),
    "wheel_faults": (45, 20, 45),
    "wheel_mass": (44, 20, 44),
}
FILES = {
    "2411 and 2414.uff": {151: 1, 2411: 1, 2412: 1, 2414: 10},
    "TestLab 161 164 18 15 82.uff": {151: 1, 164: 1, 18: 1, 82: 3, 15: 1},
    "dataset15.unv": {15: 1},
    "dataset2411.unv": {2411: 1},
    "dataset55.unv": {55: 1},
    "garteur_ds55_aster.unv": {151: 1, 55: 21},
    "garteur_geometry.unv": {151: 1, 164: 1, 15: 1, 82: 1},
    "garteur_frf_1995.uff": {58: 24},
    "groups_test.uff": {164: 1, 2420: 1, 2411: 1, 2412: 1, 2467: 1},
    "uff55_translation.uff": {55: 3},
    "uff55_translation_rotation.uff": {55: 1},
    "zzzz176a.msup": {18: 1, 15: 1, 82: 38, 55: 10},
    "non_ascii_header.uff": {58: 1},
    "Sample_UFF58_ascii.uff": {58: 1},
    "Sample_UFF58b_bin.uff": {58: 1},
    "measurement.uff": {58: 1},
    "measurement_binary.uff": {58: 1},
    **{f"dataset58_case{k}_{how}.unv": {58: 1} for k in (1, 2, 3, 4, 5, 7)
       for how in ("ascii", "binary")},
}  # fmt: skip


@pytest.mark.parametrize("name", FILES)
def test_every_dataset_is_found_and_nothing_else_is_skipped(data, name):
    content = read_universal(data / "uff" / name)
    assert Counter(d.number for d in content.datasets) == FILES[name]
    assert [s.what for s in content.skipped] == (
        ["dataset 2467 (permanent groups)"] if name == "groups_test.uff" else []
    )


@pytest.mark.parametrize("name", FILES)
def test_any_line_end_gives_the_same(data, name, tmp_path):
    original = (data / "uff" / name).read_bytes()
    if b"58b" in original:
        pytest.skip("binary")
    first = read_universal(data / "uff" / name)
    for end in (b"\r\n", b"\r"):
        (tmp_path / "copy.unv").write_bytes(original.replace(b"\r\n", b"\n").replace(b"\n", end))
        again = read_universal(tmp_path / "copy.unv")
        assert [d.line for d in again.datasets] == [d.line for d in first.datasets]
        if first.geometry is not None:
            np.testing.assert_array_equal(again.geometry.xyz, first.geometry.xyz)
        if first.modes is not None:
            np.testing.assert_array_equal(again.modes.shapes, first.modes.shapes)
        if first.frfs is not None:
            np.testing.assert_array_equal(again.frfs.values, first.frfs.values)
        for f, g in zip(first.functions, again.functions, strict=True):
            np.testing.assert_array_equal(f.values, g.values)


@pytest.mark.parametrize("name", [n for n, d in FILES.items() if 58 in d])
def test_functions_equal_those_of_pyuff(data, name):
    content = read_universal(data / "uff" / name)
    sets = pyuff.UFF(str(data / "uff" / name)).read_sets()
    for k, s in enumerate(sets if isinstance(sets, list) else [sets]):
        if content.frfs is None:
            x, y = content.functions[k].abscissa, content.functions[k].values
        else:
            x, y = content.frfs.frequencies_hz, content.frfs.values[k, 0]
        n = s["num_pts"]  # pyuff adds the zeros that pad the last line
        assert len(y) == n
        np.testing.assert_array_equal(y, s["data"][:n])
        np.testing.assert_array_equal(x, s["x"][:n])


@pytest.mark.parametrize(
    "name", ["uff55_translation.uff", "zzzz176a.msup", "uff55_translation_rotation.uff"]
)
def test_shapes_equal_those_of_pyuff(data, name):
    modes = read_universal(data / "uff" / name).modes
    file = pyuff.UFF(str(data / "uff" / name))
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        sets = [file.read_sets(int(k)) for k in np.flatnonzero(file.get_set_types() == 55)]
    for k, s in enumerate(sets):
        rows = np.column_stack([s[f"r{c}"] for c in range(1, s["n_data_per_node"] + 1)])
        np.testing.assert_array_equal(modes.shapes[:, k], rows.ravel())
        assert modes.frequencies_hz[k] == s["freq"]


def test_complex_mode_of_its_eigenvalue(data):
    modes = read_universal(data / "uff" / "dataset55.unv").modes
    pole = complex(-0.90604, 25.08)
    assert modes.frequencies_hz[0] == pytest.approx(abs(pole) / (2 * np.pi))
    assert modes.damping[0] == pytest.approx(0.90604 / abs(pole))
    assert modes.shapes[0, 0] == 2.2180e-07 + 1.7824e-06j


def test_announced_and_held_points_that_differ_are_told(data):
    content = read_universal(data / "uff" / "dataset_milestone_in_header.uff")
    assert content.functions == ()
    assert content.skipped[0].line == 2
    assert "announces 2508876 numbers" in content.skipped[0].why


def test_a_mesh_that_is_no_universal_file_is_refused(data):
    with pytest.raises(InputError, match="not a universal file"):
        read_universal(data / "uff" / "garteur_test_geometry_aster.mail")


def test_testlab_displacement_systems(data):
    """SYS7: x along +z, xz plane towards -y of the origin, so y points to -x."""
    content = read_universal(data / "uff" / "TestLab 161 164 18 15 82.uff")
    np.testing.assert_allclose(
        content.systems[7].axes, [[0, 0, 1], [-1, 0, 0], [0, -1, 0]], atol=1e-6
    )
    assert content.length_unit == "m"
    assert len(content.geometry.elements["line"]) == 30


def test_garteur_survey_with_its_geometry(data):
    folder = data / "uff"
    test = read_test([folder / "garteur_frf_1995.uff", folder / "garteur_geometry.unv"])
    assert test.frfs.values.shape == (24, 1, 3124)
    assert np.isfinite(test.frfs.values).all()
    np.testing.assert_allclose(test.frfs.frequencies_hz[[0, -1]], [4.0039, 65.0], atol=2e-2)
    np.testing.assert_array_equal(test.frfs.references.axis, [[0, 0, -1]])  # direction -3


def test_duct_survey_in_cylindrical_axes(data):
    content = read_universal(data / "cases" / "duct" / "duct_frf.unv")
    frfs, geometry = content.frfs, content.geometry
    assert frfs.values.shape == (71, 3, 2160)
    assert np.isfinite(frfs.values).all()
    assert frfs.quantity == "acceleration"
    rows = geometry.index_of(frfs.responses.node)
    radius = geometry.xyz[rows] * [1, 1, 0]
    radius /= np.linalg.norm(radius, axis=1)[:, None]
    radial = frfs.responses.component == 1
    np.testing.assert_allclose(frfs.responses.axis[radial], radius[radial], atol=1e-12)
    np.testing.assert_array_equal(frfs.responses.node[~radial], [68, 69, 70, 5])
    np.testing.assert_array_equal(frfs.responses.axis[~radial], [[0, 0, 1]] * 4)
    assert len(content.skipped) == 9  # three responses were measured twice for each reference


@pytest.mark.parametrize("name", CASES)
def test_cases(data, name):
    n_node, n_mode, n_dof = CASES[name]
    stem = name.split("_")[0]
    test = read_test(data / "cases" / name / f"{stem}_test.unv")
    assert test.length_unit == "m"
    assert test.warnings == ()
    assert len(test.geometry.ids) == n_node
    assert test.modes.shapes.shape == (n_dof, n_mode)
    np.testing.assert_allclose(np.linalg.norm(test.modes.dofs.axis, axis=1), 1.0, atol=1e-12)


def test_duct_was_measured_along_its_radius(data):
    test = read_test(data / "cases" / "duct" / "duct_test.unv")
    radius = test.geometry.xyz[test.geometry.index_of(test.modes.dofs.node)] * [1, 1, 0]
    radius /= np.linalg.norm(radius, axis=1)[:, None]
    along = np.abs(np.sum(radius * test.modes.dofs.axis, axis=1))
    axial = np.abs(test.modes.dofs.axis[:, 2])
    assert np.count_nonzero(along > 1 - 1e-4) == 67  # positions are off by a millimetre
    np.testing.assert_array_equal(test.modes.dofs.node[axial > 1 - 1e-9], [5, 68, 69, 70])


def test_mutations_end_in_content_or_one_sentence(data, tmp_path):
    """Damage of every kind: bytes, lines, cuts. Nothing but an InputError may come out."""
    rng = np.random.default_rng(7)
    names = [n for n in FILES if (data / "uff" / n).stat().st_size < 60_000]
    for k in range(400):
        raw = bytearray((data / "uff" / names[k % len(names)]).read_bytes())
        at = int(rng.integers(len(raw)))
        match int(rng.integers(6)):
            case 0:
                raw = raw[:at]
            case 1:
                del raw[at : at + int(rng.integers(1, 90))]
            case 2:
                raw[at:at] = rng.bytes(int(rng.integers(1, 20)))
            case 3:
                raw[at] = int(rng.integers(256))
            case 4:
                lines = raw.split(b"\n")
                lines[int(rng.integers(len(lines)))] = [b"", b"    -1", b" NaN", b"****"][k % 4]
                raw = bytearray(b"\n".join(lines))
            case _:
                lines = raw.split(b"\n")
                lines.insert(int(rng.integers(len(lines))), lines[int(rng.integers(len(lines)))])
                raw = bytearray(b"\n".join(lines))
        path = tmp_path / "mutated.unv"
        path.write_bytes(bytes(raw))
        try:
            read_universal(path)
        except InputError as error:
            assert "\n" not in str(error)  # noqa: PT017
