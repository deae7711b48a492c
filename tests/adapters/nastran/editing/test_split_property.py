"""A property split: a copy for some elements, and only their property fields change."""

import pytest

from trueup.adapters.nastran.editing.deck_diff import unified_diff
from trueup.adapters.nastran.editing.set_values import read_value, set_values
from trueup.adapters.nastran.editing.split_property import split_property
from trueup.adapters.nastran.fields.parameter_references import FieldRef
from trueup.adapters.nastran.text.deck_text import DeckText, read_deck_text
from trueup.core.errors import InputError

DECK = """\
CEND
BEGIN BULK
INCLUDE 'mesh.bdf'
$ skin
PSHELL  3       1       2.5     1               1 $ 2.5 mm
$ between
        -1.25   1.25
MAT1*   1               70000.                          .33
*       2.7-9
MAT1    9       1.      2.      .3
PELAS   4       1000.   0.      0.      5       2000.
ENDDATA
"""
MESH = """\
CQUAD4  1       3       1       2       3       4
CQUAD4  2       3       2       3       4       5
CTRIA3,3,3,1,2,3
CQUAD4* 4               3               1               2
*       3               4
CELAS1  5       5       1       1
CBAR    3000    3       1       2       0.      0.      1.
CQUAD4  8       9       1       2       3       4
"""


@pytest.fixture
def deck(tmp_path) -> DeckText:
    (tmp_path / "deck.bdf").write_text(DECK)
    (tmp_path / "mesh.bdf").write_text(MESH)
    return read_deck_text(tmp_path / "deck.bdf")


def test_only_the_property_fields_and_new_cards_differ(deck):
    split = split_property(deck, "PSHELL", 3, [2, 3, 4], "softer strip")
    assert (split.property, dict(split.materials)) == (6, {1: 10})
    assert unified_diff(deck, split.deck, context=0) == (
        "--- a/deck.bdf\n"
        "+++ b/deck.bdf\n"
        "@@ -11,0 +12,5 @@\n"
        "+$ softer strip\n"
        "+PSHELL  6       10      2.5     10              10 $ 2.5 mm\n"
        "+        -1.25   1.25\n"
        "+MAT1*   10              70000.                          .33\n"
        "+*       2.7-9\n"
        "--- a/mesh.bdf\n"
        "+++ b/mesh.bdf\n"
        "@@ -2,3 +2,3 @@\n"
        "-CQUAD4  2       3       2       3       4       5\n"
        "-CTRIA3,3,3,1,2,3\n"
        "-CQUAD4* 4               3               1               2\n"
        "+CQUAD4  2       6       2       3       4       5\n"
        "+CTRIA3,3,6,1,2,3\n"
        "+CQUAD4* 4               6               1               2\n"
    )


def test_the_copies_can_be_moved_without_the_originals(deck):
    split = split_property(deck, "PSHELL", 3, [2], "why")
    thickness = FieldRef("PSHELL", split.property, "T")
    modulus = FieldRef("MAT1", split.materials[1], "E")
    moved = set_values(split.deck, {thickness: 2.0, modulus: 60000.0})
    assert read_value(moved, thickness) == 2.0
    assert read_value(moved, FieldRef("PSHELL", 3, "T")) == 2.5
    assert read_value(moved, modulus) == 60000.0
    assert read_value(moved, FieldRef("MAT1", 1, "E")) == 70000.0


def test_the_material_may_be_kept(deck):
    split = split_property(deck, "PSHELL", 3, [2], "why", copy_materials=False)
    assert not split.materials
    assert "MAT1*   10" not in split.deck.files[0].data.decode()


def test_one_of_two_properties_on_a_card(deck):
    split = split_property(deck, "PELAS", 5, [5], "why")
    assert read_value(split.deck, FieldRef("PELAS", split.property, "K")) == 2000.0
    assert "CELAS1  5       6       1" in split.deck.files[1].data.decode()


@pytest.mark.parametrize(
    ("card", "number", "elements", "says"),
    [
        ("PSHELL", 7, [1], "no PSHELL 7"),
        ("PSHELL", 3, [], "no elements are named"),
        ("PSHELL", 3, [1, 77], "has no element 77"),
        ("PSHELL", 3, [8], "mesh.bdf line 8: CQUAD4 8 has property 9, not PSHELL 3"),
        ("PSHELL", 3, [3000], "no element 3000 that could have a PSHELL"),
        ("MAT1", 1, [1], "not a property that can be split"),
    ],
)
def test_faults(deck, card, number, elements, says):
    with pytest.raises(InputError) as error:
        split_property(deck, card, number, elements, "why")
    assert says in str(error.value)


@pytest.mark.parametrize(
    "nsm",
    [
        "NSM1,1,PSHELL,.5,3",
        "NSM1,1,PSHELL,.5,1,THRU,9",
        "NSM,1,PSHELL,2,.1,3,.2",
        "NSML1,1,PSHELL,.5,3",
        "NSM1,1,PCOMP,.5,3",
    ],
)
def test_mass_given_by_the_propertys_number_would_be_lost(tmp_path, nsm):
    (tmp_path / "deck.bdf").write_text(f"PSHELL,3,1,1.\nMAT1,1,1.\nCQUAD4,1,3,1,2,3,4\n{nsm}\n")
    with pytest.raises(InputError, match=r"line 4: NSML?1? gives mass to PSHELL 3"):
        split_property(read_deck_text(tmp_path / "deck.bdf"), "PSHELL", 3, [1], "why")


def test_mass_given_to_another_property_does_not_matter(tmp_path):
    (tmp_path / "deck.bdf").write_text(
        "PSHELL,3,1,1.\nMAT1,1,1.\nCQUAD4,1,3,1,2,3,4\nNSM1,1,PSHELL,.5,4\nNSM,2,PSHELL,4,3.\n"
    )
    assert (
        split_property(read_deck_text(tmp_path / "deck.bdf"), "PSHELL", 3, [1], "w").property == 4
    )


def test_a_blank_property_is_the_elements_number(tmp_path):
    (tmp_path / "deck.bdf").write_text("PBAR,5,1,1.\nMAT1,1,1.\nCBAR,5,,1,2,0.,0.,1.\n")
    split = split_property(read_deck_text(tmp_path / "deck.bdf"), "PBAR", 5, [5], "why")
    assert b"CBAR,5,6,1,2,0.,0.,1.\n" in split.deck.files[0].data


def test_a_default_property_is_not_guessed(tmp_path):
    (tmp_path / "deck.bdf").write_text("BAROR,,5\nPBAR,5,1,1.\nCBAR,1,,1,2,0.,0.,1.\n")
    with pytest.raises(InputError, match="takes its property from BAROR"):
        split_property(read_deck_text(tmp_path / "deck.bdf"), "PBAR", 5, [1], "why")


def test_every_ply_gets_the_copied_material(tmp_path):
    (tmp_path / "deck.bdf").write_text(
        "PCOMP,3\n,1,.1,0.,,2,.1,90.\n,1,.1,0.\nMAT8,1,1.,1.,.3,1.\nMAT8,2,2.,1.,.3,1.\n"
        "CQUAD4,1,3,1,2,3,4\n"
    )
    split = split_property(read_deck_text(tmp_path / "deck.bdf"), "PCOMP", 3, [1], "why")
    assert dict(split.materials) == {1: 3, 2: 4}
    assert b"PCOMP,4\n,3,.1,0.,,4,.1,90.\n,3,.1,0.\nMAT8,3,1." in split.deck.files[0].data
