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


@pytest.fixture
def files(tmp_path: Path) -> tuple[Path, list[Path]]:
    """A deck, and the modes and accelerances of one with other E and G, solved directly."""
    deck, truth = written(tmp_path / "bar.bdf", CALM), stiffer(written(tmp_path / "t.bdf", TRUTH))
    solved = trueup.solve(truth, 6)
    model = build_model(trueup.read_deck(truth), damped=True)
    one = np.zeros(0)
    K, M, D, H = (getattr(model, x)(one).toarray() for x in "KMDH")
    label = {name: k for k, name in enumerate(model.free_labels)}
    at = [label[f"{n}:{c}"] for n in SENSORS for c in (2, 3)]
    hz = np.linspace(2.0, 300.0, 1200)
    values = []
    for w in 2.0 * np.pi * hz:
        Z = K + 1j * (H + w * D) - w**2 * M
        values.append(-(w**2) * np.linalg.solve(Z, np.eye(len(K))[:, at[-2:]])[at])
    nodes, components = np.repeat(SENSORS, 2), np.tile([2, 3], len(SENSORS))
    frfs = Frfs(hz, Dofs(nodes, components), Dofs([13, 13], [2, 3]), np.moveaxis(values, 0, 2))
    paths = [tmp_path / "modes.unv", tmp_path / "frfs.unv"]
    write_universal(paths[0], geometry=solved.content.geometry, modes=solved.shapes)
    write_universal(paths[1], geometry=solved.content.geometry, frfs=frfs)
    return deck, paths


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
