"""Cases whose cause is outside the list of effects: what is made, and how an answer is scored."""

from __future__ import annotations

import json
import shutil

import numpy as np
import pytest
from benchmarks.discovery import calculix, hide, outside
from benchmarks.discovery.case import plan
from benchmarks.discovery.measure import merged
from benchmarks.discovery.mesh import mesh
from benchmarks.discovery.outcome import Outcome
from benchmarks.discovery.score import score
from benchmarks.discovery.structures import STRUCTURES
from benchmarks.discovery.tables import claimed, goals, share
from benchmarks.discovery.truth import Field, Preload, Truth

HERE = [0.0, 0.0, 0.0]
TRUTH = {
    "dimension": 1000.0,
    "effects": [],
    "faults": [],
    "scatter": {},
    "expected": ["undecided", "parameters_only"],
    "may": [{"kind": "link_spring", "truth_node_xyz": HERE}],
}


def told(verdict, *kinds, x=0.0):
    """Return a result with findings of the model side at (x, 0, 0)."""
    where = {"xyz": [x, 0.0, 0.0]}
    findings = [{"side": "model", "kind": k, "where": where, "confidence": 0.9} for k in kinds]
    return {"verdict": verdict, "findings": findings}


@pytest.mark.parametrize(
    ("result", "solved", "claims"),
    [
        (told("parameters_only"), True, False),
        (told("undecided", "point_mass"), True, False),
        (told("no_gap"), False, False),
        (told("effect", "point_mass"), False, True),
        (told("effect", "link_spring"), True, False),
        (told("effect", "link_spring", x=101.0), False, True),
        (told("effect", "link_spring", "point_mass"), False, True),
        (told("effect"), False, True),
    ],
)
def test_what_is_said_of_a_cause_outside_the_list(result, solved, claims):
    s = score(TRUTH, result)
    assert (s.solved, s.claims) == (solved, claims)


def test_every_cause_is_drawn_for_some_structure():
    drawn = {
        cause
        for make in STRUCTURES.values()
        for family in outside.FAMILIES
        for cause in outside.possible(make(np.random.default_rng(1)), family)
    }
    assert drawn == set(outside.CAUSES)


def test_a_third_of_the_plans_are_outside_the_list():
    plans = [plan(seed) for seed in range(400)]
    alone = [p for p in plans if p.outside and not p.kinds]
    assert 100 < len(alone) < 165
    assert all(p.outside in outside.CAUSES for p in alone)


def modes_of(n_node: int, n_mode: int, seed: int) -> calculix.Modes:
    """Return made-up modes, far apart."""
    shapes = np.random.default_rng(seed).standard_normal((n_node, 3, n_mode))
    return calculix.Modes(10.0 * 1.3 ** np.arange(n_mode), shapes)


def test_runs_are_put_together_mode_by_mode():
    whole = modes_of(30, 5, 2)
    order = [1, 0, 3, 2, 4]
    other = calculix.Modes(1.01 * whole.hz[order], -whole.shapes[:, :, order])
    found = merged([whole, other], [np.arange(15), np.arange(15, 30)])
    np.testing.assert_allclose(found.shapes, whole.shapes)
    np.testing.assert_allclose(found.hz, 1.005 * whole.hz)


def test_a_model_error_scatters_frequencies_as_it_should():
    """The variance of ln f is ε²/2 where modes are far apart (first order)."""
    modes, size = modes_of(10, 8, 3), 0.01
    s = STRUCTURES["frame"](np.random.default_rng(1))
    m = mesh(s, 1, True)
    logs = []
    for seed in range(300):
        scene = hide.Scene(s, m, modes, np.random.default_rng(seed))
        felt = outside.diffuse(scene, size).felt
        assert felt is not None
        logs.append(np.log(felt(modes).hz / modes.hz))
    assert np.std(logs) == pytest.approx(size / np.sqrt(2.0), rel=0.06)


def outcome(name: str, scenario: str, result) -> Outcome:
    """Return what became of a case with a cause outside the list."""
    return Outcome(name, "frame", scenario, 3.0, score(TRUTH, result), "", cause="bow", shift=1.0)


def test_a_record_gives_back_what_was_written():
    one = outcome("7_frame_bow", "outside", told("effect", "point_mass"))
    again = Outcome.from_line(one.to_line())
    assert again == one
    assert again.score is not None
    assert claimed(again.score) == "point_mass"


def test_the_share_of_false_claims():
    cases = [outcome(str(k), "outside", told("undecided", "point_mass")) for k in range(3)]
    cases.append(outcome("3", "outside", told("effect", "point_mass")))
    assert f"false claims where no listed effect is | {share(1, 4)} |" in goals(cases)
    assert share(1, 4) == "1 of 4 = 25.0% (0.6% to 80.6%)"


needs_ccx = pytest.mark.skipif(shutil.which("ccx") is None, reason="CalculiX (ccx) is absent")


@pytest.fixture
def frame(tmp_path):
    """A frame, its mesh, and what solves it."""
    s = STRUCTURES["frame"](np.random.default_rng(1))
    m = mesh(s, 1, True)
    return s, m, lambda m, t: calculix.solve(s, m, t, tmp_path, 8)


@needs_ccx
def test_fields_and_loads_do_what_they_should(frame):
    _, m, solve = frame
    count = m.bars.shape[0]
    bare = solve(m, Truth())
    stiffer = solve(m, Truth(fields=(Field(np.full(count, 1.21)),)))
    np.testing.assert_allclose(stiffer.hz, 1.1 * bare.hz, rtol=1e-5)
    heavier = solve(m, Truth(fields=(Field(density=np.full(count, 1.44)),)))
    np.testing.assert_allclose(heavier.hz, bare.hz / 1.2, rtol=1e-5)
    hanging, standing = (solve(m, Truth(preload=Preload((0.0, 0.0, g)))).hz[0] for g in (4e5, -4e5))
    assert standing < bare.hz[0] < hanging
    assert standing + hanging == pytest.approx(2.0 * bare.hz[0], rel=1e-3)


@needs_ccx
@pytest.mark.parametrize("name", ["bow", "missing_member", "member_position", "brace"])
def test_a_cause_leaves_the_nodes_where_the_test_expects_them(name, frame):
    s, m, solve = frame
    bare = solve(m, Truth())
    cause = outside.CAUSES[name](hide.Scene(s, m, bare, np.random.default_rng(4)))
    modes = solve(cause.mesh, cause.truth)
    assert np.isfinite(modes.shapes[cause.mesh.used]).all()
    assert np.abs(modes.hz / bare.hz - 1.0).max() > 1e-4


def test_a_run_begins_again_where_it_was_left(monkeypatch, capsys, tmp_path):
    """What the record holds is neither made nor searched again, and stands in the tables."""
    from benchmarks.discovery import run

    record = tmp_path / "record.jsonl"
    record.write_text(outcome(plan(11).name, "outside", told("no_gap")).to_line() + "\n")
    line = ["", "--seeds", "11", "--record", str(record), "--cache", str(tmp_path)]
    monkeypatch.setattr("sys.argv", line)
    assert run.main() == 0
    assert not (tmp_path / "cases").exists()
    said = capsys.readouterr().out
    assert f"| false claims where no listed effect is | {share(0, 1)} |" in said
    assert json.loads(said.splitlines()[-1])["cases"] == 1
