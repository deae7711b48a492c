"""Ends of members that may be soft: those of members that bend."""

from trueup.adapters.nastran import read_deck
from trueup.adapters.nastran.discovery.build_structure import build_structure
from trueup.core.discovery.effects import KINDS
from trueup.core.discovery.effects.effect_kind import Scale

DECK = """CEND
BEGIN BULK
GRID,1,,0.,0.,0.,,123456
GRID,2,,100.,0.,0.
GRID,3,,100.,0.,80.
{members}MAT1,1,70000.,,0.3,2.7-9
PARAM,AUTOSPC,YES
ENDDATA
"""
RODS = "CROD,1,1,1,2\nCROD,2,1,2,3\nCROD,3,1,1,3\nPROD,1,1,50.\n"
BARS = "CBAR,11,2,1,2,0.,1.,0.\nCBAR,12,2,2,3,0.,1.,0.\nPBAR,2,1,100.,800.,800.,1500.\n"


def joints(tmp_path, members):
    path = tmp_path / "deck.bdf"
    path.write_text(DECK.format(members=members))
    structure = build_structure(read_deck(path))
    made = KINDS["joint_flexibility"].places(structure, Scale(1e-3, 130.0, 1e6, (100.0, 900.0)))
    return [w["elements"] for c in made for w in c.where]


def test_rods_have_no_joint_that_turns(tmp_path):
    assert joints(tmp_path, RODS) == []


def test_bars_have_joints_where_rods_meet_them_too(tmp_path):
    assert sorted(joints(tmp_path, BARS)) == [[11], [12]]
    assert sorted(joints(tmp_path, BARS + RODS)) == [[11], [11], [12], [12]]


def test_a_mass_on_a_joint_leaves_it_one(tmp_path):
    mass = "CONM2,21,2,,1.-5\n"
    assert sorted(joints(tmp_path, BARS + mass)) == sorted(joints(tmp_path, BARS))
