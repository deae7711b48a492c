"""The cards by which two texts of a deck differ, as they stand there."""

import pytest

from trueup.adapters.nastran import read_deck_text
from trueup.adapters.nastran.editing.add_cards import add_cards
from trueup.adapters.nastran.editing.changed_cards import written_cards
from trueup.adapters.nastran.editing.set_values import set_values
from trueup.adapters.nastran.fields.parameter_references import FieldRef

DECK = """CEND
BEGIN BULK
GRID,1,,0.,0.,0.
$ a section
PBAR    1       1       200.    9000.   9000.   3000.
        1.      2.      3.      4.
        0.8     0.8
$ bars
MAT1,1,70000.,,.3,2.7-9
,0.,0.
ENDDATA
"""


@pytest.fixture
def text(tmp_path):
    path = tmp_path / "deck.bdf"
    path.write_text(DECK)
    return read_deck_text(path)


def test_equal_texts_have_no_changed_cards(text):
    assert written_cards(text, text) == ()


def test_a_new_card_is_shown_to_the_last_digit_without_its_comment(text):
    done = add_cards(text, [["CONM2", 7, 1, None, 0.123456789]], "why\nand how", ("GRID", 1))
    (card,) = written_cards(text, done)
    assert card in done.files[0].data.decode()
    assert "$" not in card
    assert card.startswith("CONM2*")
    assert "0.123456789" in card or ".123456789" in card


def test_a_card_changed_in_one_line_is_shown_whole_and_alone(text):
    """Of three lines the second differs; the cards and comments around it do not belong to it."""
    done = set_values(text, {FieldRef("PBAR", 1, "C1"): 1.5})
    (card,) = written_cards(text, done)
    lines = card.split("\n")
    assert len(lines) == 3
    assert lines[0].startswith("PBAR    1")
    assert lines[2].split() == ["0.8", "0.8"]
    assert card in done.files[0].data.decode()


def test_free_continuations_belong_to_their_card(text):
    done = set_values(text, {FieldRef("MAT1", 1, "E"): 71000.0})
    (card,) = written_cards(text, done)
    assert card.endswith("\n,0.,0.")


def test_several_changes_give_a_card_each_in_the_order_of_the_deck(text):
    done = set_values(text, {FieldRef("MAT1", 1, "E"): 71000.0, FieldRef("PBAR", 1, "K2"): 0.7})
    assert [c[:4] for c in written_cards(text, done)] == ["PBAR", "MAT1"]


def test_a_new_card_that_ends_like_the_one_before_it_is_shown_alone(text):
    mass = [None, 0.5, None, None, None, None, 0.002312, None, 0.002312]
    first = add_cards(text, [["CONM2", 7, 1, *mass]], "", ("GRID", 1))
    grid = ["GRID", 2, None, 1.0, 0.0, 0.0]
    done = add_cards(first, [grid, ["CONM2", 8, 2, *mass]], "", ("CONM2", 7))
    cards = written_cards(first, done)
    assert [card.split()[:2] for card in cards] == [["GRID", "2"], ["CONM2", "8"]]
