"""Frequency responses of a test beside those of a deck: those of the same beam, and of another."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from tests.verbs.updating import test_response_update

import trueup

files = test_response_update.files


def test_the_deck_that_was_measured_is_met_and_another_is_not(
    files: tuple[Path, list[Path]], tmp_path: Path
):
    deck, paths = files
    same = trueup.correlate(tmp_path / "t.bdf", paths, deck_length_unit="mm")
    other = trueup.correlate(deck, paths, deck_length_unit="mm")
    assert same.responses is not None
    assert other.responses is not None
    frac = np.asarray(same.content.matrices["frac"])
    assert [r.frac for r in same.responses.functions] == frac.ravel().tolist()
    own = {(r.response, r.reference): r.frac for r in same.responses.functions}
    assert own["13:Z", "13:Z"] == frac[-1, -1] > 0.9
    assert same.responses.mean_frac == pytest.approx(frac.mean())
    assert same.responses.mean_frac > other.responses.mean_frac
    again = trueup.open_run(same.save(tmp_path / "run"))
    assert again.to_dict() == same.to_dict()
    told = (tmp_path / "run" / "tables" / "responses_functions.csv").read_text()
    assert told.count("\n") == 17


def test_modes_alone_tell_nothing_of_responses(files: tuple[Path, list[Path]], tmp_path: Path):
    told = trueup.correlate(tmp_path / "t.bdf", files[1][:1], deck_length_unit="mm")
    assert told.responses is None
    assert "responses" not in told.to_dict()


def test_expanded_shapes_are_a_universal_file(files: tuple[Path, list[Path]], tmp_path: Path):
    asked = {"deck_length_unit": "mm", "reduction": "serep"}
    told = trueup.correlate(tmp_path / "t.bdf", files[1][:1], **asked)
    told.save(tmp_path / "run")
    modes = trueup.read(tmp_path / "run" / "test_expanded.unv").modes
    expanded = told.content.modes["test expanded"]
    assert modes.frequencies_hz == pytest.approx(expanded.frequencies_hz, rel=1e-5)
    scale = np.abs(expanded.shapes).max()
    assert set(modes.dofs.node) == set(expanded.dofs.node) - {1}  # which is held
    assert np.abs(modes.shapes).max() == pytest.approx(scale, rel=1e-4)
