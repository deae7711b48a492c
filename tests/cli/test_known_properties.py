"""A mass or a spring that the deck has with a wrong value is no missing effect."""

import json
from pathlib import Path

import pytest

CASES = Path(__file__).resolve().parents[2].parent / "shared" / "data" / "cases"

pytestmark = [
    pytest.mark.slow,
    pytest.mark.skipif(not CASES.is_dir(), reason="../shared/data is absent"),
]

SPRING = "CELAS2,90001,7.,541,3\n"
BUSH = "PBUSH,900,K,1.,1.,7.\nCBUSH,90001,900,541,,,,,0\n"
MASSES = "CONM2,90001,612,,.0002\nCONM2,90002,611,,.0002\n"


@pytest.mark.parametrize(
    ("case", "cards", "name", "value", "truth"),
    [
        ("panel_spring", SPRING, "CELAS2 90001 K", 7.0, 15.0),
        ("panel_spring", BUSH, "PBUSH 900 K3", 7.0, 15.0),
        ("wheel_mass", MASSES, "CONM2 90001 M and 1 alike", 2e-4, 4e-4),
    ],
)
def test_a_wrong_value_that_the_deck_has_moves_and_nothing_is_missing(
    case, cards, name, value, truth, tmp_path
):
    """The spring of 15 N/mm, or the mass of 0.8 kg, is in the deck, but too small.

    What is left of the deviation is up to 1 %, the mesh.
    """
    from trueup.cli.app import app

    stem, folder, out = case.split("_")[0], tmp_path / "deck", tmp_path / "run"
    folder.mkdir()
    for path in (CASES / case).glob("*.bdf"):
        (folder / path.name).write_bytes(path.read_bytes())
    with (folder / "properties.bdf").open("a") as file:
        file.write(cards)
    test = CASES / case / f"{stem}_test.unv"
    words = ["discover", str(folder / f"{stem}.bdf"), str(test), "--deck-length-unit", "mm"]
    app([*words, "--out", str(out), "--quiet"], standalone_mode=False)
    result = json.loads((out / "result.json").read_text())
    assert result["verdict"] == "parameters_only"
    assert result["findings"] == []
    moved = {p["name"]: p for p in result["parameters"]}
    assert moved[name]["significant"]
    assert moved[name]["initial"][0] == value
    assert moved[name]["updated"][0] == pytest.approx(truth, rel=0.1)
    before, after = (result["gap"][k]["mean_abs_deviation_percent"] for k in ("before", "after"))
    assert after < min(0.5 * before, 1.0)
