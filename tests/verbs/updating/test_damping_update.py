"""Damping of a deck moved to a test's: loss factors, dashpots and PARAM G, back to their cards."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import trueup
from trueup.adapters.nastran import build_model, parse_parameter
from trueup.core.data.measurement import Measurement
from trueup.core.data.modes import Modes
from trueup.core.errors import InputError

LENGTH, PARTS = 1000.0, 12
DECK = {"g": 0.004, "steel": 0.01, "glue": 0.05, "tip": 2e-4, "bush": 4e-4, "alpha": 1e-5}
TRUTH = {"g": 0.006, "steel": 0.01, "glue": 0.02, "tip": 5e-4, "bush": 1e-4, "alpha": 3e-5}
PARAMETERS = {
    "g": "PARAM G",
    "glue": "MAT1 2 GE",
    "tip": "PDAMP 7 B",
    "bush": "PBUSH 8 B2",
    "alpha": "all stiffness = PARAM ALPHA2",
}
ASKED = {"deck_length_unit": "mm", "regularisation": 0.0, "residuals": "frequencies, damping"}


def bulk(g: float, steel: float, glue: float, tip: float, bush: float, alpha: float) -> str:
    xyz = np.linspace(0.0, LENGTH, PARTS + 1)
    rows = [f"GRID,{k + 1},,{x:.4f},0.,0." for k, x in enumerate(xyz)]
    rows += [f"CBAR,{k + 1},{1 + (k > 7)},{k + 1},{k + 2},0.,0.,1." for k in range(PARTS)]
    rows += ["PBAR,1,1,200.,6000.,9000.,12000.", "PBAR,2,2,200.,6000.,9000.,12000."]
    rows += [f"MAT1,1,70000.,,0.3,2.7-9,,,{steel}", f"MAT1,2,70000.,,0.3,2.7-9,,,{glue}"]
    rows += [f"PDAMP,7,{tip}", "CDAMP1,70,7,13,3", "CBUSH,80,8,7,,,,,0"]
    rows += ["PBUSH,8,K,1.,2.,1.", f",,B,,{bush}", f"PARAM,G,{g}", f"PARAM,ALPHA2,{alpha}"]
    rows += ["SPC1,1,123456,1", "EIGRL,1,,,10"]
    return "SOL 103\nCEND\nSPC = 1\nMETHOD = 1\nBEGIN BULK\n" + "\n".join(rows) + "\nENDDATA\n"


def written(path: Path, values: dict[str, float]) -> Path:
    path.write_text(bulk(**values))
    return path


def direct(path: Path, hz: np.ndarray) -> np.ndarray:
    """Poles near frequencies, of the whole matrices as the guide says they are made."""
    deck = trueup.read_deck(path)
    values = dict(TRUTH)
    model = build_model(deck)
    K, M = model.K().toarray(), model.M().toarray()
    parts = {n: build_model(trueup.read_deck(written(path.with_name(f"{n}.bdf"), values)),
                            [parse_parameter(f"MAT1 {n} E")]) for n in (1, 2)}  # fmt: skip
    loss = {n: parts[n].dK(0, np.ones(1)).toarray() for n in parts}
    H = TRUTH["g"] * K + TRUTH["steel"] * loss[1] + TRUTH["glue"] * loss[2]
    D = TRUTH["alpha"] * K
    place = {label: k for k, label in enumerate(model.free_labels)}
    for label, value in (("13:3", TRUTH["tip"]), ("7:2", TRUTH["bush"])):
        D[place[label], place[label]] += value
    inverse, n = np.linalg.inv(K + 1j * H), len(K)
    periods = np.linalg.eigvals(
        np.block([[np.zeros((n, n)), np.eye(n)], [-inverse @ M, -inverse @ D]])
    )
    found = 1.0 / periods[np.abs(periods) > 1e-8 * np.abs(periods).max()]
    found = found[found.imag > 0.0]
    near = np.abs(np.abs(found) - 2.0 * np.pi * hz[:, None]).argmin(axis=1)
    assert len({*near}) == len(hz)
    return found[near]


@pytest.fixture
def files(tmp_path: Path) -> tuple[Path, Measurement]:
    deck, truth = written(tmp_path / "bar.bdf", DECK), written(tmp_path / "truth.bdf", TRUTH)
    solved = trueup.solve(truth, 8)
    modes = solved.shapes
    poles = direct(truth, modes.frequencies_hz)
    seen = Modes(modes.frequencies_hz, modes.shapes, modes.dofs, -poles.real / np.abs(poles))
    return deck, Measurement(solved.content.geometry, seen, length_unit="mm")


def test_every_kind_of_damping_is_found_and_only_its_cards_change(
    files: tuple[Path, Measurement], tmp_path: Path
) -> None:
    deck, test = files
    done = trueup.update(deck, test, [*PARAMETERS.values()], max_iterations=20, **ASKED)
    for row, (name, said) in zip(done.parameters, PARAMETERS.items(), strict=True):
        assert row.name == said.partition(" =")[0]
        assert row.updated[0] == pytest.approx(TRUTH[name], rel=1e-3), name
    assert done.damping is not None
    for row in done.damping:
        assert row.after == pytest.approx(row.test_percent, rel=1e-3)
        assert abs(row.before / row.test_percent - 1.0) > 0.02
    done.save(tmp_path / "run")
    before = deck.read_text().splitlines()
    after = (tmp_path / "run" / "deck" / "bar.bdf").read_text().splitlines()
    changed = {line.split(",")[0] for line in before if line not in after}
    assert changed == {"PARAM", "MAT1", "PDAMP", ""}
    assert "Damping ratios" in (tmp_path / "run" / "report.html").read_text(encoding="utf-8")
    again = trueup.open_run(tmp_path / "run").damping
    assert [r.after for r in again] == [r.after for r in done.damping]


def test_tables_of_modal_damping_and_direct_matrices_count(
    files: tuple[Path, Measurement],
) -> None:
    """The dashpot at the tip as B2GG, and 0.2 % of every mode by SDAMPING."""
    deck, test = files
    text = deck.read_text().replace("METHOD = 1\n", "METHOD = 1\nSDAMPING = 3\nB2GG = 2.*TIP\n")
    for old in (f"PDAMP,7,{DECK['tip']}\n", "CDAMP1,70,7,13,3\n"):
        assert old in text
        text = text.replace(old, "")
    more = f"DMIG,TIP,0,6,1,0\nDMIG,TIP,13,3,,13,3,{TRUTH['tip'] / 2}\n"
    deck.write_text(
        text.replace("ENDDATA", more + "TABDMP1,3,CRIT\n,0.,.002,1000.,.002,ENDT\nENDDATA")
    )
    modes = test.modes
    higher = replace(test, modes=replace(modes, damping=modes.damping + 0.002))
    left = [text for name, text in PARAMETERS.items() if name != "tip"]
    done = trueup.update(deck, higher, left, max_iterations=20, **ASKED)
    for row, name in zip(done.parameters, [n for n in PARAMETERS if n != "tip"], strict=True):
        assert row.updated[0] == pytest.approx(TRUTH[name], rel=5e-3), name


@pytest.mark.parametrize(
    ("change", "parameter", "says"),
    [
        ({"PARAM,G,0.004\n": ""}, "PARAM G", r"there is no PARAM G in the deck"),
        ({}, "PARAM POST", "PARAM has no value 'POST'"),
        ({"PARAM,G,0.004": "PARAM,G,0."}, "PARAM G", "G is zero on PARAM G"),
        ({"PARAM,G,0.004": "PARAM,G,0.004\nPARAM,G,0.004"}, "PARAM G", "stands 2 times"),
        ({}, "PARAM G, PARAM G", "names PARAM G twice"),
    ],
)
def test_a_param_that_cannot_move(
    files: tuple[Path, Measurement], change: dict[str, str], parameter: str, says: str
) -> None:
    deck, test = files
    for old, new in change.items():
        deck.write_text(deck.read_text().replace(old, new))
    with pytest.raises(InputError, match=says):
        trueup.update(deck, test, parameter, **ASKED)


def test_damping_that_no_ratio_tells_stays(files: tuple[Path, Measurement]) -> None:
    deck, test = files
    done = trueup.update(
        deck, test, ["MAT1 1 E", "PARAM G"], residuals="frequencies", deck_length_unit="mm"
    )
    assert done.parameters[1].updated == done.parameters[1].initial
    assert any("PARAM G stays as in the deck" in w for w in done.warnings)
