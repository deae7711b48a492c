"""``trueup inspect`` and ``trueup convert`` as a user calls them."""

from __future__ import annotations

import json
import shutil
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
import scipy.sparse as sp

from trueup.adapters.nastran import (
    DofMap,
    NastranMatrix,
    read_deck,
    read_matrices,
    read_modes,
    write_dmig,
    write_op4,
)
from trueup.adapters.store import read_store, write_store
from trueup.adapters.universal import read_universal, write_universal
from trueup.cli.app import run
from trueup.core.data.dofs import Dofs
from trueup.core.data.frfs import Frfs
from trueup.core.data.geometry import Geometry
from trueup.core.data.modes import Modes
from trueup.verbs.files.read import kind_of_file

DATA = Path(__file__).parents[3] / "shared" / "data"
KINDS = {
    ".bdf": "deck", ".dat": "deck", ".blk": "deck", ".inc": "deck", ".asm": "deck",
    ".op2": "results", ".h5": "results", ".f06": "results", ".op4": "op4", ".pch": "punch",
    ".pch1": "punch", ".unv": "universal", ".uff": "universal", ".msup": "universal",
}  # fmt: skip
NOT_KNOWN = {".json", ".md", ".mail", ""}

Call = Callable[..., tuple[int, str, str]]


@pytest.fixture
def trueup(monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> Call:
    def call(*words: object) -> tuple[int, str, str]:
        monkeypatch.setattr("sys.argv", ["trueup", *map(str, words)])
        status = run()
        said = capsys.readouterr()
        return status, said.out, said.err

    return call


@pytest.fixture
def data() -> Path:
    if not DATA.is_dir():
        pytest.skip(f"the shared data is not at {DATA}")
    return DATA


def geometry() -> Geometry:
    return Geometry(
        np.array([1, 2, 5]), np.array([[0.0, 0, 0], [1, 0, 0], [1, 2, 0]]), "m",
        {"line": np.array([[0, 1], [1, 2]])}, {"line": np.array([10, 11])},
    )  # fmt: skip


def modes() -> Modes:
    dofs = Dofs(np.repeat([1, 2, 5], 6), np.tile(np.arange(1, 7), 3))
    shapes = np.random.default_rng(2).standard_normal((18, 2)).round(3)
    return Modes(np.array([3.5, 12.25]), shapes, dofs, np.array([0.01, 0.02]), np.ones(2), "t")


def frfs() -> Frfs:
    rng = np.random.default_rng(3)
    values = rng.standard_normal((2, 1, 5)) + 1j * rng.standard_normal((2, 1, 5))
    return Frfs(
        np.arange(5) * 0.5 + 1, Dofs(np.array([1, 2]), np.array([3, 3])),
        Dofs(np.array([5]), np.array([1])), values,
    )  # fmt: skip


def stiffness() -> NastranMatrix:
    rows = DofMap(np.array([3, 3, 90]), np.array([1, 5, 0]))
    A = np.array([[2.0, -1.0, 0.0], [-1.0, 3.0, 0.5], [0.0, 0.5, 1.0]])
    return NastranMatrix("KAAX", sp.csc_matrix(A), 6, rows, rows)


def test_every_file_at_hand_is_told_on_one_screen_or_refused_in_one_sentence(
    data: Path, trueup: Call
) -> None:
    files = sorted(p for p in data.rglob("*") if p.is_file())
    assert len(files) > 100
    for path in files:
        status, out, err = trueup("inspect", path)
        if path.suffix in NOT_KNOWN:
            assert (status, out) == (1, ""), path
            assert err.count("\n") == 1, path
        else:
            assert status == 0, (path, err)
            assert kind_of_file(path).name == KINDS[path.suffix]
            assert 3 <= len(out.splitlines()) <= 40, path


def test_the_screen_of_a_deck_does_not_grow_with_the_path_to_it(
    data: Path, trueup: Call, tmp_path: Path
) -> None:
    deck = data / "nastran" / "all_elements" / "modes_elements.bdf"
    far = tmp_path.joinpath(*(["a folder with a long name"] * 5))
    shutil.copytree(deck.parent, far)
    near, there = (trueup("inspect", path)[1].splitlines() for path in (deck, far / deck.name))
    assert near[1:] == there[1:]


def test_inspection_as_json(data: Path, trueup: Call) -> None:
    path = data / "cases" / "duct" / "duct.bdf"
    status, out, _ = trueup("inspect", path, "--json", "-")
    told = json.loads(out)
    assert status == 0
    assert told["schema"] == "trueup/inspect/1"
    (entry,) = told["files"]
    assert entry["path"] == str(path)
    assert entry["format"] == "Nastran deck"
    assert entry["skipped"] == []
    assert entry["contents"]["grids"] == 1933
    assert entry["contents"]["elements"] == {"CQUAD4": 1842, "CBAR": 266}
    assert entry["contents"]["files"] == ["duct.bdf", "mesh.bdf", "properties.bdf"]
    assert entry["contents"]["eigenvalue_request"] == {"modes": 40}
    assert entry["contents"]["length_unit"] == "mm"


def test_what_a_deck_skips_is_told_with_line_and_reason(tmp_path: Path, trueup: Call) -> None:
    deck = tmp_path / "a.bdf"
    deck.write_text("GRID,1,,0.,0.,0.\nFORCE,1,1,,1.,1.,0.,0.\nNONSENSE,1\n")
    _, out, _ = trueup("inspect", deck, "--json", "-")
    skipped = {s["what"].split()[0]: s for s in json.loads(out)["files"][0]["skipped"]}
    assert skipped["FORCE"]["line"] == 2
    assert "loads" in skipped["FORCE"]["why"]
    assert skipped["NONSENSE"]["line"] == 3


@pytest.mark.parametrize("content", [b"", b"   \n", b"\x00\x01\x02" * 50, b"hello\n", b"{}"])
def test_files_of_no_known_format_are_refused(tmp_path: Path, trueup: Call, content: bytes) -> None:
    (tmp_path / "a.xyz").write_bytes(content)
    status, out, err = trueup("inspect", tmp_path / "a.xyz")
    assert (status, out) == (1, "")
    assert err.startswith("trueup: ")
    assert err.count("\n") == 1


def test_modes_and_responses_go_to_a_store_and_back(tmp_path: Path, trueup: Call) -> None:
    write_universal(tmp_path / "a.unv", geometry=geometry(), modes=modes(), frfs=frfs())
    assert trueup("convert", tmp_path / "a.unv", tmp_path / "a.h5")[0] == 0
    status, _, err = trueup("convert", tmp_path / "a.h5", tmp_path / "b.uff", "--to", "uff-binary")
    assert (status, err) == (0, "note: dataset 55 holds six digits of each shape\n")
    a, b = read_universal(tmp_path / "a.unv"), read_universal(tmp_path / "b.uff")
    assert a.modes is not None
    assert b.modes is not None
    assert a.frfs is not None
    assert b.frfs is not None
    assert a.geometry is not None
    assert b.geometry is not None
    np.testing.assert_allclose(a.modes.shapes, b.modes.shapes, rtol=1e-5)
    np.testing.assert_allclose(b.modes.damping, [0.01, 0.02], rtol=1e-5)
    np.testing.assert_allclose(a.frfs.values, b.frfs.values, rtol=1e-12)
    np.testing.assert_array_equal(a.geometry.xyz, b.geometry.xyz)
    np.testing.assert_array_equal(a.geometry.elements["line"], b.geometry.elements["line"])
    assert b.length_unit == "m"


@pytest.mark.parametrize("way", [("op4", "h5", "pch", "op4"), ("pch", "op4", "h5", "pch")])
def test_matrices_keep_values_and_dof_map_through_every_format(
    tmp_path: Path, trueup: Call, way: tuple[str, ...]
) -> None:
    first = tmp_path / f"a0.{way[0]}"
    write_op4(first, [stiffness()]) if way[0] == "op4" else write_dmig(first, [stiffness()])
    for k, suffix in enumerate(way[1:], 1):
        source = tmp_path / f"a{k - 1}.{way[k - 1]}"
        assert trueup("convert", source, tmp_path / f"a{k}.{suffix}", "-q")[0] == 0
    (found,) = read_matrices(tmp_path / f"a{len(way) - 1}.{way[-1]}")
    assert found.name == "KAAX"
    assert found.form == 6
    assert found.rows is not None
    np.testing.assert_array_equal(found.rows.keys, stiffness().rows.keys)  # type: ignore[union-attr]
    np.testing.assert_array_equal(found.matrix.toarray(), stiffness().matrix.toarray())


def test_op2_with_its_deck_becomes_a_universal_file_in_basic_axes(
    data: Path, tmp_path: Path, trueup: Call
) -> None:
    base = data / "nastran" / "beam_pairs"
    op2, deck = base / "beam_modes_m1.op2", base / "beam_modes.dat"
    assert trueup("convert", op2, deck, tmp_path / "a.unv")[0] == 0
    found, expected = read_universal(tmp_path / "a.unv").modes, read_modes(op2, read_deck(deck))
    assert found is not None
    np.testing.assert_allclose(found.frequencies_hz, expected.frequencies_hz, rtol=1e-5)
    np.testing.assert_array_equal(found.dofs.node, expected.dofs.node)
    np.testing.assert_allclose(found.shapes, expected.shapes, atol=1e-6)


def test_a_deck_becomes_matrices(data: Path, tmp_path: Path, trueup: Call) -> None:
    deck = data / "cases" / "panel_spring" / "panel.bdf"
    status, out, _ = trueup("convert", deck, tmp_path / "a.op4", "--json", "-")
    assert status == 0
    told = json.loads(out)
    assert told["schema"] == "trueup/convert/1"
    assert told["lost"] == []
    names = [m.name for m in read_matrices(tmp_path / "a.op4")]
    assert names == ["KFF", "MFF"]


def test_what_the_destination_cannot_hold_is_refused_unless_allowed(
    tmp_path: Path, trueup: Call
) -> None:
    K = stiffness()
    write_store(
        tmp_path / "a.h5", geometry=geometry(), modes={"one": modes(), "two": modes()},
        matrices={"KAAX": K.matrix.tocsr()}, pairs=[{"test": 1}],
    )  # fmt: skip
    status, _, err = trueup("convert", tmp_path / "a.h5", tmp_path / "a.unv")
    assert status == 1
    assert err.count("\n") == 1
    for word in ("matrices KAAX", "pairs", "modes two", "--lossy"):
        assert word in err
    assert not (tmp_path / "a.unv").exists()
    status, _, err = trueup("convert", tmp_path / "a.h5", tmp_path / "a.unv", "--lossy")
    assert status == 0
    assert "left out: the matrices KAAX" in err
    assert read_universal(tmp_path / "a.unv").modes is not None


def test_a_store_goes_to_a_store_whole(tmp_path: Path, trueup: Call) -> None:
    write_store(tmp_path / "a.h5", geometry=geometry(), modes={"analysis/raw": modes()},
                test_geometry=geometry(), pairs=[{"test": 1, "mac": 0.9}],
                frfs={"f": frfs()})  # fmt: skip
    assert trueup("convert", tmp_path / "a.h5", tmp_path / "b.h5")[0] == 0
    b = read_store(tmp_path / "b.h5")
    assert list(b.modes) == ["analysis/raw"]
    assert list(b.pairs) == [{"test": 1, "mac": 0.9}]
    assert b.test_geometry is not None
    np.testing.assert_array_equal(b.frfs["f"].values, frfs().values)


def test_nothing_is_overwritten_by_mistake(tmp_path: Path, trueup: Call) -> None:
    write_op4(tmp_path / "a.op4", [stiffness()])
    before = (tmp_path / "a.op4").read_bytes()
    status, _, err = trueup("convert", tmp_path / "a.op4", tmp_path / "a.op4", "--force")
    assert (status, err.count("is a source as well")) == (1, 1)
    (tmp_path / "b.h5").write_text("mine")
    status, _, err = trueup("convert", tmp_path / "a.op4", tmp_path / "b.h5")
    assert (status, err.count("--force")) == (1, 1)
    assert (tmp_path / "b.h5").read_text() == "mine"
    assert trueup("convert", tmp_path / "a.op4", tmp_path / "b.h5", "--force")[0] == 0
    assert (tmp_path / "a.op4").read_bytes() == before
    assert sorted(p.name for p in tmp_path.iterdir()) == ["a.op4", "b.h5"]


@pytest.mark.parametrize(
    ("words", "why"),
    [
        (["a.op4"], "at least one source"),
        (["a.op4", "b.txt"], "no format that can be written"),
        (["a.op4", "b.unv"], "nothing that a universal file can hold"),
        (["a.op4", "nowhere/b.h5"], "cannot be written"),
        (["absent.op4", "b.h5"], "does not exist"),
        (["a.op4", "b.h5", "--from", "magic"], "--from 'magic'"),
        (["a.op4", "b.h5", "--to", "magic"], "--to 'magic'"),
        (["a.op4", "b.h5", "--from", "universal"], "a.op4"),
    ],
)
def test_faults_of_a_conversion_are_one_sentence(
    tmp_path: Path, trueup: Call, monkeypatch: pytest.MonkeyPatch, words: list[str], why: str
) -> None:
    monkeypatch.chdir(tmp_path)
    write_op4(tmp_path / "a.op4", [stiffness()])
    status, out, err = trueup("convert", *words)
    assert (status, out) == (1, "")
    assert why in err
    assert err.count("\n") == 1
    assert [p.name for p in tmp_path.iterdir()] == ["a.op4"]


def test_functions_of_any_kind_go_through_a_store_and_back(
    trueup: Call, data: Path, tmp_path: Path
) -> None:
    """A time record: universal -> HDF5 -> 58b, equal to the last bit."""
    source = data / "uff" / "Sample_UFF58_ascii.uff"
    store, binary = tmp_path / "a.h5", tmp_path / "b.unv"
    assert trueup("convert", source, store)[0] == 0
    status, out, _ = trueup("convert", store, binary, "--to", "uff-binary", "--json", "-")
    assert status == 0
    assert json.loads(out)["written"] == {"functions": "1 x time response"}
    (a,), (b,) = (read_universal(p).functions for p in (source, binary))
    assert np.array_equal(a.values, b.values)
    assert (a.kind, a.response, a.quantity, a.over) == (b.kind, b.response, b.quantity, b.over)
    status, out, _ = trueup("inspect", store, "--json", "-")
    told = json.loads(out)["files"][0]["contents"]
    assert [t["what"] for t in told] == ["function"]
    assert told[0]["function"] == "time response"


def test_a_format_that_holds_no_functions_says_so(trueup: Call, data: Path, tmp_path: Path) -> None:
    source = data / "uff" / "Sample_UFF58_ascii.uff"
    status, _, said = trueup("convert", source, tmp_path / "a.op4")
    assert status == 1
    assert "functions 1 x time response" in said
