"""A mass on a stand, told by the modes of a frame."""

from dataclasses import replace

import numpy as np
import pytest

import trueup
from trueup.core.data.mass_unit import MassUnit
from trueup.core.discovery import discover as core
from trueup.core.discovery.effects import tuned_absorber
from trueup.core.discovery.effects.candidates import Suspect
from trueup.core.discovery.effects.point_mass import KIND
from trueup.core.discovery.narrative.sentences import magnitude_of, sentence_of
from trueup.core.discovery.search.equipment_growth import as_blocks, equipped
from trueup.core.discovery.search.model_selection import earned, scored
from trueup.core.discovery.starting_point import ground_of

FRAME = (
    "SOL 103\nCEND\nSPC = 1\nBEGIN BULK\n"
    + "".join(f"GRID,{k + 1},,0.,{0.1 * k:.1f},0.\n" for k in range(9))
    + "".join(f"GRID,{k + 10},,{0.1 * (k + 1):.1f},.8,0.\n" for k in range(6))
    + "".join(f"CBAR,{k},1,{k},{k + 1},0.,0.,1.\n" for k in range(1, 15))
    + "PBAR,1,1,4.-4,1.3-8,1.3-8,2.6-8\nMAT1,1,2.1+11,,.3,7850.\nSPC1,1,123456,1,15\n"
)
HALF = (float(np.log(0.5)), float(np.log(1e4)))
"""Of a kilogram, on a mount of 10 kHz."""
BODY = "CONM2,90,6,0,.2,.08,0.,0.\n,2.-4,,2.-4,,,2.-4\n"


class Asked(Exception):
    """What was asked is known."""


def asked(tmp_path, monkeypatch):
    """What discovery is asked of the frame, by the test of one that carries equipment."""
    deck, truth = tmp_path / "deck.bdf", tmp_path / "truth.bdf"
    deck.write_text(FRAME + "ENDDATA\n")
    truth.write_text(FRAME + BODY + "ENDDATA\n")
    trueup.solve(truth, 12).write(tmp_path / "test.unv")
    requests = []

    def stop(request, progress):
        requests.append(request)
        raise Asked

    monkeypatch.setattr(core, "discover", stop)
    with pytest.raises(Asked):
        trueup.discover(deck, tmp_path / "test.unv", deck_length_unit="m")
    return requests[0]


def searching(request):
    """The search by all twelve modes and all sensors."""
    modes, sensors = np.zeros(12, bool), np.zeros(len(request.placed.observation), bool)
    ground = ground_of(request, ~modes)
    return core._searcher(core._Trial(request, ground, sensors, 0.01, (modes, sensors)))


def test_a_mass_off_the_structure_is_told_with_its_offset(tmp_path, monkeypatch):
    request = asked(tmp_path, monkeypatch)
    s = searching(request)
    masses = s.problem.catalogue[0]
    row = next(i for i, w in enumerate(masses.where) if w["grids"] == [6])
    point = s.fitted(
        s.null(), (Suspect(0, row, tuple(s.problem.catalogue[0].like(np.log([0.5])))),), 6
    )
    wide, grown = equipped(request.structure, s, point)
    (found,) = grown.suspects
    c = wide.problem.catalogue[found.kind]
    assert c.where[found.row]["grids"] == [6]
    assert np.exp(found.theta[0]) == pytest.approx(0.2, rel=0.15)
    off = c.bodies[found.row].offset - np.array([0.08, 0.0, 0.0])
    assert np.linalg.norm(off) < 0.03
    assert earned(scored(wide, grown), scored(s, point))
    said = magnitude_of(c, found.row, np.exp(found.theta), np.ones((1, 2)), MassUnit())
    sentence = sentence_of(c.kind, said, "there", (0.1, 0.3), [1], MassUnit())
    assert "It resists being turned (radius of gyration about 0.0" in sentence
    off = np.linalg.norm(c.bodies[found.row].offset)
    assert sentence.endswith(f"its centre about {off:.2g} deck units from its foot.")


def test_a_body_that_climbed_beside_something_else_climbs_on(tmp_path, monkeypatch):
    request = asked(tmp_path, monkeypatch)
    s = searching(request)
    row = next(i for i, w in enumerate(s.problem.catalogue[0].where) if w["grids"] == [6])
    light = (Suspect(0, row, tuple(s.problem.catalogue[0].like(np.log([0.1])))),)
    heavy, block = as_blocks(request.structure, s, s.fitted(s.null(), light, 6), 1e2)
    wide, stood = equipped(request.structure, heavy, block)
    (found,) = stood.suspects
    off = wide.problem.catalogue[found.kind].bodies[found.row].offset
    assert np.linalg.norm(off - np.array([0.08, 0.0, 0.0])) < 0.03
    assert scored(wide, stood).score > scored(heavy, block).score + 10.0


def test_what_looks_like_an_absorber_is_a_mass_that_resists_being_turned(tmp_path, monkeypatch):
    request = asked(tmp_path, monkeypatch)
    s = searching(request)
    kind, absorbers = next(
        (k, c) for k, c in enumerate(s.problem.catalogue) if c.kind is tuned_absorber.KIND
    )
    row = next(i for i, w in enumerate(absorbers.where) if w["grids"] == [6])
    size = absorbers.like(np.log([0.2, 200.0]))
    hung = s.fitted(s.null(), (Suspect(kind, row, tuple(size)),), 6)
    wide, stood = equipped(request.structure, s, hung)
    (found,) = stood.suspects
    assert wide.problem.catalogue[found.kind].kind is KIND
    assert np.exp(found.theta[0]) == pytest.approx(0.2, rel=0.15)


def test_a_body_costs_what_it_cost_to_have_had_a_choice(tmp_path, monkeypatch):
    request = asked(tmp_path, monkeypatch)
    s = searching(request)
    row = next(i for i, w in enumerate(s.problem.catalogue[0].where) if w["grids"] == [6])
    point = s.fitted(
        s.null(), (Suspect(0, row, tuple(s.problem.catalogue[0].like(np.log([0.5])))),), 6
    )
    wide, stood = equipped(request.structure, s, point)
    (found,) = stood.suspects
    made = wide.problem.catalogue[found.kind]
    free = replace(made, paid=0.0)
    unpaid = replace(wide, problem=replace(wide.problem, catalogue=(*s.problem.catalogue, free)))
    assert made.paid > 3.0
    gain = scored(unpaid, stood).score - scored(wide, stood).score
    assert gain == pytest.approx(made.paid)


def test_a_mass_in_a_poor_model_is_a_block_of_what_the_structure_is_made_of(tmp_path, monkeypatch):
    request = asked(tmp_path, monkeypatch)
    assert request.densest == pytest.approx(7850.0)
    s = searching(request)
    row = next(i for i, w in enumerate(s.problem.catalogue[0].where) if w["grids"] == [6])
    point = s.fitted(
        s.null(), (Suspect(0, row, tuple(s.problem.catalogue[0].like(np.log([0.5])))),), 6
    )
    mass = float(np.exp(point.suspects[0].theta[0]))
    wide, solid = as_blocks(request.structure, s, point, request.densest)
    (found,) = solid.suspects
    c = wide.problem.catalogue[found.kind]
    width = (mass / 7850.0 / 2.0) ** (1.0 / 3.0)
    own = np.array([1.0 + 1.0, 1.0 + 4.0, 1.0 + 4.0]) * width**2 / 12.0
    assert c.bodies[found.row].inertia == pytest.approx(own.mean() * np.eye(3))
    assert c.where[found.row]["grids"] == [6]
    said = magnitude_of(c, found.row, np.array([2.0]), np.ones((1, 2)), MassUnit())
    assert said["inertia"] == pytest.approx(2.0 * own.mean())
    sentence = sentence_of(c.kind, said, "there", (1.0, 3.0), [1], MassUnit())
    assert sentence.endswith("The test does not tell its inertia: taken as that of a solid block.")
    again, same = as_blocks(request.structure, wide, solid, request.densest)
    assert again is wide
    assert same is solid
