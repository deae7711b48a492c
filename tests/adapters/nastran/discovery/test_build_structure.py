"""The elements of a deck one by one."""

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
    assert {m.card: m.element.dimension for m in structure.members}["CBUSH"] == 0
    places = {tuple(structure.members[p.member].ids[p.rows]) for p in bars_of(structure, 2.0)}
    assert places == {(1,)}
