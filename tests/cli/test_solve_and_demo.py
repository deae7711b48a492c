"""``trueup solve`` and ``trueup demo`` as a user calls them."""

from __future__ import annotations

import json
import shutil
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from trueup.adapters.store import read_store
from trueup.adapters.universal import read_universal

Call = Callable[..., Any]

BEAM = """SOL 103
CEND
METHOD = 1
SPC = 1
BEGIN BULK
EIGRL,1,,,4
{grids}
{bars}
PBAR,1,1,1.-4,1.-9,4.-9,1.-9
MAT1,1,2.1+11,,.3,7850.
SPC1,1,123456,1
SPC1,1,1345,2,THRU,{last}
ENDDATA
"""


@pytest.fixture(scope="module")
def beam(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A cantilever of 1 m that bends in one plane, lumped masses."""
    n = 40
    grids = "\n".join(f"GRID,{i + 1},,{i / n},0.,0." for i in range(n + 1))
    bars = "\n".join(f"CBAR,{i},1,{i},{i + 1},0.,1.,0." for i in range(1, n + 1))
    path = tmp_path_factory.mktemp("beam") / "beam.bdf"
    path.write_text(BEAM.format(grids=grids, bars=bars, last=n + 1))
    return path


def bernoulli(count: int) -> Any:
    """Frequencies of a cantilever: roots of cos x cosh x = -1."""
    roots = np.array([1.8751040687, 4.6940911330, 7.8547574382, 10.995540735])[:count]
    return roots**2 / (2.0 * np.pi) * np.sqrt(2.1e11 * 1e-9 / (7850.0 * 1e-4))


def test_a_cantilever_has_its_closed_form_frequencies(call: Call, beam: Path) -> None:
    said = call("solve", beam, "--json", "-")
    assert said.status == 0, said.err
    result = json.loads(said.out)
    assert result["schema"] == "trueup/solve/1"
    assert result["rigid_body_modes"] == 0
    assert result["mass"] == pytest.approx(0.785)
    assert result["centre_of_gravity"] == pytest.approx([0.5, 0.0, 0.0])
    assert result["checks"]["missed"] == 0
    hz = [m["frequency_hz"] for m in result["modes"]]
    assert len(hz) == 4
    np.testing.assert_allclose(hz, bernoulli(4), rtol=5e-3)
    assert [m["generalized_mass"] for m in result["modes"]] == pytest.approx([1.0] * 4)


def test_rigid_body_modes_come_first(call: Call, duct: Path) -> None:
    said = call("solve", duct / "duct.bdf", "-n", 9, "--json", "-")
    assert said.status == 0, said.err
    result = json.loads(said.out)
    assert result["rigid_body_modes"] == 6
    hz = [m["frequency_hz"] for m in result["modes"]]
    assert len(hz) == 9
    assert max(hz[:6]) < 1e-3 * hz[6]
    assert hz[6:] == sorted(hz[6:])


def test_fmax_gives_all_modes_up_to_it(call: Call, beam: Path) -> None:
    said = call("solve", beam, "--fmax", bernoulli(4)[2] + 10.0, "--json", "-")
    assert len(json.loads(said.out)["modes"]) == 3


@pytest.mark.parametrize("suffix", ["h5", "unv"])
def test_modes_are_written(call: Call, beam: Path, tmp_path: Path, suffix: str) -> None:
    out = tmp_path / f"modes.{suffix}"
    said = call("solve", beam, "--out", out, "--quiet")
    assert (said.status, said.out, said.err) == (0, "", "")
    modes = read_store(out).modes["analysis"] if suffix == "h5" else read_universal([out]).modes
    np.testing.assert_allclose(modes.frequencies_hz, bernoulli(4), rtol=5e-3)


@pytest.mark.parametrize(
    ("words", "status", "sentence"),
    [
        (("-n", 0), 2, "-n is 0; ask for at least one mode"),
        (("--fmax", -3), 2, "--fmax is -3.0; give a frequency above 0 Hz"),
        (("--out", "modes.xyz"), 2, "modes are written as .h5 or .unv"),
        (("--out", "nowhere/modes.h5"), 1, "the folder nowhere does not exist"),
    ],
)
def test_what_cannot_be_asked_is_refused(
    call: Call, beam: Path, words: tuple[object, ...], status: int, sentence: str
) -> None:
    said = call("solve", beam, *words)
    assert said.status == status
    assert sentence in said.err


def test_an_unknown_demo_is_refused(call: Call, tmp_path: Path) -> None:
    said = call("demo", "duckt", "--out", tmp_path / "d")
    assert said.status == 1
    assert "there is no demo 'duckt'; there are: duct" in said.sentence
    assert not (tmp_path / "d").exists()


@pytest.mark.slow
def test_the_demo_shows_the_paper(
    call: Call, duct: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    said = call("demo")
    assert said.status == 0, said.err
    folder = tmp_path / "trueup-demo-duct"
    for path in duct.iterdir():
        assert (folder / path.name).read_bytes() == path.read_bytes()
    runs = sorted((folder / "runs").iterdir())
    results = [json.loads((r / "result.json").read_text()) for r in runs]
    verbs = [r["schema"].split("/")[1] for r in results]
    assert verbs == ["correlate"] * 2 + ["update"] * 3 + ["discover"]
    gaps = [r.get("after", r)["summary"] for r in results]
    assert gaps[1]["pairs"] >= 2 * gaps[0]["pairs"]
    for gap in gaps[2:]:
        assert gap["mean_abs_deviation_percent"] < 0.3 * gaps[1]["mean_abs_deviation_percent"]
    assert gaps[5]["pairs"] >= max(g["pairs"] for g in gaps[:5]) + 5
    for run in runs:
        assert (run / "report.html").is_file()
    assert "What each step brought" in said.out
    again = call("demo")
    assert again.status == 1
    assert "exists; give --force" in again.sentence
    shutil.rmtree(folder)


@pytest.mark.slow
def test_the_strategies_meet_a_truth_of_masses_on_rims(call: Call, tmp_path: Path) -> None:
    said = call("demo", "ports", "--out", tmp_path / "d")
    assert said.status == 0, said.err
    runs = sorted((tmp_path / "d" / "runs").iterdir())
    results = [json.loads((r / "result.json").read_text()) for r in runs]
    frequencies, both = results[2], results[4]
    pairs = [r.get("after", r)["summary"]["pairs"] for r in results]
    assert pairs[0] < pairs[1] <= pairs[2]
    assert pairs[0] < pairs[3] < pairs[4] == 24
    worst = [r["after"]["summary"]["worst_deviation_percent"] for r in results[2:]]
    assert max(worst[1:]) < 3.0 < worst[0]
    assert max(len(r["history"]) - 1 for r in (frequencies, both)) <= 5
    factors = {q["name"]: q["factor"] for q in both["parameters"]}
    truth = {"front flange": 1.6, "rear flange": 1.3}
    truth |= {f"rim {k} density": f for k, f in enumerate((2.5, 1.8, 3.5, 1.4), 1)}
    assert {k: factors[k] for k in truth} == pytest.approx(truth, rel=0.04)


def test_a_run_folder_of_solve_has_a_page_with_moving_shapes_and_properties(call, duct, tmp_path):
    run = tmp_path / "run"
    assert call("solve", duct / "duct.bdf", "-n", 9, "--out", run, "-q").status == 0
    page = (run / "report.html").read_text(encoding="utf-8")
    assert "9 normal modes" in page
    assert "data-shapes" in page
    assert "PBAR 11, 72 elements" in page
    assert (run / "tables" / "modes.csv").read_text(encoding="utf-8").count("\n") == 10
    again = call("solve", duct / "duct.bdf", "--out", run)
    assert again.status == 1
    assert "--force" in again.sentence


def test_inspect_lists_properties_with_their_values(call, duct):
    said = call("inspect", duct / "duct.bdf")
    assert "PBAR 11 (72): A 200, I1 9000, I2 9000, J 3000" in said.out


def test_matrices_are_no_deck_and_what_makes_one_of_them_is_said(
    call: Call, beam: Path, tmp_path: Path
) -> None:
    matrices = tmp_path / "beam.op4"
    assert call("convert", beam, matrices).status == 0
    said = call("solve", matrices)
    assert said.status == 1
    assert "holds matrices, and a deck is expected: make one of their grids" in said.sentence
    assert "'trueup convert beam.op4 beam.pch'" in said.sentence
