"""Supports that give: an edge that turns, the feet of a table all alike, one that sinks."""

import json

import pytest

TURNS = 1.0e6
"""What an edge or the feet turn by in the truth, all together [N mm/rad]."""


def plate(springs):
    """Cards of a plate with a rib, its edge x = 0 clamped, or turning on `springs`."""
    nx, ny = 12, 8
    cards = [
        f"GRID,{1 + i + (nx + 1) * j},,{50.0 * i},{50.0 * j},0."
        for j in range(ny + 1)
        for i in range(nx + 1)
    ]
    corners = [1 + i + (nx + 1) * j for j in range(ny) for i in range(nx)]
    cards += [
        f"CQUAD4,{k},{1 + (k > 48)},{a},{a + 1},{a + nx + 2},{a + nx + 1}"
        for k, a in enumerate(corners, 1)
    ]
    rib = range(5 * (nx + 1) + 1, 6 * (nx + 1))
    cards += [f"CBAR,{900 + a},3,{a},{a + 1},0.,0.,1." for a in rib]
    cards += ["PSHELL,1,1,4.,1,,1", "PSHELL,2,1,5.,1,,1", "PBAR,3,2,196.,3201.,3201.,5400."]
    cards += [f"MAT1,{k},70000.,,.33,2.7-9" for k in (1, 2)]
    edge = [1 + (nx + 1) * j for j in range(ny + 1)]
    return cards + held(edge, (5,), springs)


def table(springs):
    """Cards of a table of bars on four clamped feet, or on feet that turn on `springs`."""
    corners = ((0.0, 0.0), (500.0, 0.0), (500.0, 300.0), (0.0, 300.0))
    cards, k = [], 0
    for foot, (x, y) in enumerate(corners):
        cards += [f"GRID,{10 * foot + n + 1},,{x},{y},{100.0 * n}" for n in range(5)]
        for n in range(1, 5):
            k += 1
            cards.append(f"CBAR,{k},1,{10 * foot + n},{10 * foot + n + 1},1.,1.,0.")
    for foot, ((x, y), (u, v)) in enumerate(zip(corners, corners[1:] + corners[:1], strict=True)):
        middle, first, last = 50 + foot, 10 * foot + 5, 10 * ((foot + 1) % 4) + 5
        cards.append(f"GRID,{middle},,{0.5 * (x + u)},{0.5 * (y + v)},400.")
        for a, b in ((first, middle), (middle, last)):
            k += 1
            cards.append(f"CBAR,{k},2,{a},{b},0.,0.,1.")
    cards += ["PBAR,1,1,440.,17700.,14700.,24000.", "PBAR,2,2,324.,8750.,8750.,14800."]
    cards += [f"MAT1,{k},210000.,,.3,7.85-9" for k in (1, 2)]
    return cards + held([1, 11, 21, 31], (4, 5, 6), springs) + ["PARAM,COUPMASS,1"]


def held(grids, components, springs):
    """Clamp grids, but for what turns."""
    fixed = "".join(c for c in "123456" if not springs or int(c) not in components)
    own = [f"SPC1,1,{fixed},{g}" for g in grids]
    if springs:
        own += [
            f"CELAS2,{5000 + 10 * g + c},{springs / len(grids)},{g},{c}"
            for g in grids
            for c in components
        ]
    return own


def write(path, cards):
    head = ["SOL 103", "CEND", "METHOD=1", "SPC=1", "BEGIN BULK", "EIGRL,1,,,12"]
    path.write_text("\n".join([*head, *cards, "ENDDATA"]) + "\n")
    return path


@pytest.mark.slow
@pytest.mark.parametrize(("structure", "where"), [(plate, (9, [5])), (table, (4, [4, 5, 6]))])
def test_all_of_them_are_found_together_and_sized(structure, where, tmp_path, call):
    deck, out = write(tmp_path / "deck.bdf", structure(None)), tmp_path / "run"
    truth = write(tmp_path / "truth.bdf", structure(TURNS))
    test = tmp_path / "truth.unv"
    assert call("solve", truth, "-n", 12, "--out", test, "--quiet").status == 0
    words = ("--deck-length-unit", "mm", "--out", out, "--quiet")
    assert call("discover", deck, test, *words).status == 0
    result = json.loads((out / "result.json").read_text())
    assert result["verdict"] == "effect"
    (finding,) = (f for f in result["findings"] if f["side"] == "model")
    assert finding["kind"] == "support_flexibility"
    assert (len(finding["where"]["grids"]), finding["magnitude"]["components"]) == where
    assert finding["magnitude"]["stiffness"] == pytest.approx(TURNS, rel=0.35)


@pytest.mark.slow
def test_a_foot_that_sinks_takes_its_mass_and_its_sensor_along(tmp_path, call):
    """It was 0.7 of its stiffness and in doubt while its mass and its sensor stood still."""
    deck, truth = table(None), [c for c in table(None) if c != "SPC1,1,123456,11"]
    truth += ["SPC1,1,12456,11", "CELAS2,5000,10000.,11,3"]
    deck, truth = write(tmp_path / "deck.bdf", deck), write(tmp_path / "truth.bdf", truth)
    test, out = tmp_path / "truth.unv", tmp_path / "run"
    assert call("solve", truth, "-n", 12, "--out", test, "--quiet").status == 0
    words = ("--deck-length-unit", "mm", "--out", out, "--quiet")
    assert call("discover", deck, test, *words).status == 0
    result = json.loads((out / "result.json").read_text())
    assert result["verdict"] == "effect"
    (finding,) = result["findings"]
    assert finding["kind"] == "support_flexibility"
    assert finding["where"]["grids"] == [11]
    assert finding["magnitude"]["components"] == [3]
    assert finding["magnitude"]["stiffness"] == pytest.approx(1.0e4, rel=0.1)
    assert result["gap"]["after"]["mean_abs_deviation_percent"] < 0.5
