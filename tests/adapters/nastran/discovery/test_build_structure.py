"""The elements of a deck one by one."""

import numpy as np

from trueup.adapters.nastran import read_deck
from trueup.adapters.nastran.discovery.build_structure import build_structure
from trueup.core.discovery.effects.bar_members import bars_of

DECK = """CEND
BEGIN BULK
GRID,1,,0.,0.,0.,,123456
GRID,2,,1.,0.,0.
GRID,3,,2.,0.,0.
CBAR,1,1,1,2,0.,0.,1.
PBAR,1,1,1.,1.,1.,1.
MAT1,1,7.+4,,.3,1.
CBUSH,2,6,2,3,0.,0.,1.
PBUSH,6,K,10.,10.,10.,10.,10.,10.
CONM2,3,3,,1.
ENDDATA
"""


def test_a_bushing_is_no_bar_that_could_lose_a_part_of_its_stiffness(tmp_path):
    path = tmp_path / "deck.bdf"
    path.write_text(DECK)
    structure = build_structure(read_deck(path))
    assert {m.element.dimension for m in structure.members if 2 in m.ids} == {0}
    places = {tuple(structure.members[p.member].ids[p.rows]) for p in bars_of(structure, 2.0)}
    assert places == {(1,)}


PLACES = np.array(
    [(0.0, 0.0, 0.0), (1.0, 0.1, 0.0), (1.1, 1.0, 0.2), (0.0, 1.0, 0.0), (0.5, 0.5, 1.0),
     (2.0, 0.4, 0.7), (2.3, 1.2, 0.1)]
)  # fmt: skip
BODY = """CBAR,2,2,1,6,0.,0.,1.
CBAR,3,2,2,6,0.,1.,1.
RBE2,4,6,123456,5
RBE3,9,,7,123,1.,123,2,3
,4
CONM2,5,5,,2.,.1,.2,.3
CONM2,6,7,,1.
CQUAD4,1,1,1,2,3,4
PSHELL,1,1,.05,1,,1
PBAR,2,1,.01,1.-5,2.-5,1.-5
MAT1,1,7.+4,,.3,1.
SPC1,1,123456,1
"""


def of_grids(path, xyz, more=""):
    grids = [f"GRID,{k},,{x:.7f},{y:.7f},{z:.7f}" for k, (x, y, z) in enumerate(xyz, 1)]
    path.write_text("\n".join(["SPC = 1", "BEGIN BULK", *grids, BODY + more + "ENDDATA\n"]))
    return build_structure(read_deck(path))


def test_a_moved_deck_is_one_with_its_grids_there_rigid_elements_and_offsets_too(tmp_path):
    by = np.round(0.1 * np.random.default_rng(4).standard_normal(PLACES.shape), 7)
    drawn, there = (of_grids(tmp_path / "deck.bdf", xyz) for xyz in (PLACES, PLACES + by))
    K, M = drawn.moved(by)
    assert abs(K - there.model.K()).max() < 1e-9 * abs(K).max()
    assert abs(M - there.model.M()).max() < 1e-9 * abs(M).max()
    assert abs(K - drawn.model.K()).max() > 1e-3 * abs(K).max()
    back = drawn.moved(np.zeros_like(by))
    assert abs(back[0] - drawn.model.K()).max() == 0.0


def test_one_that_is_condensed_cannot_be_moved(tmp_path):
    assert of_grids(tmp_path / "deck.bdf", PLACES, "ASET1,123,2,3,4\n").moved is None
