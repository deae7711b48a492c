"""A deck that is far too stiff or light: its lowest modes lie above those of the test."""

import json

CASE = "SOL 103\nCEND\nSPC=1\nMETHOD=1\nDISP=ALL\nBEGIN BULK\nEIGRL,1,,,3\n"


def mast(tip):
    """Cards of a clamped mast of round bars with a heavy tip, or without."""
    cards = [f"GRID,{k + 1},,{20.0 * k},0.,0." for k in range(7)]
    cards += [f"CBAR,{k},1,{k},{k + 1},0.,1.,0." for k in range(1, 7)]
    cards += ["PBAR,1,1,314.,7854.,7854.,15708.", "MAT1,1,70000.,,.33,2.7-9", "SPC1,1,123456,1"]
    return CASE + "\n".join([*cards, *([f"CONM2,99,7,,{tip}"] if tip else [])]) + "\nENDDATA\n"


def test_a_test_below_every_mode_of_the_deck_ends_in_a_verdict(tmp_path, call):
    deck, truth, test = (tmp_path / n for n in ("mast.bdf", "truth.bdf", "test.unv"))
    deck.write_text(mast(0.0))
    truth.write_text(mast(5.0e-3))
    assert call("solve", truth, "-n", 3, "--out", test, "-q").status == 0
    out = tmp_path / "run"
    said = call("discover", deck, test, "--deck-length-unit", "mm", "--out", out, "-q")
    assert said.status == 0, said.err
    assert json.loads((out / "result.json").read_text())["verdict"] in {"effect", "undecided"}
