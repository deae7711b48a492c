"""OP2 files of every solver and word size: written here word by word, and real ones."""

import importlib.util
import struct
import sys
from pathlib import Path

import numpy as np
import pytest

from trueup.adapters.nastran import describe_results, read_deck, read_matrices, read_modes
from trueup.core.errors import InputError

HERE = Path(__file__).parent
ROOT = Path(__file__).resolve().parents[4]
DATA = ROOT.parent / "shared" / "data" / "nastran"

spec = importlib.util.spec_from_file_location("op2bytes", HERE / "op2bytes.py")
op2bytes = importlib.util.module_from_spec(spec)
sys.modules["op2bytes"] = op2bytes
spec.loader.exec_module(op2bytes)
Writer = op2bytes.Writer

FORMS = [(4, "<"), (4, ">"), (8, "<"), (8, ">")]
POINTS, KINDS = [1, 7, 90000001, 12], [1, 1, 1, 2]
RNG = np.random.default_rng(3)
SHAPES = RNG.normal(size=(3, 4, 6))
SHAPES[:, 3, 1:] = 0.0
OMEGA2 = np.array([4.0e2, 9.0e4, 1.6e7])


def modal_file(
    word, order, name="OUGV1", version="XXXXXXXX", lama=True, label=True, full=False, **header
):
    w = Writer(word, order, full)
    if label:
        w.label(version)
    if lama:  # cycles as NX has them in some files: rad/s
        w.lama(OMEGA2, [2.0, 3.0, 4.0], np.sqrt(OMEGA2))
    records = []
    for k, (value, shape) in enumerate(zip(OMEGA2, SHAPES, strict=True), 1):
        records += [
            [w.vector_header(k, value, cycles=value**0.5, **header)],
            [w.vector(POINTS, KINDS, shape)],
        ]
    w.block(name, (101, 0, 0, 0, 0, 0, 1), records)
    return w.done()


def check(modes, rtol=1e-7):
    np.testing.assert_allclose(modes.frequencies_hz, np.sqrt(OMEGA2) / (2 * np.pi), rtol=rtol)
    order = [0, 1, 2]  # grids increasing, then the scalar point
    grids = SHAPES[:, order].reshape(3, -1).T
    np.testing.assert_allclose(modes.shapes[:18], grids, atol=1e-7)
    np.testing.assert_allclose(modes.shapes[18], SHAPES[:, 3, 0], atol=1e-7)
    assert modes.dofs.node[::6].tolist() == [1, 7, 90000001, 12]


@pytest.mark.parametrize(("word", "order"), FORMS)
def test_words_of_32_and_64_bit_in_both_byte_orders(tmp_path, word, order):
    path = tmp_path / "a.op2"
    path.write_bytes(modal_file(word, order))
    modes = read_modes(path)
    check(modes)
    assert modes.generalized_mass.tolist() == [2.0, 3.0, 4.0]


def test_names_that_fill_words_of_64_bit(tmp_path):
    """As MSC writes them; NX fills half of each word."""
    path = tmp_path / "a.op2"
    path.write_bytes(modal_file(8, "<", full=True))
    check(read_modes(path))


def test_64_bit_keeps_double_precision(tmp_path):
    path = tmp_path / "a.op2"
    path.write_bytes(modal_file(8, "<"))
    assert np.array_equal(read_modes(path).shapes[:6, 0], SHAPES[0, 0])


@pytest.mark.parametrize("name", ["OUGV1", "OUG1", "BOUGV1", "OPHIG", "BOPHIG", "ROUGV1"])
@pytest.mark.parametrize("lama", [True, False])
def test_names_of_the_eigenvectors(tmp_path, name, lama):
    path = tmp_path / "a.op2"
    path.write_bytes(modal_file(4, "<", name, lama=lama))
    modes = read_modes(path)
    check(modes)
    assert np.isnan(modes.generalized_mass).all() != lama
    axes = describe_results(path)["contents"]["modes"][0]["axes"]
    assert (axes == "basic") == name.startswith("B")


@pytest.mark.parametrize("version", ["OS2021.1", "NX2412", "XXXXXXXX", "NE  0824", "V12.1"])
def test_versions_of_the_programs(tmp_path, version):
    path = tmp_path / "a.op2"
    path.write_bytes(modal_file(4, "<", version=version))
    check(read_modes(path))


def test_a_file_without_label(tmp_path):
    path = tmp_path / "a.op2"
    path.write_bytes(modal_file(4, "<", label=False))
    check(read_modes(path))


def test_eigenvalues_left_out_of_the_headers_come_from_the_summary(tmp_path):
    w = Writer()
    w.label()
    w.lama(OMEGA2, [1.0, 1.0, 1.0], np.sqrt(OMEGA2))
    records = []
    for k, shape in enumerate(SHAPES, 1):
        records += [[w.vector_header(k, 0.0)], [w.vector(POINTS, KINDS, shape)]]
    w.block("OUGV1", (101, 0, 0, 0, 0, 0, 1), records)
    path = tmp_path / "a.op2"
    path.write_bytes(w.done())
    check(read_modes(path))


def test_a_long_record_in_parts(tmp_path):
    w = Writer()
    w.label()
    records = []
    for k, (value, shape) in enumerate(zip(OMEGA2, SHAPES, strict=True), 1):
        data = w.vector(POINTS, KINDS, shape)
        records += [[w.vector_header(k, value)], [data[:40], data[40:44], data[44:]]]
    w.block("OUGV1", (101, 0, 0, 0, 0, 0, 1), records)
    path = tmp_path / "a.op2"
    path.write_bytes(w.done())
    check(read_modes(path))


@pytest.mark.parametrize("word", [4, 8])
@pytest.mark.parametrize("form", [2, 3], ids=["real-imaginary", "magnitude-phase"])
def test_complex_modes_are_undamped_hz_one_of_each_pair(tmp_path, word, form):
    """A root -zeta w + i w sqrt(1 - zeta^2) and its conjugate."""
    zeta, omega = 0.03, 2 * np.pi * 12.5
    root = complex(-zeta * omega, omega * np.sqrt(1 - zeta**2))
    shape = SHAPES[0] + 1j * SHAPES[1]
    w = Writer(word)
    w.label()
    records = []
    for k, value in enumerate((root.conjugate(), root), 1):
        phi = shape if value.imag > 0 else shape.conj()
        parts = (phi.real, phi.imag) if form == 2 else (np.abs(phi), np.angle(phi, deg=True))
        head = w.vector_header(k, value, analysis=9, width=14, form=form)
        records += [[head], [w.vector(POINTS, KINDS, np.hstack(parts))]]
    w.block("OUGV1", (101, 0, 0, 0, 0, 0, 1), records)
    path = tmp_path / "a.op2"
    path.write_bytes(w.done())
    modes = read_modes(path)
    np.testing.assert_allclose(modes.frequencies_hz, [12.5], rtol=1e-6)
    np.testing.assert_allclose(modes.damping, [0.03], rtol=1e-5)
    np.testing.assert_allclose(modes.shapes[:18, 0], shape[:3].reshape(-1), atol=1e-6)


def test_superelements_do_not_repeat_modes(tmp_path):
    w = Writer()
    w.label()
    records = []
    for se, rows in ((0, [0, 1]), (10, [1, 2, 3])):
        for k, (value, shape) in enumerate(zip(OMEGA2, SHAPES, strict=True), 1):
            subtitle = f"TEST          SUPERELEMENT {se}" if se else ""
            values = w.vector([POINTS[r] for r in rows], [KINDS[r] for r in rows], shape[rows])
            records += [[w.vector_header(k, value, subtitle=subtitle)], [values]]
    w.block("OUGV1", (101, 0, 0, 0, 0, 0, 1), records)
    path = tmp_path / "a.op2"
    path.write_bytes(w.done())
    modes = read_modes(path)
    assert len(modes) == 3
    check(modes)


def test_basic_vectors_are_preferred_to_those_of_the_grids_systems(tmp_path):
    w = Writer()
    w.label()
    for name, sign in (("OUGV1", -1.0), ("BOUGV1", 1.0)):
        records = []
        for k, (value, shape) in enumerate(zip(OMEGA2, SHAPES, strict=True), 1):
            records += [[w.vector_header(k, value)], [w.vector(POINTS, KINDS, sign * shape)]]
        w.block(name, (101, 0, 0, 0, 0, 0, 1), records)
    path = tmp_path / "a.op2"
    path.write_bytes(w.done())
    check(read_modes(path))


def test_two_runs_in_one_file_are_told_apart_and_refused_as_modes(tmp_path):
    path = tmp_path / "a.op2"
    w = Writer()
    w.out += modal_file(4, "<")[:-12]
    w.out += modal_file(4, "<", label=False)
    path.write_bytes(bytes(w.out))
    told = describe_results(path)["contents"]["modes"]
    assert [t["modes"] for t in told] == [3, 3]
    with pytest.raises(InputError, match="several times"):
        read_modes(path)


@pytest.mark.parametrize(("word", "order"), FORMS)
@pytest.mark.parametrize("kind", [1, 2, 3, 4], ids=["single", "double", "complex", "dcomplex"])
def test_matrices_of_every_type(tmp_path, word, order, kind):
    letter = {1: "f4", 2: "f8", 3: "c8", 4: "c16"}[kind]
    if word == 8 and kind in (1, 3):
        letter = {1: "f8", 3: "c16"}[kind]
    dense = RNG.normal(size=(5, 4)) + (1j * RNG.normal(size=(5, 4)) if kind > 2 else 0.0)
    dense[2] = 0.0
    dense[:, 1] = 0.0
    w = Writer(word, order)
    w.label()

    def packed(values):
        return np.asarray(values).astype(order + letter).tobytes()

    columns = [
        [(1, packed(dense[:2, j])), (4, packed(dense[3:, j]))] if j != 1 else [] for j in range(4)
    ]
    w.matrix("PHIX", (101, 4, 5, 2, kind, 0, 0), columns)
    path = tmp_path / "a.op2"
    path.write_bytes(w.done())
    (matrix,) = read_matrices(path)
    assert matrix.name == "PHIX"
    assert matrix.matrix.nnz == 12
    np.testing.assert_allclose(matrix.matrix.toarray(), dense, rtol=1e-6)
    assert describe_results(path)["contents"]["matrices"] == {"PHIX": "5 x 4"}


@pytest.mark.parametrize("word", [4, 8])
@pytest.mark.parametrize("wide", [False, True], ids=["single", "double"])
def test_dmig_of_a_matpool_names_its_degrees_of_freedom(tmp_path, word, wide):
    """``PARAM,EXTOUT,DMIGOP2``: upper triangle of a symmetric matrix on three dofs."""
    w = Writer(word)
    w.label()

    def value(number):
        double = wide or word == 8
        return struct.pack("<d" if double else "<f", number)

    entries = {(1, 1): [((1, 1), 2.0)], (1, 3): [((1, 1), -1.5), ((1, 3), 4.0)],
               (22, 0): [((22, 0), 7.0)]}  # fmt: skip
    body = b"".join(map(w.int, (114, 1, 120))) + w.text("KAAX", 2)
    body += b"".join(map(w.int, (0, 6, 2 if wide else 1, 0, 0, 0, 0)))
    for (gj, cj), column in entries.items():
        body += w.int(gj) + w.int(cj)
        for (gi, ci), number in column:
            body += w.int(gi) + w.int(ci) + value(number)
        body += w.int(-1) * 2
    body += w.int(-1) * 2
    w.block("MATPOOL", (104, 32768, 0, 0, 0, 0, 0), [[body]])
    path = tmp_path / "a.op2"
    path.write_bytes(w.done())
    (matrix,) = read_matrices(path)
    assert matrix.name == "KAAX"
    assert list(zip(matrix.rows.point, matrix.rows.component, strict=True)) == [
        (1, 1), (1, 3), (22, 0),
    ]  # fmt: skip
    assert matrix.matrix.toarray().tolist() == [[2, -1.5, 0], [-1.5, 4, 0], [0, 0, 7]]


@pytest.mark.skipif(not DATA.is_dir(), reason=f"no shared data beside {ROOT.name}")
@pytest.mark.parametrize(
    "name",
    ["svanberg_beam/modes", "beam_pairs/beam_modes_m1", "plate/plate_py",
     "solid_shell_bar/mode_solid_shell_bar", "mast/pn_mwe_s-solution_1", "space_truss/full",
     "all_elements/modes_elements"],
)  # fmt: skip
def test_real_files_against_pynastran(name):
    """An independent reader: shapes and eigenvalues to the last bit."""
    import warnings

    pytest.importorskip("pyNastran")
    from cpylog import SimpleLogger
    from pyNastran.op2.op2 import OP2

    path = DATA / f"{name}.op2"
    other = OP2(log=SimpleLogger("critical", log_func=lambda *_: None))
    other.include_exclude_results(include_results=["eigenvectors"])
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        other.read_op2(str(path), build_dataframe=False)
    (theirs,) = other.eigenvectors.values()
    rows = np.flatnonzero(theirs.node_gridtype[:, 1] == 1)
    order = rows[np.argsort(theirs.node_gridtype[rows, 0], kind="stable")]
    ours = read_modes(path)
    n = 6 * len(order)
    expected = np.moveaxis(theirs.data[:, order], 0, 2).reshape(n, -1)
    assert np.array_equal(ours.shapes[:n], expected.astype(np.float64))
    hz = np.sqrt(np.abs(np.asarray(theirs.eigns, float))) / (2 * np.pi)
    np.testing.assert_allclose(ours.frequencies_hz, hz, rtol=1e-12)


@pytest.mark.skipif(not DATA.is_dir(), reason=f"no shared data beside {ROOT.name}")
def test_real_matrices_against_pynastran():
    import warnings

    pytest.importorskip("pyNastran")
    from cpylog import SimpleLogger
    from pyNastran.op2.op2 import OP2

    path = DATA / "solid_shell_bar" / "static_solid_shell_bar_kelm.op2"
    other = OP2(log=SimpleLogger("critical", log_func=lambda *_: None))
    other.include_exclude_results(include_results=["eqexin"])
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        other.read_op2(str(path), build_dataframe=False)
    deck = read_deck(path.with_suffix(".bdf"))
    for matrix in read_matrices(path, deck):
        theirs = other.matrices[matrix.name].data
        theirs = theirs.toarray() if hasattr(theirs, "toarray") else np.asarray(theirs)
        mine = matrix.matrix.toarray()
        if matrix.form == 6:
            theirs = np.where(theirs == 0, theirs.T, theirs)
        assert np.array_equal(mine, theirs)


def test_only_some_modes_are_read(tmp_path):
    path = tmp_path / "a.op2"
    path.write_bytes(modal_file(4, "<"))
    some = read_modes(path, modes=[3, 1])
    whole = read_modes(path)
    assert some.frequencies_hz.tolist() == whole.frequencies_hz[[0, 2]].tolist()
    assert np.array_equal(some.shapes, whole.shapes[:, [0, 2]])
    assert some.generalized_mass.tolist() == [2.0, 4.0]
    with pytest.raises(InputError, match="none of the modes 9"):
        read_modes(path, modes=[9])


@pytest.mark.skipif(not DATA.is_dir(), reason=f"no shared data beside {ROOT.name}")
@pytest.mark.parametrize("name", ["modes.h5", "modes.op2", "modes.f06"])
def test_only_some_modes_of_every_kind_of_file(name):
    path = DATA / "svanberg_beam" / name
    some, whole = read_modes(path, modes=[2, 5]), read_modes(path)
    assert np.array_equal(some.shapes, whole.shapes[:, [1, 4]])
    assert np.array_equal(some.frequencies_hz, whole.frequencies_hz[[1, 4]])


@pytest.mark.parametrize("double", [False, True])
def test_displacement_systems_that_the_file_tells_of_need_the_deck(tmp_path, double):
    """GEOM1 of the same file; positions of one word (MSC) or two (newer files)."""
    for systems, name, refused in (
        ([0, 5, 0, 0], "OUGV1", True), ([0, 5, 0, 0], "BOUGV1", False), ([0] * 4, "OUGV1", False),
    ):  # fmt: skip
        w = Writer()
        w.label()
        grids = struct.pack("<3i", 4501, 45, 1)
        for point, cd in zip(sorted(POINTS), systems, strict=True):
            grids += struct.pack("<2i3d3i" if double else "<2i3f3i", point, 0, 1, 2, 3, cd, 0, 0)
        w.block("GEOM1", (101, 0, 0, 0, 0, 0, 0), [[grids]])
        w.out += modal_file(4, "<", name, label=False)
        path = tmp_path / "a.op2"
        path.write_bytes(w.done())
        if refused:
            with pytest.raises(InputError, match="grid 7 has a displacement system of its own"):
                read_modes(path)
        else:
            check(read_modes(path))


def test_modes_sorted_by_points_are_listed_as_not_read(tmp_path):
    w = Writer()
    w.label()
    head = bytearray(w.vector_header(1, 4.0))
    head[4:8] = struct.pack("<i", 2007)
    w.block("OUGV2", (101, 0, 0, 0, 0, 0, 1), [[bytes(head)], [w.vector([1], [1], [[0.0] * 6])]])
    path = tmp_path / "a.op2"
    path.write_bytes(w.done())
    (skipped,) = describe_results(path)["skipped"]
    assert (skipped["what"], "SORT1" in skipped["why"]) == ("OUGV2", True)
    with pytest.raises(InputError, match="no eigenvectors"):
        read_modes(path)


def test_a_matrix_of_zeros_and_one_of_many_runs(tmp_path):
    w = Writer()
    w.label()
    w.matrix("NULL", (101, 3, 5, 2, 2, 0, 0), [[], [], []])
    rows = np.arange(1, 4000, 2)
    values = RNG.normal(size=len(rows))
    runs = [(int(r), struct.pack("<d", v)) for r, v in zip(rows, values, strict=True)]
    w.matrix("LONG", (102, 3, 4000, 2, 2, 0, 0), [[], runs, []])
    path = tmp_path / "a.op2"
    path.write_bytes(w.done())
    long, null = read_matrices(path)
    assert (null.name, null.matrix.shape, null.matrix.nnz) == ("NULL", (5, 3), 0)
    assert np.array_equal(long.matrix.toarray()[rows - 1, 1], values)
    assert long.matrix.nnz == len(rows)
