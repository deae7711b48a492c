"""`trueup discover` on three small cases made by `benchmarks/discovery` (CalculiX, finer mesh).

Kept as files, so that they run where CalculiX is absent: a soft joint of a tower, a frame that
lacks nothing, a frame with a mass and a sensor of wrong gain.
"""

from __future__ import annotations

import json
from pathlib import Path

import pytest

HERE = Path(__file__).resolve().parent
CASES = sorted(p.parent for p in HERE.glob("cases/*/truth.json"))


KNOWN: dict[str, str] = {}
"""Cases that are not solved, and why; solved by chance they fail, so that they are taken out."""


def _case(place: Path) -> object:
    marks = [pytest.mark.xfail(reason=KNOWN[place.name])] if place.name in KNOWN else []
    return pytest.param(place, id=place.name, marks=marks)


@pytest.mark.slow
@pytest.mark.parametrize("place", [_case(p) for p in CASES])
def test_what_is_hidden_is_found(place, monkeypatch, tmp_path):
    monkeypatch.syspath_prepend(str(HERE.parents[1]))
    from benchmarks.discovery.run import line, search

    truth = json.loads((place / "truth.json").read_text())
    copy = tmp_path / place.name
    copy.mkdir()
    for file in place.iterdir():
        (copy / file.name).write_bytes(file.read_bytes())
    outcome = search(copy, truth, timeout=120.0)
    assert outcome.score is not None, outcome.note
    assert outcome.score.solved, line(outcome)


def test_the_score_refuses_what_is_wrong(monkeypatch):
    """A right kind at a wrong place, a wrong size or one finding too many is not solved."""
    monkeypatch.syspath_prepend(str(HERE.parents[1]))
    from benchmarks.discovery.score import score

    truth = {
        "dimension": 1000.0,
        "effects": [{"kind": "point_mass", "truth_node_xyz": [0.0, 0.0, 0.0], "mass": 1.0}],
        "faults": [],
        "scatter": {},
    }

    def found(x=0.0, mass=1.0, kind="point_mass", extra=()):
        finding = {
            "side": "model",
            "kind": kind,
            "where": {"xyz": [x, 0.0, 0.0]},
            "magnitude": {"mass": mass},
            "confidence": 0.9,
        }
        return score(truth, {"verdict": "effect", "findings": [finding, *extra]})

    assert found().solved
    assert found(x=99.0, mass=1.29).solved
    assert not found(x=101.0).solved
    assert not found(mass=1.31).solved
    assert not found(kind="distributed_mass").solved
    more = {"side": "model", "kind": "ground_spring", "where": {"xyz": [0.0, 0.0, 0.0]}}
    assert not found(extra=(more,)).solved
    assert not score(truth, {"verdict": "no_gap", "findings": []}).solved
