"""New cards: one commented block in the file of their neighbours, read back exactly."""

from pathlib import Path

import pytest
from hypothesis import given, strategies as st

from trueup.adapters.nastran.deck.raw_cards import fields_of
from trueup.adapters.nastran.editing.add_cards import add_cards
from trueup.adapters.nastran.editing.find_cards import find_card
from trueup.adapters.nastran.editing.rewrite_fields import format_card
from trueup.adapters.nastran.text.deck_text import DeckText, read_deck_text
from trueup.adapters.nastran.text.real_numbers import parse_real, writable
from trueup.core.errors import InputError


def deck(folder: Path, text: str, **included: str) -> DeckText:
    for name, content in included.items():
        (folder / f"{name}.bdf").write_bytes(content.encode("latin-1"))
    (folder / "deck.bdf").write_bytes(text.encode("latin-1"))
    return read_deck_text(folder / "deck.bdf")


def texts(deck: DeckText) -> list[str]:
    return [f.data.decode("latin-1") for f in deck.files]


def test_cards_go_before_the_end_of_the_neighbours_file(tmp_path):
    before = deck(
        tmp_path,
        "CEND\nBEGIN BULK\nINCLUDE 'mesh.bdf'\nENDDATA\nafterwards\n",
        mesh="GRID,1,,0.,0.,0.\nCQUAD4,1,1,1,2,3,4\n",
    )
    after = add_cards(before, [["CONM2", 5, 1, None, 0.62]], "missing mass", ("GRID", 1))
    assert texts(after) == [
        texts(before)[0],
        "GRID,1,,0.,0.,0.\nCQUAD4,1,1,1,2,3,4\n$ missing mass\n"
        "CONM2   5       1               0.62\n",
    ]


def test_cards_go_before_enddata(tmp_path):
    before = deck(tmp_path, "CEND\nBEGIN BULK\nGRID,1\nENDDATA\ntext\n")
    after = add_cards(before, [["GRID", 2, None, 1.0, 2.0, 3.0]], "why", ("GRID", 1))
    assert texts(after) == [
        "CEND\nBEGIN BULK\nGRID,1\n$ why\n"
        "GRID    2               1.      2.      3.\nENDDATA\ntext\n"
    ]


def test_cards_stay_in_their_superelement(tmp_path):
    before = deck(tmp_path, "CEND\nBEGIN BULK\nGRID,1\nBEGIN SUPER=2\nGRID,2\nENDDATA\n")
    one = add_cards(before, [["SPOINT", 7]], "one", ("GRID", 1))
    two = add_cards(before, [["SPOINT", 7]], "two", ("GRID", 2))
    block = "$ {}\nSPOINT  7\n"
    assert texts(one)[0].index(block.format("one")) < texts(one)[0].index("BEGIN SUPER")
    assert texts(two)[0].endswith("GRID,2\n" + block.format("two") + "ENDDATA\n")


def test_line_ends_are_those_of_the_file(tmp_path):
    before = deck(tmp_path, "GRID,1\r\nGRID,2\r\n")
    after = add_cards(before, [["SPOINT", 7]], "a\nb", ("GRID", 2))
    assert texts(after) == ["GRID,1\r\nGRID,2\r\n$ a\r\n$ b\r\nSPOINT  7\r\n"]


def test_a_file_without_a_last_line_end_keeps_none(tmp_path):
    before = deck(tmp_path, "GRID,1\nGRID,2")
    after = add_cards(before, [["SPOINT", 7]], "a", ("GRID", 2))
    assert texts(after) == ["GRID,1\nGRID,2\n$ a\nSPOINT  7"]


def test_two_additions_follow_each_other(tmp_path):
    once = add_cards(deck(tmp_path, "GRID,1\n"), [["SPOINT", 7]], "a", ("GRID", 1))
    twice = add_cards(once, [["SPOINT", 8]], "b", ("GRID", 1))
    assert texts(twice) == ["GRID,1\n$ a\nSPOINT  7\n$ b\nSPOINT  8\n"]


def test_long_comments_are_broken_and_the_rest_stays_in_the_files_encoding(tmp_path):
    before = deck(tmp_path, "$ f\xfcr\nGRID,1\n")
    after = add_cards(before, [["SPOINT", 7]], "M\xfcller: " + "mass " * 40, ("GRID", 1))
    comment = [line for line in texts(after)[0].splitlines() if line.startswith("$")]
    assert comment[0] == "$ f\xfcr"
    assert comment[1].startswith("$ Muller: mass")
    assert max(len(line) for line in comment) <= 80
    assert " ".join(comment).count("mass") == 40


def test_without_a_neighbour_the_top_deck_takes_them(tmp_path):
    before = deck(tmp_path, "CEND\nBEGIN BULK\nINCLUDE 'a.bdf'\nEIGRL,1\nENDDATA\n", a="GRID,1\n")
    assert "SPOINT" in texts(add_cards(before, [["SPOINT", 7]], "a"))[0]


def test_a_neighbour_that_is_not_there(tmp_path):
    with pytest.raises(InputError, match="no GRID 5: its GRID cards are 1"):
        add_cards(deck(tmp_path, "GRID,1\n"), [["SPOINT", 7]], "a", ("GRID", 5))


def test_a_deck_without_bulk_data(tmp_path):
    with pytest.raises(InputError, match="no bulk data"):
        add_cards(deck(tmp_path, "CEND\n"), [["SPOINT", 7]], "a")


@given(
    st.lists(
        st.none() | st.integers(1, 99_999_999) | st.floats(1e-20, 1e20) | st.just("THRU"),
        max_size=30,
    )
)
def test_what_is_added_reads_back(values):
    lines = format_card(["CARD", 1, *values])
    words = [*fields_of([line.decode("latin-1") for line in lines]), *[None] * len(values)]
    assert words[0] == "CARD"
    for value, word in zip(values, words[2:], strict=False):
        if isinstance(value, float):
            assert parse_real(word) == writable(value)
        else:
            assert word == (None if value is None else str(value))


def test_reals_that_eight_columns_round_make_the_card_large(tmp_path):
    after = add_cards(
        deck(tmp_path, "GRID,1\n"), [["CONM2", 5, 1, None, 0.6213456789]], "a", ("GRID", 1)
    )
    card = find_card(after, "CONM2", 5)
    assert [line.data for line in card.lines] == [
        b"CONM2*  5               1" + b" " * 31 + b"0.6213456789"
    ]


def test_comments_are_ascii(tmp_path):
    path = tmp_path / "a.bdf"
    path.write_text("BEGIN BULK\nGRID,1,,0.,0.,0.\nENDDATA\n")
    added = add_cards(read_deck_text(path), [("CONM2", 7, 1, 0, 2.5)], "x1.2 ± 0.1 at θ = 30°")
    data = added.files[0].data
    assert data.isascii()
    assert b"$ x1.2 +/- 0.1 at theta = 30 deg" in data
