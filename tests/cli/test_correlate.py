"""``trueup correlate`` on the duct: rotation of close modes is what makes it correlate."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from trueup.adapters.store import read_store

CORRELATION = {
    "pairs", "unpaired_test", "unpaired_analysis", "clusters", "mac", "mac_rotated", "alignment",
    "warnings",
}  # fmt: skip
PAIR = {
    "test", "analysis", "test_hz", "analysis_hz", "deviation_percent", "mac", "cluster",
    "rotation_deg",
}  # fmt: skip
HARMONICS = {
    "test_harmonic",
    "test_orientation_deg",
    "analysis_harmonic",
    "analysis_orientation_deg",
}
DAMPING = {"test_damping", "analysis_damping", "test_mpc"}

Call = Callable[..., Any]


@pytest.fixture(scope="module")
def runs(call: Call, duct: Path, tmp_path_factory: pytest.TempPathFactory) -> dict[str, Any]:
    """Answer, result and run folder of a correlation as it is and one after rotation."""
    base, done = tmp_path_factory.mktemp("correlate"), {}
    for rotate in ("none", "analysis"):
        folder = base / rotate
        said = call("correlate", duct / "duct.bdf", duct / "duct_test.unv", "--rotate", rotate,
                    "--out", folder, "--json", "-")  # fmt: skip
        assert said.status == 0, said.err
        done[rotate] = (said, json.loads(said.out), folder)
    return done


def test_rotation_at_least_doubles_the_pairs(runs: dict[str, Any]) -> None:
    plain, rotated = (runs[k][1]["pairs"] for k in ("none", "analysis"))
    assert len(plain) >= 3
    assert len(rotated) >= 2 * len(plain)
    assert {p["test"] for p in rotated} >= {1, 2, 3, 4, 5, 6}


def test_without_rotation_nothing_is_turned(runs: dict[str, Any]) -> None:
    result = runs["none"][1]
    assert result["clusters"] == []
    assert result["mac"] == result["mac_rotated"]
    assert all(p["cluster"] is None and p["rotation_deg"] is None for p in result["pairs"])


def test_the_result_says_what_the_interface_promises(runs: dict[str, Any]) -> None:
    result = runs["analysis"][1]
    assert result["schema"] == "trueup/correlate/1"
    assert set(result) >= CORRELATION
    assert all(set(p) == PAIR | DAMPING | HARMONICS for p in result["pairs"])
    assert set(result["mac"]) == {"test", "analysis", "values"}
    sensor = result["alignment"]["sensors"][0]
    assert set(sensor) >= {"node", "direction", "nearest_grid", "distance"}
    assert set(result["alignment"]) >= {"rotation", "translation", "scale", "rms", "sensors"}


def test_pairs_mac_and_clusters_agree_with_each_other(runs: dict[str, Any]) -> None:
    result = runs["analysis"][1]
    mac = result["mac_rotated"]
    values = np.array(mac["values"])
    assert values.shape == (len(mac["test"]), len(mac["analysis"]))
    clusters = {c["id"]: c for c in result["clusters"]}
    for p in result["pairs"]:
        seen = values[mac["test"].index(p["test"]), mac["analysis"].index(p["analysis"])]
        assert p["mac"] == pytest.approx(seen, abs=1e-12)
        assert 0.7 <= p["mac"] <= 1.0
        off = 100.0 * (p["analysis_hz"] - p["test_hz"]) / p["test_hz"]
        assert p["deviation_percent"] == pytest.approx(off, rel=1e-12)
        assert abs(off) <= 30.0
        assert p["cluster"] is None or p["analysis"] in clusters[p["cluster"]]["analysis"]
    for c in result["clusters"]:
        hz = [result["analysis_hz"][a - 1] for a in c["analysis"]]
        assert (max(hz) - min(hz)) / max(hz) <= 0.02
    for side in ("test", "analysis"):
        paired = [p[side] for p in result["pairs"]]
        assert len(paired) == len(set(paired))
        assert not set(paired) & set(result[f"unpaired_{side}"])
    modes = [*result["unpaired_test"], *(p["test"] for p in result["pairs"])]
    assert sorted(modes) == list(range(1, 25))


def test_rotation_keeps_what_a_cluster_explains(runs: dict[str, Any]) -> None:
    """Turning within a cluster moves MAC between its members and makes none of it."""
    result = runs["analysis"][1]
    plain, turned = (np.array(result[k]["values"]) for k in ("mac", "mac_rotated"))
    alone = [a - 1 for a in result["mac"]["analysis"]
             if all(a not in c["analysis"] for c in result["clusters"])]  # fmt: skip
    np.testing.assert_allclose(turned[:, alone], plain[:, alone], atol=1e-12)
    assert turned.max() <= 1.0


def test_metres_of_the_test_become_millimetres_of_the_deck(runs: dict[str, Any]) -> None:
    alignment = runs["analysis"][1]["alignment"]
    assert alignment["scale"] == pytest.approx(1000.0)
    assert max(s["distance"] for s in alignment["sensors"]) < 10.0
    assert len({s["node"] for s in alignment["sensors"]}) == 70


def test_the_run_folder_is_whole(runs: dict[str, Any]) -> None:
    _, result, folder = runs["analysis"]
    assert {p.name for p in folder.iterdir()} == {
        "result.json", "result.h5", "report.html", "study.toml", "tables",
    }  # fmt: skip
    assert json.loads((folder / "result.json").read_text()) == result
    content = read_store(folder / "result.h5")
    assert set(content.modes) == {"test", "analysis"}
    np.testing.assert_allclose(content.modes["test"].frequencies_hz, result["test_hz"])
    assert not [p for p in folder.parent.iterdir() if p.name.startswith(".")]


def test_json_on_standard_output_stands_alone(runs: dict[str, Any]) -> None:
    for said, _, _ in runs.values():
        assert said.out.startswith("{")
        assert said.out.endswith("}\n")


def test_the_report_stands_alone_and_is_made_again(
    runs: dict[str, Any], call: Call, tmp_path: Path
) -> None:
    folder = runs["analysis"][2]
    page = (folder / "report.html").read_text(encoding="utf-8")
    assert page.startswith("<!doctype html>") or page.startswith("<!DOCTYPE html>")
    for reach in ('src="http', "src='http", 'href="http', "@import", "fetch("):
        assert reach not in page
    (folder / "report.html").unlink()
    said = call("report", folder)
    assert said.status == 0, said.err
    assert (folder / "report.html").read_text(encoding="utf-8") == page


def test_an_existing_run_folder_is_kept_unless_forced(
    runs: dict[str, Any], call: Call, duct: Path
) -> None:
    folder = runs["none"][2]
    before = {p: p.read_bytes() for p in folder.rglob("*") if p.is_file()}
    said = call("correlate", duct / "duct.bdf", duct / "duct_test.unv", "--out", folder)
    assert said.status == 1
    assert "exists; give --force" in said.sentence
    assert {p: p.read_bytes() for p in folder.rglob("*") if p.is_file()} == before
    (folder / "notes.txt").write_text("mine")
    again = call("correlate", "--study", folder / "study.toml", "--out", folder, "--force",
                 "--quiet")  # fmt: skip
    assert (again.status, again.out, again.err) == (0, "", "")
    assert (folder / "notes.txt").read_text() == "mine"
    (folder / "notes.txt").unlink()
    assert (folder / "result.json").read_bytes() == before[folder / "result.json"]


def test_force_never_replaces_what_is_no_run_folder(call: Call, duct: Path, tmp_path: Path) -> None:
    (tmp_path / "precious").mkdir()
    (tmp_path / "precious" / "thesis.txt").write_text("do not lose")
    said = call("correlate", duct / "duct.bdf", duct / "duct_test.unv", "--force",
                "--out", tmp_path / "precious")  # fmt: skip
    assert said.status == 1
    assert "is not a run folder" in said.sentence
    assert (tmp_path / "precious" / "thesis.txt").read_text() == "do not lose"
