"""``parameters``: what a deck holds that may move, and what modes say of it before it does."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest

import trueup
from trueup.core.errors import InputError


@pytest.fixture(scope="module")
def duct():
    return Path(__file__).resolve().parents[3] / "fixtures" / "duct"


@pytest.fixture(scope="module")
def told(duct):
    files = str(duct / "duct.bdf"), str(duct / "duct_test.unv")
    flanges = ["PBAR 11 I1, PBAR 11 I2", "PBAR 12 I1, PBAR 12 I2", "MAT1 1 E", "MAT1 1 RHO"]
    return trueup.parameters(*files, flanges, residuals="frequencies", deck_length_unit="mm")


def test_properties_are_those_of_the_deck(told):
    by_card = {(p.card, p.id): p for p in told.properties}
    assert by_card["PSHELL", 1].values["T"] == 1.6
    assert by_card["PSHELL", 1].elements == 1842
    assert by_card["MAT1", 1].elements == 2058
    assert by_card["PBAR", 11].values["I1"] == 9000.0


def test_frequencies_go_with_the_root_of_modulus_over_density(told):
    """Bars of other materials have little of the energy: nearly one half, and minus that."""
    table = dict(zip(told.sensitivities.parameters, told.sensitivities.values.T, strict=True))
    assert np.abs(table["MAT1 1 E"] - 0.5).max() < 0.02
    assert np.abs(table["MAT1 1 RHO"] + 0.5).max() < 0.05


def test_slopes_are_those_of_solutions_nearby(told, duct):
    """Central differences of two solutions, 1 % up and down."""
    from trueup.adapters.nastran import build_model, parse_parameter, read_deck
    from trueup.core.eigen.normal_modes import solve

    model = build_model(read_deck(duct / "duct.bdf"), [parse_parameter("MAT1 1 E")])
    up, down = (solve(model, n_modes=12, p=np.array([p])).frequencies_hz[6:] for p in (1.01, 0.99))
    slope = np.log(up / down) / np.log(1.01 / 0.99)
    modes = trueup.parameters(str(duct / "duct.bdf"), parameters="MAT1 1 E").sensitivities
    assert modes.modes[:6] == (7, 8, 9, 10, 11, 12)
    np.testing.assert_allclose(modes.values[:6, 0], slope, rtol=1e-3)


def test_modulus_and_density_are_not_told_apart(told):
    group = {c.name: c.group for c in told.candidates}
    assert group["MAT1 1 E"] == group["MAT1 1 RHO"]
    assert group["PBAR 11 I1, PBAR 11 I2"] != group["MAT1 1 E"]
    cosines = told.likeness.values
    assert cosines[2, 3] == pytest.approx(-1.0, abs=0.01)


def test_the_wrong_flange_is_recommended_first(told):
    assert told.recommended[0] == "PBAR 11 I1, PBAR 11 I2"
    assert not {"MAT1 1 E", "MAT1 1 RHO"} <= {*told.recommended}
    first = next(c for c in told.candidates if c.recommended == 1)
    assert 0.5 < first.explained <= 1.0


def test_the_answer_is_plain(told, tmp_path):
    told.save(tmp_path / "run")
    again = json.loads((tmp_path / "run" / "result.json").read_text())
    assert again["schema"] == "trueup/parameters/1"
    assert {p.name for p in (tmp_path / "run" / "tables").iterdir()} == {
        f"{name}.csv"
        for name in (
            "properties",
            "candidates",
            "combinations",
            "sensitivities",
            "likeness",
            "inputs",
        )
    }


def test_without_a_test_the_modes_of_the_deck_speak(duct):
    found = trueup.parameters(str(duct / "duct.bdf"))
    assert len(found.candidates) > 20
    assert found.test_files == ()
    assert all(c.explained is None for c in found.candidates)
    names = [c.name for c in found.candidates]
    assert set(found.recommended) <= {*names}


@pytest.mark.parametrize(
    ("given", "said"),
    [
        ({"parameters": "PSHELL 9 T"}, "PSHELL 9"),
        ({"residuals": "sound"}, "sound"),
        ({"mac": 1}, "mac"),
    ],
)
def test_bad_input_is_one_sentence(duct, given, said):
    with pytest.raises(InputError, match=said):
        trueup.parameters(str(duct / "duct.bdf"), **given)


def test_its_page_shows_matrices_and_the_parameters_on_the_structure(told, duct, tmp_path):
    """Flange rings are where their bars are; the skin's modulus is everywhere."""
    model = trueup.read_deck(duct / "duct.bdf").bulk
    ring = {g for b in model.table("CBAR").values() if b.pid == 11 for g in b.nodes[:2]}
    assert set(told.places["PBAR 11 I1, PBAR 11 I2"]) == ring
    assert len(told.places["MAT1 1 E"]) == len(told.geometry.ids)
    page = (told.save(tmp_path / "run") / "report.html").read_text(encoding="utf-8")
    assert "Sensitivity of each mode" in page
    assert "Cosines between what parameters do" in page
    assert page.count("<title>") == 1
    for name in told.sensitivities.parameters:
        assert page.count(name) >= 4  # table, both matrices, structure
