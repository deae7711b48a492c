"""Runs exported, solved elsewhere and read back give K and M at every parameter value.

trueup's own assembly of each exported deck stands for the user's Nastran: the derivative matrices
must follow from the exported files alone.
"""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest
import scipy.sparse as sp

from trueup.adapters.nastran import (
    build_model,
    describe_runs,
    model_matrices,
    parse_parameter,
    read_deck,
    read_runs,
    terms_of_runs,
    write_dmig,
    write_op4,
    write_runs,
)
from trueup.core.data.parametric_model import Model
from trueup.core.errors import InputError

BEAM = """SOL 103
CEND
METHOD = 1
SPC = 1
BEGIN BULK
EIGRL,1,,,4
MAT1,1,2.1+5,,.3,7.85-9
PBAR,11,1,100.,2000.,3000.,4000.
PBAR,12,1,50.,900.,800.,700.
CONM2,90,4,,1.5-3
SPC1,1,123456,1
GRID,1,,0.,0.,0.
GRID,2,,100.,0.,0.
GRID,3,,200.,0.,0.
GRID,4,,200.,100.,0.
CBAR,1,11,1,2,0.,0.,1.
CBAR,2,11,2,3,0.,0.,1.
CBAR,3,12,3,4,0.,0.,1.
ENDDATA
"""
PLATE = """SOL 103
CEND
METHOD = 1
BEGIN BULK
EIGRL,1,,,9
MAT1,1,2.1+5,,.3,7.85-9
PSHELL,1,1,2.,1,,1
GRID,1,,0.,0.,0.
GRID,2,,10.,0.,0.
GRID,3,,20.,0.,0.
GRID,4,,0.,10.,0.
GRID,5,,10.,10.,0.
GRID,6,,20.,11.,0.
CQUAD4,1,1,1,2,5,4
CQUAD4,2,1,2,3,6,5
ENDDATA
"""
BEAM_PARAMETERS = ("MAT1 1 E", "PBAR 11 I1, PBAR 11 I2", "PBAR 12 A", "CONM2 90 M", "MAT1 1 RHO")


def exported(tmp_path: Path, text: str, parameters: tuple[str, ...]) -> tuple[Path, Model]:
    deck = tmp_path / "deck.bdf"
    deck.write_text(text)
    specs = [parse_parameter(p) for p in parameters]
    out = tmp_path / "runs"
    out.mkdir()
    for k, run in enumerate(write_runs(deck, specs, out)["runs"]):
        top = out / run["deck"]
        held = model_matrices(build_model(read_deck(top)))
        if k % 2:
            write_op4(top.with_suffix(".op4"), held)
        else:
            write_dmig(top.with_suffix(".pch"), held)
    return out, build_model(read_deck(deck), specs)


def ordered(model: Model, matrix: sp.spmatrix) -> np.ndarray:
    keys = [[int(word) for word in label.split(":")] for label in model.free_labels]
    order = np.lexsort(np.array(keys).T[::-1])
    return np.asarray(matrix.toarray()[np.ix_(order, order)])


def difference(a: Model, b: Model, p: np.ndarray) -> tuple[float, float]:
    k, m = (
        abs(ordered(a, x) - ordered(b, y)).max() / abs(y).max()
        for x, y in ((a.K(p), b.K(p)), (a.M(p), b.M(p)))
    )
    return k, m


def test_what_is_linear_or_a_product_of_linear_factors_is_exact(tmp_path: Path) -> None:
    folder, expected = exported(tmp_path, BEAM, BEAM_PARAMETERS)
    found = read_runs(folder)
    assert found.parameters == expected.parameters
    rng = np.random.default_rng(1)
    for _ in range(5):
        p = rng.uniform(0.2, 5.0, len(BEAM_PARAMETERS))
        k, m = difference(found, expected, p)
        assert k < 1e-9  # DMIG holds eleven digits or more
        assert m < 1e-9


def test_derivatives_follow(tmp_path: Path) -> None:
    folder, expected = exported(tmp_path, BEAM, BEAM_PARAMETERS)
    found = read_runs(folder)
    p = np.array([1.2, 0.7, 2.0, 1.5, 0.9])
    size = [abs(x).max() for x in (expected.K(p), expected.M(p))]
    for k in range(len(p)):
        dK, dM = ordered(found, found.dK(k, p)), ordered(found, found.dM(k, p))
        assert abs(dK - ordered(expected, expected.dK(k, p))).max() < 1e-9 * size[0]
        assert abs(dM - ordered(expected, expected.dM(k, p))).max() < 1e-9 * size[1]
        assert abs(dK).max() > 1e-6 * size[0] or abs(dM).max() > 1e-6 * size[1]


def test_a_thickness_and_a_modulus_together(tmp_path: Path) -> None:
    folder, expected = exported(
        tmp_path, PLATE, ("MAT1 1 E [0.5, 2]", "PSHELL 1 T [0.7, 1.4]", "MAT1 1 RHO [0.5, 2]")
    )
    found = read_runs(folder)
    assert len(json.loads((folder / "runs.json").read_text())["runs"]) == 15
    for p in ([0.6, 1.3, 1.9], [1.8, 0.75, 0.6]):
        k, m = difference(found, expected, np.array(p))
        assert k < 5e-5  # with transverse shear K(t) is no polynomial: five terms reach this
        assert m < 1e-9


def test_only_the_moved_values_and_the_request_differ(tmp_path: Path) -> None:
    folder, _ = exported(tmp_path, BEAM, ("PBAR 12 A [0.5, 2]",))
    index = json.loads((folder / "runs.json").read_text())
    assert index["runs"][0]["factors"] == [1.0]
    assert len(index["runs"]) == 2
    factor = index["runs"][1]["factors"][0]
    added = "PARAM   EXTOUT  DMIGPCH"
    first, second = ((folder / r["deck"]).read_text() for r in index["runs"])
    assert [x for x in first.splitlines() if not x.startswith("$") and x != added] == (
        BEAM.splitlines()
    )
    assert added in first
    kept = [x for x in second.splitlines() if x in first.splitlines()]
    assert len(kept) == len(first.splitlines()) - 1
    value = read_deck(folder / index["runs"][1]["deck"]).bulk.table("PBAR")[12].a
    assert value == pytest.approx(50.0 * factor, rel=1e-11)


def test_a_run_without_matrices_is_named(tmp_path: Path) -> None:
    folder, _ = exported(tmp_path, BEAM, ("PBAR 12 A",))
    (folder / "run_001" / "deck.op4").unlink()
    with pytest.raises(InputError, match=r"run_001 has no punch.*run Nastran on deck\.bdf"):
        read_runs(folder)


def test_too_many_runs_are_refused_quickly(tmp_path: Path) -> None:
    (tmp_path / "deck.bdf").write_text(
        PLATE.replace(
            "ENDDATA", "".join(f"PSHELL,{k},1,2.,1,,1\n" for k in range(2, 60)) + "ENDDATA"
        )
    )
    specs = [parse_parameter(f"PSHELL {k} T") for k in range(1, 60)]
    with pytest.raises(InputError, match="more than 200 runs"):
        write_runs(tmp_path / "deck.bdf", specs, tmp_path)
    assert [p.name for p in tmp_path.iterdir()] == ["deck.bdf"]


def test_the_verb(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    from trueup.cli.app import run

    (tmp_path / "beam.bdf").write_text(BEAM)
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr("sys.argv", ["trueup", "export-runs", "beam.bdf", "-p", "MAT1 1 E"])
    assert run() == 0
    assert "2 decks" in capsys.readouterr().out
    assert sorted(p.name for p in (tmp_path / "beam_runs").iterdir()) == [
        "run_000", "run_001", "runs.json",
    ]  # fmt: skip
    assert run() == 1
    assert "exists" in capsys.readouterr().err


def test_other_files_of_a_run_are_passed_over(tmp_path: Path) -> None:
    """Nastran leaves more in the folder: an OP2 of modes alone, a log, an F06."""
    folder, expected = exported(tmp_path, BEAM, ("MAT1 1 E",))
    op2 = Path(__file__).parents[1] / "results" / "mystran" / "basic.op2"
    for run in folder.glob("run_*"):
        (run / "deck.op2").write_bytes(op2.read_bytes())
        (run / "deck.f06").write_text("1 N A S T R A N\n")
    assert difference(read_runs(folder), expected, np.array([1.7])) < (1e-9, 1e-9)


def test_the_terms_alone_as_matrices(tmp_path: Path) -> None:
    """K0 + T1(E) K1 at any E, with the Chebyshev polynomial that the text names."""
    folder, expected = exported(tmp_path, BEAM, ("modulus = MAT1 1 E [0.5, 2.5]", "CONM2 90 M"))
    told = describe_runs(folder / "runs.json")["contents"]
    assert told["runs_without_matrices"] == 0
    terms = {m.name: (m, said) for m, said in terms_of_runs(folder / "runs.json")}
    assert set(terms) == {"K0", "K1", "M0", "M1"}
    assert terms["K0"][1] == terms["M0"][1] == "1"
    assert terms["K1"][1] == "T1(modulus on [0.5, 2.5])"
    for factor in (0.6, 1.0, 2.2):
        unit = (2 * factor - 0.5 - 2.5) / (2.5 - 0.5)
        K = terms["K0"][0].matrix + unit * terms["K1"][0].matrix
        keys = terms["K0"][0].rows.keys
        order = np.argsort(keys)
        wanted = ordered(expected, expected.K(np.array([factor, 1.0])))
        assert abs(K.toarray()[np.ix_(order, order)] - wanted).max() < 1e-9 * abs(wanted).max()
