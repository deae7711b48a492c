"""A kind of effect that trueup does not have: registered from outside, found, told, written."""

from __future__ import annotations

import re

import numpy as np
import pytest

import trueup
from trueup.adapters.nastran import build_model, read_deck
from trueup.adapters.nastran.discovery.writers import WRITERS, register_writer
from trueup.core.data.dofs import Dofs
from trueup.core.data.geometry import Geometry
from trueup.core.data.measurement import Measurement
from trueup.core.data.modes import Modes
from trueup.core.discovery.effects import KINDS, register_effect
from trueup.core.eigen import normal_modes
from trueup.core.errors import InputError

MASS, GRID = 4.0e-4, 9
"""What slides along x on a grid [t]; the bracket has 5.3e-3."""


def bracket() -> str:
    """A bent cantilever [mm, t, N, s] of fifteen bars: up, sideways and forward."""
    steps = [(0.0, 0.0, 90.0)] * 7 + [(0.0, 85.0, 0.0)] * 5 + [(80.0, 0.0, 0.0)] * 3
    places = np.cumsum([(0.0, 0.0, 0.0), *steps], axis=0)
    grids = [f"GRID,{k},,{x},{y},{z}" for k, (x, y, z) in enumerate(places, 1)]
    bars = [
        f"CBAR,{k},1,{k},{k + 1},{'1.,0.,0.' if k < 13 else '0.,0.,1.'}"
        for k in range(1, len(places))
    ]
    return "\n".join(
        [
            "SOL 103", "CEND", "SPC = 1", "BEGIN BULK", "PARAM,COUPMASS,1", *grids, *bars,
            "PBAR,1,1,500.,12000.,32000.,30000.", "MAT1,1,2.1+5,,.3,7.85-9",
            "SPC1,1,123456,1", "ENDDATA",
        ]
    )  # fmt: skip


def measured(deck) -> Measurement:
    """The lowest modes of a deck at every grid, three directions, with scatter."""
    rng, model = np.random.default_rng(5), build_model(deck)
    modes = normal_modes.modes_of(model, normal_modes.solve(model, n_modes=12))
    along = np.flatnonzero(model.dofs.component < 4)
    shapes = modes.shapes[along] / np.abs(modes.shapes[along]).max(axis=0)
    shapes += 0.004 * rng.standard_normal(shapes.shape)
    hz = modes.frequencies_hz * (1.0 + 5e-4 * rng.standard_normal(len(modes)))
    dofs = Dofs(model.dofs.node[along], model.dofs.component[along])
    geometry = Geometry(model.geometry.ids, model.geometry.xyz)
    return Measurement(geometry, Modes(hz, shapes, dofs), length_unit="mm")


@pytest.fixture
def sliding(documented):
    """What docs/extending.md adds, gone again after the test."""
    yield documented("A kind of effect")["SLIDE"]
    KINDS.pop("sliding_mass")
    WRITERS.pop("sliding_mass")


def test_it_is_found_told_written_and_the_completed_deck_solves_to_the_test(sliding, tmp_path):
    known, whole = tmp_path / "bracket.bdf", tmp_path / "whole.bdf"
    known.write_text(bracket())
    whole.write_text(bracket().replace("ENDDATA", f"CMASS2,900,{MASS},{GRID},1\nENDDATA"))
    told = trueup.discover(known, measured(read_deck(whole)), deck_length_unit="mm")
    assert told.verdict == "effect"
    (finding,) = told.findings
    assert finding.kind == "sliding_mass"
    assert (list(finding.where.grids), finding.magnitude["components"]) == ([GRID], [1])
    assert finding.magnitude["mass"] == pytest.approx(MASS, rel=0.02)
    assert finding.interval[0] < MASS < finding.interval[1]
    assert re.match(r"About 0\.\d+ kg of mass slides near grid 9", finding.sentence)
    assert "carried along in direction 1: it explains" in finding.sentence
    (card,) = finding.cards
    assert card.split()[0].rstrip("*") == "CMASS2"
    assert told.gap.before.worst_deviation_percent > 2.0
    assert told.gap.after.worst_deviation_percent < 0.2
    told.save(tmp_path / "run")
    assert "mass on a slide" in (tmp_path / "run" / "report.html").read_text(encoding="utf-8")


def test_afterwards_it_is_gone():
    assert "sliding_mass" not in KINDS
    assert "sliding_mass" not in WRITERS


def test_a_name_that_is_taken_is_refused(sliding):
    with pytest.raises(InputError, match="sliding_mass"):
        register_effect(sliding)
    with pytest.raises(InputError, match="sliding_mass"):
        register_writer("sliding_mass", WRITERS["point_mass"])
    with pytest.raises(InputError, match="what is registered is given as int"):
        register_effect(3)
    with pytest.raises(InputError, match="the writer is given as int"):
        register_writer("mine", 3)


def test_without_a_writer_no_search_is_begun(sliding, monkeypatch):
    monkeypatch.delitem(WRITERS, "sliding_mass")
    with pytest.raises(InputError, match="no cards can be written for sliding_mass: register_wr"):
        trueup.discover("no.bdf", "no.unv")
