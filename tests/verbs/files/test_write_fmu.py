"""`trueup.write_fmu` and ``convert`` to units and state spaces: decks, runs, modes; bad input."""

from __future__ import annotations

import json
import os
import shutil
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import scipy.sparse.linalg as spla

import trueup
from trueup.adapters.nastran import build_model
from trueup.cli.app import run

DUCT = Path(__file__).parents[3] / "fixtures" / "duct"
ASKED = {"inputs": "10:+Z,200:+Y", "outputs": "10:+Z,200:+Y,333:-X:acc"}
DECK = """SOL 103
CEND
BEGIN BULK
{bulk}
GRID,1,,0.,0.,0.
GRID,2,,1.,0.,0.
GRID,3,,2.,0.,0.
CBAR,1,1,1,2,0.,1.,0.
CBAR,2,1,2,3,0.,1.,0.
PBAR,1,1,1e-3,1e-6,2e-6,1e-6
MAT1,1,2.1e11,,0.3,7850.
SPC1,1,123456,1
ENDDATA
"""


def beam(folder: Path, bulk: str = "", spc: bool = True) -> Path:
    path = folder / "beam.bdf"
    text = DECK.format(bulk=bulk)
    path.write_text(text.replace("CEND\n", "CEND\nSPC = 1\n") if spc else text)
    return path


def arrays(path: Path) -> dict[str, Any]:
    with np.load(path, allow_pickle=False) as held:
        return dict(held)


def responses(held: dict[str, Any], hz: float) -> np.ndarray:
    s = 2j * np.pi * hz
    return (
        held["C"] @ np.linalg.solve(s * np.eye(len(held["A"])) - held["A"], held["B"]) + held["D"]
    )


@pytest.fixture(scope="module")
def duct(tmp_path_factory: pytest.TempPathFactory) -> dict[str, Any]:
    path = tmp_path_factory.mktemp("duct") / "plant.npz"
    trueup.write_fmu(DUCT / "duct.bdf", path, **ASKED, fmax=120.0, damping=0.0)
    return arrays(path)


def test_responses_are_the_direct_ones_of_the_deck_within_the_stated_error(
    duct: dict[str, Any],
) -> None:
    model = build_model(trueup.read_deck(DUCT / "duct.bdf"))
    rows = [int(np.flatnonzero((model.dofs.node == n) & (model.dofs.component == c))[0])
            for n, c in ((10, 3), (200, 2), (333, 1))]  # fmt: skip
    R, K, M = model.expansion[rows], model.K(), model.M()
    lines = (14.0, 47.0, 83.0, 119.0)
    made = np.array([responses(duct, f) for f in lines])
    direct = []
    for f in lines:
        w2 = (2.0 * np.pi * f) ** 2
        x = spla.spsolve((K - w2 * M).tocsc(), R[:2].T.toarray())
        direct.append((R @ x) * np.array([[1e-3], [1e-3], [1e-3 * w2]]))
    off = np.abs(made - np.array(direct))
    assert 0.0 < duct["error"] < 0.02
    usual = np.median(np.abs(np.array([responses(duct, f) for f in np.linspace(2, 120, 60)])), 0)
    assert (off[:, :2] / usual[:2]).max() < 1.2 * duct["error"]
    assert duct["output_units"].tolist() == ["m", "m", "m/s2"]


def test_convert_and_the_terminal_write_the_same(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    deck = beam(tmp_path, "$ units: m, kg, N, s")
    asked = {"inputs": "3:+Y", "outputs": "tip=3:+Y:acc"}
    (tmp_path / "a").mkdir()
    done = trueup.convert(deck, "a/plant.npz", **asked, modes=4, damping="2:0.03,0.02")
    assert done.format == "state space"
    assert done.written["modes"] == "4"
    words = ["--inputs", "3:+Y", "--outputs", "tip=3:+Y:acc", "-n", "4"]
    words += ["--damping", "2:0.03,0.02", "--quiet"]
    monkeypatch.setattr("sys.argv", ["trueup", "convert", deck.name, "plant.npz", *words])
    assert run() == 0
    one, other = arrays(tmp_path / "a" / "plant.npz"), arrays(tmp_path / "plant.npz")
    assert all(np.array_equal(one[k], other[k], equal_nan=one[k].dtype.kind == "f") for k in one)
    assert one["damping"].tolist() == [0.02, 0.03, 0.02, 0.02, *[0.02] * (len(one["damping"]) - 4)]


def test_damping_of_the_deck_is_half_of_g_and_what_dashpots_give(tmp_path: Path) -> None:
    bulk = "$ units: m, kg, N, s\nPARAM,G,0.04\nCDAMP2,9,50.,3,2"
    trueup.write_fmu(beam(tmp_path, bulk), tmp_path / "p.npz", inputs="3:Y", outputs="3:Y", modes=4,
                     residual=False)  # fmt: skip
    held = arrays(tmp_path / "p.npz")
    w = 2.0 * np.pi * held["frequencies_hz"]
    assert held["damping"] == pytest.approx(0.02 + 50.0 * held["drive"][:, 0] ** 2 / (2.0 * w))
    assert held["damping"][0] > 0.03


def test_responses_are_those_of_nx_nastran_with_the_damping_of_its_table(tmp_path: Path) -> None:
    """Modal frequency response of a free model (SOL 111, TABDMP1, WTMASS): single precision."""
    op2 = pytest.importorskip("pyNastran.op2.op2")
    deck = Path(__file__).parents[4] / "shared/data/nastran/seismic_mass/good_sine.dat"
    if not deck.is_file():
        pytest.skip("no shared data beside the repository")
    results = op2.OP2(debug=False, log=None)
    results.read_op2(str(deck.with_suffix(".op2")), combine=False)
    outputs = ",".join(f"{g}:{c}" for g in (5, 9) for c in "XYZ")
    asked = {"outputs": outputs, "fmax": 133.0, "units": "deck", "residual": False}
    trueup.write_fmu(deck, tmp_path / "p.npz", inputs="1:X,1:Y,1:Z", **asked)
    held = arrays(tmp_path / "p.npz")
    for column, found in enumerate(results.displacements.values()):
        rows = [found.node_gridtype[:, 0].tolist().index(g) for g in (5, 9)]
        theirs = found.data[:, rows, :3].reshape(-1, 6) / 1e9
        ours = np.array([responses(held, f)[:, column] for f in found._times.astype(float)])
        assert np.abs(theirs).max() > 9e-9
        assert np.abs(ours - theirs).max() < 1e-6 * np.abs(theirs).max()
        bent = theirs[:, column + 3] - theirs[:, column]  # what is not rigid; none along X
        ours_bent = ours[:, column + 3] - ours[:, column]
        assert np.abs(bent - ours_bent).max() < 3e-4 * np.abs(bent).max() + 1e-15


def test_modes_alone_give_the_same_plant_as_their_deck(tmp_path: Path) -> None:
    deck = beam(tmp_path, "$ units: m, kg, N, s")
    trueup.solve(deck, 6).write(tmp_path / "modes.h5")
    asked = {"inputs": "3:Y", "outputs": "2:+RZ:vel", "modes": 5}
    told = trueup.write_fmu(tmp_path / "modes.h5", tmp_path / "of_modes.npz", **asked)
    assert any("of modes alone nobody knows what was left out" in w for w in told.warnings)
    trueup.write_fmu(deck, tmp_path / "of_deck.npz", **asked, residual=False)
    one, other = arrays(tmp_path / "of_modes.npz"), arrays(tmp_path / "of_deck.npz")
    for hz in (3.0, 40.0):
        assert responses(one, hz) == pytest.approx(responses(other, hz), rel=1e-9)


def test_modes_without_masses_are_of_unit_mass_unless_their_largest_motion_is(
    tmp_path: Path,
) -> None:
    solved = trueup.solve(beam(tmp_path, "$ units: m, kg, N, s"), 5).shapes
    asked = {"inputs": "3:Y", "outputs": "3:Y", "deck_length_unit": "m"}
    bare = replace(solved, generalized_mass=np.full(5, np.nan))
    told = trueup.write_fmu(bare, tmp_path / "bare.npz", **asked)
    assert any("its modes are taken to be of unit mass" in w for w in told.warnings)
    trueup.write_fmu(solved, tmp_path / "whole.npz", **asked)
    assert np.array_equal(arrays(tmp_path / "bare.npz")["B"], arrays(tmp_path / "whole.npz")["B"])
    by_largest = replace(bare, shapes=solved.shapes / np.abs(solved.shapes).max(axis=0))
    with pytest.raises(trueup.InputError, match=r"mode 1 of .* has no generalised mass"):
        trueup.write_fmu(by_largest, tmp_path / "largest.npz", **asked)


def test_a_run_gives_damping_and_sensors_of_its_test(tmp_path: Path) -> None:
    found = trueup.correlate(DUCT / "duct.bdf", DUCT / "duct_test.unv", deck_length_unit="mm")
    found.save(tmp_path / "run")
    sensor = found.content.modes["test"].dofs
    node, component = int(sensor.node[0]), int(sensor.component[0])
    said = f"@{node}:{'XYZ'[component - 1]}:acc"
    trueup.write_fmu(tmp_path / "run", tmp_path / "p.npz", inputs="10:Z", outputs=said, fmax=120.0)
    held = arrays(tmp_path / "p.npz")
    pairs = [p for p in found.pairs if p.test_damping is not None]
    assert pairs
    for p in pairs:
        if p.analysis_hz < 120.0:
            near = np.abs(held["frequencies_hz"] - p.analysis_hz) < 1e-4 * p.analysis_hz
            assert np.any(np.isclose(held["damping"][near], p.test_damping))
    assert held["output_names"].tolist() == [f"s{node}.acceleration.{'XYZ'[component - 1]}"]
    analysis = found.content.modes["analysis"]
    seen = found.content.matrices["observation"][[0]] @ analysis.shapes
    read = {round(f, 3): abs(x) for f, x in zip(analysis.frequencies_hz, seen[0], strict=True)}
    kept = len(held["frequencies_hz"]) - int(held["residual_modes"])
    one = [
        k
        for k in range(kept)
        if np.sum(np.isclose(held["frequencies_hz"], held["frequencies_hz"][k], rtol=1e-3)) == 1
    ]
    elastic = [k for k in one if held["frequencies_hz"][k] > 1.0]
    assert elastic
    for k in elastic:  # in kilograms, of a deck in tonnes; translations are what they are
        own = abs(held["sense"][0, k]) * np.sqrt(1e3)
        assert own == pytest.approx(read[round(held["frequencies_hz"][k], 3)], rel=1e-5)


def mast(folder: Path, name: str, modulus: str) -> Path:
    """A cantilever of ten bars, 2 % damped."""
    grids = "".join(f"GRID,{k + 1},,{0.4 * k:.1f},0.,0.\n" for k in range(11))
    bars = "".join(f"CBAR,{k},1,{k},{k + 1},0.,1.,0.\n" for k in range(1, 11))
    rest = f"PBAR,1,1,1.-3,1.-6,2.-6,1.-6\nMAT1,1,{modulus},,.3,7850.\nSPC1,1,123456,1\n"
    bulk = f"$ units: m, kg, N, s\nPARAM,G,.04\n{grids}{bars}{rest}"
    (folder / name).write_text(f"SOL 103\nCEND\nSPC = 1\nBEGIN BULK\n{bulk}ENDDATA\n")
    return folder / name


def test_functions_are_those_of_the_state_space(tmp_path: Path) -> None:
    deck = mast(tmp_path, "deck.bdf", "2.1+11")
    asked: dict[str, Any] = {"inputs": "11:Y,5:-RZ", "outputs": "11:Y:vel,7:-Z:vel", "fmax": 60.0}
    told = trueup.convert(deck, tmp_path / "frf.unv", lines=30, **asked)
    assert told.format == "frequency responses"
    trueup.convert(deck, tmp_path / "plant.npz", **asked)
    content, held = trueup.read(tmp_path / "frf.unv"), arrays(tmp_path / "plant.npz")
    frfs = content.frfs
    assert frfs.quantity == "velocity"
    assert frfs.responses.labels == ["11:Y", "7:Z"]
    assert frfs.references.labels == ["11:Y", "5:RZ"]
    assert frfs.frequencies_hz == pytest.approx(2.0 * np.arange(1, 31))
    signs = frfs.responses.axis[:, [1, 2]].sum(1), frfs.references.axis[:, [1, 2]].sum(1)
    for k in (0, 4, 29):
        ours = responses(held, frfs.frequencies_hz[k])
        assert ours == pytest.approx(frfs.values[:, :, k], rel=1e-9)
    assert [s.tolist() for s in signs] == [[1.0, -1.0], [1.0, -1.0]]
    assert content.geometry.ids.tolist() == [5, 7, 11]
    assert content.geometry.xyz[:, 0] == pytest.approx([1.6, 2.4, 4.0])
    for wrong, says in (
        ({"outputs": "11:Y,11:Z:acc"}, "outputs are displacement and acceleration"),
        ({"lines": 0}, "lines is 0; it must be above 0"),
    ):
        with pytest.raises(trueup.InputError, match=says):
            trueup.convert(deck, tmp_path / "none.unv", **{**asked, **wrong})
    assert not (tmp_path / "none.unv").exists()


@pytest.mark.slow
def test_runs_of_every_verb_make_plants(tmp_path: Path) -> None:
    """Functions of a deck, modes identified in them, a deck corrected to those: plants of all."""
    truth, deck = mast(tmp_path, "truth.bdf", "2.1+11"), mast(tmp_path, "deck.bdf", "1.8+11")
    asked: dict[str, Any] = {"inputs": "11:Y,11:Z", "fmax": 60.0}
    every = ",".join(f"{k}:{c}:acc" for k in range(2, 12) for c in "YZ")
    trueup.convert(truth, tmp_path / "frf.unv", outputs=every, lines=3000, **asked)
    trueup.identify(tmp_path / "frf.unv").save(tmp_path / "identify")
    test = [tmp_path / "identify" / "modes.unv", tmp_path / "frf.unv"]
    trueup.update(deck, test, ["MAT1 1 E"]).save(tmp_path / "update")
    trueup.discover(truth, test).save(tmp_path / "discover")
    trueup.correlate(truth, test).save(tmp_path / "correlate")
    trueup.solve(truth, 6).write(tmp_path / "modes.unv")
    undecided = json.loads((tmp_path / "discover" / "result.json").read_text())
    undecided["verdict"], undecided["judgement"]["proposal"] = "undecided", False
    shutil.copytree(tmp_path / "discover", tmp_path / "undecided")
    (tmp_path / "undecided" / "result.json").write_text(json.dumps(undecided))
    asked["outputs"] = "11:Y,6:Z:vel"
    told = trueup.write_fmu(tmp_path / "undecided", tmp_path / "u.npz", **asked)
    assert any(w.startswith("the run is undecided") for w in told.warnings)
    at = np.array([5.69, 8.05, 35.3, 49.9])  # resonances, which modes alone know as well

    def made(name: str, **more: Any) -> np.ndarray:
        trueup.write_fmu(tmp_path / name, tmp_path / "p.npz", **asked, **more, force=True)
        return np.array([responses(arrays(tmp_path / "p.npz"), f) for f in at])

    exact, alone = made("truth.bdf"), {"deck_length_unit": "m"}
    largest = np.abs(exact).max(axis=0)
    moves = largest > 1e-6 * largest.max()
    assert moves.tolist() == [[True, False], [False, True]]
    for name, within, more in (
        ("identify", 2e-3, alone),
        ("identify/modes.unv", 2e-3, alone),
        ("modes.unv", 0.02, {**alone, "damping": 0.02}),
        ("update", 2e-3, {}),
        ("discover", 2e-3, {}),
        ("correlate", 1e-4, {}),
    ):
        off = np.abs(made(name, **more) - exact).max(axis=0)[moves] / largest[moves]
        assert off.max() < within, name


@pytest.mark.parametrize(
    ("asked", "says"),
    [
        ({"inputs": "99:Z"}, "input 99:+Z: the model has no grid 99"),
        ({"inputs": "1:Z"}, "input 1:+Z is fixed: nothing moves there"),
        ({"outputs": "1:RX"}, "output 1:+RX is fixed: nothing moves there"),
        ({"outputs": "3:Z:mm"}, "'mm' is no quantity"),
        ({"outputs": "@3:Z"}, "sensors of a test are known of run folders only"),
        ({"outputs": "a=3:Z,a=2:Z"}, "both called 'a'"),
        ({"outputs": ""}, "no output is given"),
        ({"damping": -0.01}, "a damping of '-0.01' would be unstable"),
        ({"damping": "test"}, "the test says nothing of damping"),
        ({"units": "cgs"}, "units='cgs' is not known"),
        ({"deck_length_unit": "yd"}, "the length unit 'yd' is not known"),
        ({"deck_length_unit": None}, "the length unit is not known"),
        ({"fmi": 1}, "fmi=1 is no version of FMI"),
        ({"fmax": -1.0}, "fmax is -1.0; it must be above 0"),
        ({"output": "3:Z"}, "unknown key 'output'"),
        ({"residual": "no"}, "'residual' has a value of the wrong type: 'no'"),
        ({"inputs": 10}, "the inputs are 10; write them as in"),
    ],
)
def test_bad_input_is_one_sentence_and_no_file(
    tmp_path: Path, asked: dict[str, Any], says: str
) -> None:
    whole = {"inputs": "3:Z", "outputs": "3:Z", "deck_length_unit": "m", **asked}
    with pytest.raises(trueup.InputError) as caught:
        trueup.write_fmu(beam(tmp_path), tmp_path / "plant.fmu", **whole)
    assert says in str(caught.value)
    assert "\n" not in str(caught.value)
    assert os.listdir(tmp_path) == ["beam.bdf"]


def test_a_deck_that_nothing_holds_up_is_refused(tmp_path: Path) -> None:
    deck = beam(tmp_path, "CELAS2,9,-1e6,3,2\n$ units: m, kg, N, s")
    with pytest.raises(trueup.InputError, match=r"negative|positive"):
        trueup.write_fmu(deck, tmp_path / "plant.fmu", inputs="3:Y", outputs="3:Y")
    assert not (tmp_path / "plant.fmu").exists()


def test_an_existing_file_is_kept_and_plants_have_their_own_options(tmp_path: Path) -> None:
    deck = beam(tmp_path, "$ units: m, kg, N, s")
    (tmp_path / "plant.fmu").write_text("mine")
    with pytest.raises(trueup.InputError, match="exists; give force=True"):
        trueup.write_fmu(deck, tmp_path / "plant.fmu", inputs="3:Y", outputs="3:Y")
    with pytest.raises(
        trueup.InputError, match=r"'inputs' is of \.fmu, \.npz, \.mat, \.unv, \.uff alone"
    ):
        trueup.convert(deck, tmp_path / "m.op4", inputs="3:Y")
    with pytest.raises(trueup.InputError, match="a plant has no boundary"):
        trueup.convert(deck, tmp_path / "p.npz", boundary="3", inputs="3:Y", outputs="3:Y")
    with pytest.raises(trueup.InputError, match="is no file of a plant"):
        trueup.write_fmu(deck, tmp_path / "plant.txt", inputs="3:Y", outputs="3:Y")
    assert (tmp_path / "plant.fmu").read_text() == "mine"


@pytest.mark.skipif(not (shutil.which("cc") or shutil.which("gcc")), reason="no C compiler")
def test_a_unit_of_a_deck_is_told(tmp_path: Path) -> None:
    deck = beam(tmp_path, "$ units: m, kg, N, s")
    told = trueup.write_fmu(deck, tmp_path / "plant.fmu", inputs="3:Y", outputs="3:Y", fmi=3)
    assert told.format.startswith("FMI 3.0 unit for ")
    assert any("no damping is known of" in w and "a default" in w for w in told.warnings)
