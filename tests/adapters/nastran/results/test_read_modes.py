"""Analysis modes from real result files: frequencies as printed, shapes in basic axes."""

from pathlib import Path

import h5py
import numpy as np
import pytest

from trueup.adapters.nastran import describe_results, read_deck, read_modes
from trueup.core.errors import InputError

ROOT = Path(__file__).resolve().parents[4]
DATA = ROOT.parent / "shared" / "data" / "nastran"
MYSTRAN = Path(__file__).parent / "mystran"

needs_data = pytest.mark.skipif(not DATA.is_dir(), reason=f"no shared data beside {ROOT.name}")

# Elastic frequencies [Hz] that the runs printed in their F06 files.
PRINTED = {
    "svanberg_beam/modes.op2": (46.46440, 146.9333, 279.0229, 752.9903, 815.3514, 882.3479),
    "svanberg_beam/modes.h5": (46.46440, 146.9333, 279.0229, 752.9903, 815.3514, 882.3479),
    "solid_shell_bar/mode_solid_shell_bar.op2": (71.26832, 75.95746, 125.7872),
    "beam_pairs/beam_modes_m1.op2": (
        456.66034, 456.66034, 2674.5874, 2674.5874, 3554.923, 4507.487, 6626.104, 6626.104,
        11111.585, 11111.585,
    ),
    "truss_72/modes.h5": (
        25.4556972, 25.4556972, 38.9408873, 68.5553469, 73.7051961, 73.7051961, 111.0226695,
        127.6246758, 136.6591031, 136.6591031,
    ),
    "ten_bar/modes.h5": (8.9495006, 26.956565, 27.2502208, 49.9307098),
    "frame/noreduction-000.h5": (
        0.1987976, 0.3974492, 0.7054771, 0.8603456, 1.7179692, 1.9808505, 2.1998635,
    ),
    "cantilever/noReduction.h5": (349.7287883, 2167.3241495, 6007.8033593),
    "cantilever/guyanReduction.h5": (359.0737719, 2934.1003275),
    "plate/plate_py.op2": (6333.012, 7495.461, 16238.46, 17161.51),
    "mast/pn_mwe_s-solution_1.op2": (89.56075, 89.56075, 1044.7596),
    "space_truss/full.op2": (
        1.69880, 1.76749, 1.85772, 3.41961, 7.02421, 7.02541, 10.7236, 10.9825, 13.8668, 14.3899,
    ),
}  # fmt: skip


@needs_data
@pytest.mark.parametrize("name", PRINTED)
def test_frequencies_are_those_the_run_printed(name):
    modes = read_modes(DATA / name)
    elastic = modes.frequencies_hz[modes.frequencies_hz > 0.05]
    printed = np.array(PRINTED[name])
    np.testing.assert_allclose(elastic[: len(printed)], printed, rtol=5e-6)  # six digits


@needs_data
def test_op2_and_hdf5_of_one_run_agree():
    op2 = read_modes(DATA / "svanberg_beam" / "modes.op2")
    hdf5 = read_modes(DATA / "svanberg_beam" / "modes.h5")
    assert np.array_equal(op2.dofs.node, hdf5.dofs.node)
    assert np.array_equal(op2.dofs.component, hdf5.dofs.component)
    np.testing.assert_allclose(op2.shapes, hdf5.shapes, atol=2e-7 * np.abs(hdf5.shapes).max())


@needs_data
def test_shapes_are_those_the_run_printed():
    lines = (DATA / "svanberg_beam" / "modes.f06").read_text(encoding="latin-1").splitlines()
    start = next(k for k, s in enumerate(lines) if "R E A L   E I G E N V E C T O R   N O" in s)
    rows = [s.split() for s in lines[start : start + 12]]
    printed = np.array([[float(w) for w in r[2:8]] for r in rows if len(r) == 8 and r[1] == "G"])
    modes = read_modes(DATA / "svanberg_beam" / "modes.h5")
    assert printed.shape == (6, 6)
    np.testing.assert_allclose(modes.shapes[:, 0].reshape(6, 6), printed, atol=1e-6)


@needs_data
def test_generalized_masses_of_max_normalised_modes():
    modes = read_modes(DATA / "beam_pairs" / "beam_modes_m1.op2")
    np.testing.assert_allclose(
        modes.generalized_mass[:3], [0.00871917, 0.00871917, 0.01714052], 1e-5
    )


@needs_data
def test_generalized_masses_are_unknown_without_lama():
    modes = read_modes(DATA / "plate" / "plate_py.op2")
    assert np.isnan(modes.generalized_mass).all()


@needs_data
def test_scalar_points_come_last_with_one_component():
    modes = read_modes(
        DATA / "all_elements" / "modes_elements.h5",
        read_deck(DATA / "all_elements" / "modes_elements.bdf"),
    )
    assert modes.dofs.node[-3:].tolist() == [100, 101, 102]
    assert modes.dofs.component[-3:].tolist() == [1, 1, 1]
    assert (np.diff(modes.dofs.node[:-3]) >= 0).all()


def test_displacement_systems_are_turned_to_basic_axes():
    """MYSTRAN's run of one plate, its grids with cylindrical and skew systems or with none."""
    basic = read_modes(MYSTRAN / "basic.op2", read_deck(MYSTRAN / "basic.dat"))
    turned = read_modes(MYSTRAN / "turned.op2", read_deck(MYSTRAN / "turned.dat"))
    np.testing.assert_allclose(turned.frequencies_hz, basic.frequencies_hz, rtol=1e-6)
    moved = basic.dofs.component <= 3  # MYSTRAN leaves the drilling rotations open
    a, b = basic.shapes[moved], turned.shapes[moved]
    b = b * np.sign(np.sum(a * b, axis=0))
    np.testing.assert_allclose(b, a, atol=3e-7 * np.abs(a).max())


def test_the_last_check_would_fail_without_the_deck():
    basic = read_modes(MYSTRAN / "basic.op2")
    turned = read_modes(MYSTRAN / "turned.op2")
    moved = basic.dofs.component <= 3
    a, b = np.abs(basic.shapes[moved]), np.abs(turned.shapes[moved])
    assert np.abs(a - b).max() > 0.3 * a.max()


DOMAIN = [
    ("ID", int), ("SUBCASE", int), ("STEP", int), ("ANALYSIS", int), ("TIME_FREQ_EIGR", float),
    ("EIGI", float), ("MODE", int), ("SE", int),
]  # fmt: skip
NAMES = ("X", "Y", "Z", "RX", "RY", "RZ")


def write_hdf5(path, domains, blocks, cd=0, grids=(1, 2)):
    """A result file as Nastran lays it out: `blocks` are {domain: {point: six values}}."""
    is_complex = any(np.iscomplexobj(v) for b in blocks.values() for v in b.values())
    names = [f"{n}{p}" for n in NAMES for p in "RI"] if is_complex else list(NAMES)
    kind = [("ID", int), *[(n, float) for n in names], ("DOMAIN_ID", int)]
    rows = []
    for domain, points in blocks.items():
        for point, values in points.items():
            parts = [[v.real, v.imag] if is_complex else [v] for v in values]
            rows.append((point, *[x for p in parts for x in p], domain))
    with h5py.File(path, "w") as file:
        file["NASTRAN/RESULT/DOMAINS"] = np.array(domains, DOMAIN)
        suffix = "_CPLX" if is_complex else ""
        file[f"NASTRAN/RESULT/NODAL/EIGENVECTOR{suffix}"] = np.array(rows, kind)
        file["NASTRAN/INPUT/NODE/GRID"] = np.array(
            [(g, cd) for g in grids], [("ID", int), ("CD", int)]
        )
    return path


def lam(hz):
    return (2.0 * np.pi * hz) ** 2


def test_superelements_are_put_together_and_modes_not_repeated(tmp_path):
    path = write_hdf5(
        tmp_path / "a.h5",
        [(1, 1, 0, 2, lam(5.0), 0, 1, 0), (2, 1, 0, 2, lam(7.0), 0, 2, 0),
         (3, 1, 0, 2, lam(5.0), 0, 1, 10), (4, 1, 0, 2, lam(7.0), 0, 2, 10)],
        {
            1: {2: np.full(6, 2.0)}, 2: {2: np.full(6, 4.0)},
            3: {1: np.full(6, 1.0), 2: np.full(6, 2.0)},
            4: {1: np.full(6, 3.0), 2: np.full(6, 4.0)},
        },
    )  # fmt: skip
    modes = read_modes(path)
    np.testing.assert_allclose(modes.frequencies_hz, [5.0, 7.0])
    assert modes.dofs.node.tolist() == [1] * 6 + [2] * 6
    assert modes.shapes.tolist() == [[1.0, 3.0]] * 6 + [[2.0, 4.0]] * 6


def test_superelements_with_modes_of_their_own_are_refused(tmp_path):
    path = write_hdf5(
        tmp_path / "a.h5",
        [(1, 1, 0, 2, lam(5.0), 0, 1, 0), (2, 1, 0, 2, lam(9.0), 0, 1, 10)],
        {1: {2: np.ones(6)}, 2: {1: np.ones(6)}},
    )
    with pytest.raises(InputError, match="superelements 0 and 10 hold different modes"):
        read_modes(path)


def test_complex_modes_have_damping_and_lose_their_conjugates(tmp_path):
    root = 2.0 * np.pi * 8.0 * (-0.02 + 1j * np.sqrt(1.0 - 0.02**2))
    shape = np.array([1.0, 2.0j, 0.0, 0.0, 0.0, 1.0 + 1.0j])
    path = write_hdf5(
        tmp_path / "a.h5",
        [(1, 1, 0, 9, root.real, -root.imag, 1, 0), (2, 1, 0, 9, root.real, root.imag, 2, 0)],
        {1: {1: shape.conj()}, 2: {1: shape}},
    )
    modes = read_modes(path)
    np.testing.assert_allclose(modes.frequencies_hz, [8.0])
    np.testing.assert_allclose(modes.damping, [0.02])
    np.testing.assert_allclose(modes.shapes[:, 0], shape)


def test_rigid_body_modes_with_negative_eigenvalues_have_small_frequencies(tmp_path):
    path = write_hdf5(tmp_path / "a.h5", [(1, 1, 0, 2, -1e-4, 0, 1, 0)], {1: {1: np.ones(6)}})
    np.testing.assert_allclose(read_modes(path).frequencies_hz, [1e-2 / (2.0 * np.pi)])


def test_several_subcases_are_not_guessed(tmp_path):
    path = write_hdf5(
        tmp_path / "a.h5",
        [(1, 1, 0, 2, lam(5.0), 0, 1, 0), (2, 2, 0, 2, lam(9.0), 0, 1, 0)],
        {1: {1: np.ones(6)}, 2: {1: np.ones(6)}},
    )
    with pytest.raises(InputError, match="subcases 1, 2: say which"):
        read_modes(path)
    np.testing.assert_allclose(read_modes(path, subcase=2).frequencies_hz, [9.0])
    with pytest.raises(InputError, match="no modes of subcase 3"):
        read_modes(path, subcase=3)
    (tmp_path / "deck.bdf").write_text(
        "SOL 103\nCEND\nSUBCASE 2\nMETHOD=1\nBEGIN BULK\nEIGRL,1,,,1\nGRID,1\nGRID,2\nENDDATA\n"
    )
    deck = read_deck(tmp_path / "deck.bdf")
    np.testing.assert_allclose(read_modes(path, deck).frequencies_hz, [9.0])


def test_an_hdf5_file_with_displacement_systems_asks_for_the_deck(tmp_path):
    path = write_hdf5(
        tmp_path / "a.h5", [(1, 1, 0, 2, lam(5.0), 0, 1, 0)], {1: {1: np.ones(6)}}, cd=3
    )
    with pytest.raises(InputError, match="grid 1 has a displacement system"):
        read_modes(path)


def test_results_of_another_deck_are_refused(tmp_path):
    path = write_hdf5(
        tmp_path / "a.h5", [(1, 1, 0, 2, lam(5.0), 0, 1, 0)], {1: {99: np.ones(6)}}, grids=(99,)
    )
    with pytest.raises(InputError, match="point 99, which the deck does not have"):
        read_modes(path, read_deck(MYSTRAN / "basic.dat"))


def test_shapes_that_are_not_finite_are_refused(tmp_path):
    path = write_hdf5(
        tmp_path / "a.h5", [(1, 1, 0, 2, lam(5.0), 0, 1, 0)], {1: {1: np.full(6, np.nan)}}
    )
    with pytest.raises(InputError, match="not finite"):
        read_modes(path)


@pytest.mark.parametrize("keep", [0, 4, *range(50, 10000, 250)])
def test_an_op2_cut_short_is_one_clear_sentence(tmp_path, keep):
    whole = (MYSTRAN / "basic.op2").read_bytes()
    path = tmp_path / "a.op2"
    path.write_bytes(whole[:keep])
    with pytest.raises(InputError) as error:
        read_modes(path)
    assert "a.op2" in str(error.value)
    assert "\n" not in str(error.value)


@pytest.mark.parametrize("content", [b"", b"hello" * 100, b"\x89HDF\r\n\x1a\n" + b"x" * 50])
def test_a_file_of_another_kind_is_one_clear_sentence(tmp_path, content):
    path = tmp_path / "a.op2"
    path.write_bytes(content)
    with pytest.raises(InputError) as error:
        read_modes(path)
    assert "a.op2" in str(error.value)
    assert "\n" not in str(error.value)


def test_hdf5_of_another_kind(tmp_path):
    with h5py.File(tmp_path / "a.h5", "w") as file:
        file["x"] = 1
    with pytest.raises(InputError, match="not a result file of Nastran"):
        read_modes(tmp_path / "a.h5")
    (tmp_path / "a.h5").write_text("junk")
    with pytest.raises(InputError, match=r"a\.h5 is not an HDF5 file"):
        read_modes(tmp_path / "a.h5")


def test_a_file_that_is_not_there(tmp_path):
    with pytest.raises(InputError, match=r"cannot read .*a\.op2"):
        read_modes(tmp_path / "a.op2")


@needs_data
@pytest.mark.parametrize(
    "name", ["solid_shell_bar/static_solid_shell_bar_kelm.op2", "cantilever/full.h5"]
)
def test_a_file_without_modes_says_what_it_holds(name):
    with pytest.raises(InputError, match="holds no eigenvectors"):
        read_modes(DATA / name)


def test_describing_a_file():
    told = describe_results(MYSTRAN / "basic.op2")
    assert told["format"] == "Nastran OP2"
    (modes,) = told["contents"]["modes"]
    assert (modes["modes"], modes["grids"], modes["complex"]) == (6, 24, False)
    assert told["skipped"] == []


@needs_data
def test_describing_names_what_is_not_read():
    told = describe_results(DATA / "svanberg_beam" / "modes.op2")
    assert "GEOM1" in [s["what"] for s in told["skipped"]]
    assert "OUG1" not in [s["what"] for s in told["skipped"]]
