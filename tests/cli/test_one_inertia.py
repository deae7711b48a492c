"""A section that is wrong about one axis alone: that inertia is told, and nothing else changes."""

import json
from itertools import pairwise

import pytest

COLUMN, ARM = (17700.0, 14700.0), (8750.0, 8750.0)
GRID = {(0.0, 0.0, 150.0 * k): k + 1 for k in range(11)}
GRID |= {(100.0 * k, 50.0 * k, 1500.0): k + 11 for k in range(1, 5)}


def cranked(cut, column):
    """Cards of a clamped column with an arm, `cut` bars where the deck has one."""
    corners = (0.0, 0.0, 0.0), (0.0, 0.0, 1500.0), (400.0, 200.0, 1500.0)
    grids, bars = dict(GRID), []
    for pid, n, a, b in ((1, 10 * cut, *corners[:2]), (2, 4 * cut, *corners[1:])):
        line = [tuple(p + (q - p) * k / n for p, q in zip(a, b, strict=True)) for k in range(n + 1)]
        ids = [grids.setdefault(x, len(grids) + 1) for x in line]
        along = "1.,0.,0." if pid == 1 else "0.,0.,1."
        bars += [f"{pid},{g},{h},{along}" for g, h in pairwise(ids)]
    return [
        *(f"GRID,{k},,{x},{y},{z}" for (x, y, z), k in grids.items()),
        *(f"CBAR,{k},{bar}" for k, bar in enumerate(bars, 1)),
        "PBAR,1,1,440.,{},{},24000.".format(*column),
        "PBAR,2,1,324.,{},{},14800.".format(*ARM),
        "MAT1,1,210000.,,.3,7.85-9",
        "SPC1,1,123456,1",
        "PARAM,COUPMASS,1",
    ]


def write(path, cards):
    head = ["SOL 103", "CEND", "METHOD=1", "SPC=1", "BEGIN BULK", "EIGRL,1,,,12"]
    path.write_text("\n".join([*head, *cards, "ENDDATA"]) + "\n")
    return path


@pytest.mark.parametrize(("axis", "factor"), [(0, 1.35), (1, 0.7)])
def test_it_is_found_and_the_other_stays(axis, factor, tmp_path, call):
    deck, out = write(tmp_path / "deck.bdf", cranked(1, COLUMN)), tmp_path / "run"
    wrong = [v * (factor if k == axis else 1.0) for k, v in enumerate(COLUMN)]
    truth, test = write(tmp_path / "truth.bdf", cranked(2, wrong)), tmp_path / "truth.unv"
    assert call("solve", truth, "-n", 12, "--out", test, "--quiet").status == 0
    words = ("--deck-length-unit", "mm", "--out", out, "--quiet")
    assert call("discover", deck, test, *words).status == 0
    result = json.loads((out / "result.json").read_text())
    assert result["verdict"] == "parameters_only"
    moved = {p["name"]: p["factor"] for p in result["parameters"] if p["significant"]}
    assert moved == {f"PBAR 1 I{axis + 1}": pytest.approx(factor, rel=0.02)}
    diff = (out / "changes.diff").read_text().splitlines()
    changed = [line for line in diff if line.startswith("+") and not line.startswith("+++")]
    (card,) = changed
    fields = card.removeprefix("+").split(",")
    assert fields[0] == "PBAR"
    assert float(fields[5 - axis]) == COLUMN[1 - axis]
