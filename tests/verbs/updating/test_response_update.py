"""Frequency responses of a dataset-58 file as what an update minimises."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from tests.verbs.updating.test_damping_update import DECK, written

import trueup
from trueup.adapters.nastran import build_model
from trueup.adapters.universal import write_universal
from trueup.core.data.dofs import Dofs
from trueup.core.data.frfs import Frfs
from trueup.core.errors import InputError

CALM = {**DECK, "tip": 2e-5, "bush": 1e-9, "alpha": 1e-9}
TRUTH = {**CALM, "g": 0.012}
SENSORS = (4, 7, 10, 13)


def stiffer(path: Path) -> Path:
    path.write_text(path.read_text().replace("MAT1,2,70000.", "MAT1,2,84000."))
    return path


def measured_on(truth: Path, number: int, hz: np.ndarray) -> list[Path]:
    """Modes and accelerances of a deck, solved directly."""
    solved = trueup.solve(truth, number)
    model = build_model(trueup.read_deck(truth), damped=True)
    one = np.zeros(0)
    K, M, D, H = (getattr(model, x)(one).toarray() for x in "KMDH")
    label = {name: k for k, name in enumerate(model.free_labels)}
    at = [label[f"{n}:{c}"] for n in SENSORS for c in (2, 3)]
    values = []
    for w in 2.0 * np.pi * hz:
        Z = K + 1j * (H + w * D) - w**2 * M
        values.append(-(w**2) * np.linalg.solve(Z, np.eye(len(K))[:, at[-2:]])[at])
    nodes, components = np.repeat(SENSORS, 2), np.tile([2, 3], len(SENSORS))
    frfs = Frfs(hz, Dofs(nodes, components), Dofs([13, 13], [2, 3]), np.moveaxis(values, 0, 2))
    paths = [truth.with_name("modes.unv"), truth.with_name("frfs.unv")]
    write_universal(paths[0], geometry=solved.content.geometry, modes=solved.shapes)
    write_universal(paths[1], geometry=solved.content.geometry, frfs=frfs)
    return paths


@pytest.fixture
def files(tmp_path: Path) -> tuple[Path, list[Path]]:
    """A deck, and what was measured on one with other E and G."""
    deck, truth = written(tmp_path / "bar.bdf", CALM), stiffer(written(tmp_path / "t.bdf", TRUTH))
    return deck, measured_on(truth, 6, np.linspace(2.0, 300.0, 1200))


def test_what_is_right_stays_where_it_is(tmp_path: Path) -> None:
    """A spring that moves responses by less than a per cent, four modes, damping that couples."""
    deck = written(tmp_path / "bar.bdf", CALM)
    deck.write_text(deck.read_text().replace("ENDDATA", "CELAS2,500,.005,9,3\nENDDATA"))
    test = measured_on(deck, 4, np.linspace(0.5, 180.0, 900))
    done = trueup.update(
        deck, test, ["CELAS2 500 K"], residuals="frfs", deck_length_unit="mm", regularisation=0.0
    )
    assert done.parameters[0].factor == pytest.approx(1.0, abs=0.01)
    assert done.parameters[0].standard_error < 0.02
    assert done.history[0].objective < 0.01


@pytest.mark.parametrize("residual", ["frfs", "antiresonances"])
def test_a_modulus_and_the_damping_come_from_responses(
    files: tuple[Path, list[Path]], residual: str
) -> None:
    moving = ["MAT1 2 E", "PARAM G"] if residual == "frfs" else ["MAT1 2 E"]
    stages = [
        {"parameters": ["MAT1 2 E"], "residuals": "frequencies"},
        {"parameters": moving, "residuals": residual, "max_iterations": 30},
    ]
    done = trueup.update(*files, moving, stages=stages, deck_length_unit="mm", regularisation=0.0)
    factors = [p.factor for p in done.parameters]
    np.testing.assert_allclose(factors, [1.2, 3.0][: len(moving)], rtol=0.01)


def test_modes_alone_are_no_responses(files: tuple[Path, list[Path]]) -> None:
    deck, (modes, _) = files
    with pytest.raises(InputError, match="and the test holds none"):
        trueup.update(deck, modes, "MAT1 2 E", residuals="frfs", deck_length_unit="mm")
