"""One value changed: only its field's characters change, and it reads back exactly.

The decks are written every way Nastran reads: small, large and free fields and mixtures of them,
tabs, tags, comments between and behind the lines, all line ends.
"""

import math

import pytest
from hypothesis import given, strategies as st
from tests.adapters.nastran.editing.written_decks import (
    VALUES,
    as_read,
    by_our_reader,
    by_pynastran,
    decks,
    references,
)

from trueup.adapters.nastran.editing.find_cards import find_card
from trueup.adapters.nastran.editing.set_values import read_value, set_values
from trueup.adapters.nastran.fields.parameter_references import FieldRef
from trueup.adapters.nastran.text.real_numbers import parse_real, writable
from trueup.core.errors import InputError


@given(decks())
def test_what_is_written_in_any_format_is_read(deck):
    data, cards = deck
    text = as_read(data)
    for card in cards:
        for ref, at in references(card):
            word = card[at] if at < len(card) else ""
            assert read_value(text, ref) == (parse_real(word) if word else None)


@given(decks(), st.data())
def test_one_value_changes_and_nothing_else(deck, data):
    before, cards = deck
    card = data.draw(st.sampled_from(cards))
    ref, at = data.draw(st.sampled_from(references(card)))
    value = data.draw(VALUES)
    text = as_read(before)
    edited = set_values(text, {ref: value})
    after = edited.files[0].data

    reread = as_read(after)
    assert read_value(reread, ref) == writable(value) == read_value(edited, ref)

    expected = [c if c is not card else [*c, *[""] * (at + 1 - len(c))] for c in cards]
    ours = by_our_reader(after)
    assert len(ours) == len(cards)
    for old, new in zip(expected, ours, strict=True):
        words = ["" if w is None else w for w in new] + [""] * (len(old) - len(new))
        theirs = by_pynastran(reread, old[0], int(old[1]))
        theirs += [""] * (len(old) - len(theirs))
        for k, word in enumerate(old):
            if old[0] == ref.card and int(old[1]) == int(card[1]) and k == at:
                assert parse_real(words[k]) == parse_real(theirs[k]) == writable(value)
            elif k:
                assert words[k] == theirs[k] == word

    place = find_card(text, ref.card, ref.id)
    start = text.files[0].lines.starts[place.rows[0]]
    stop = text.files[0].lines.ends[place.rows[-1]]
    assert after.startswith(before[:start])
    assert after.endswith(before[stop:])
    for line in before[start:stop].replace(b"\r", b"\n").split(b"\n"):
        if line.lstrip()[:1] in (b"$", b""):
            assert line in after[start:]


@given(decks(), st.data())
def test_the_value_that_is_there_changes_no_byte(deck, data):
    before, cards = deck
    text = as_read(before)
    refs = [r for c in cards for r, _ in references(c) if read_value(text, r) is not None]
    chosen = data.draw(st.lists(st.sampled_from(refs), min_size=1, unique=True))
    edited = set_values(text, {r: read_value(text, r) for r in chosen})
    assert edited.files[0].data == before


@given(decks(), st.data())
def test_many_values_at_once_and_back_again(deck, data):
    before, cards = deck
    text = as_read(before)
    refs = [r for c in cards for r, _ in references(c)]
    values = data.draw(st.dictionaries(st.sampled_from(refs), VALUES, min_size=2))
    edited = as_read(set_values(text, values).files[0].data)
    for ref in refs:
        expected = writable(values[ref]) if ref in values else read_value(text, ref)
        assert read_value(edited, ref) == expected
    assert edited.files[0].data.count(b"$") == before.count(b"$")


@pytest.mark.parametrize(
    "line", ["  PROD  1       1       2.\n", "  PROD,1,1,2.\n", " PROD*  1               1\n* 2.\n"]
)
def test_a_name_set_in_a_little_leaves_fixed_fields_in_their_columns(line):
    assert by_our_reader(line.encode())[0][:3] == ["PROD", "1", "1"]
    assert find_card(as_read(line.encode()), "PROD", 1).read(3) == "1"


def edit(line: str, ref: tuple[str, int, str], value: float) -> str:
    """Change one value of a deck that is bulk data alone."""
    deck = as_read(line.encode("latin-1"))
    return set_values(deck, {FieldRef(*ref): value}).files[0].data.decode("latin-1")


# One case a row: the card, what changes, the card afterwards.
CASES = {
    "small field, exact": (
        "PSHELL  3       1       2.5     1\n", ("PSHELL", 3, "T"), 3.25,
        "PSHELL  3       1       3.25    1\n",
    ),
    "small field to the right": (
        "PSHELL         3       1     2.5       1\n", ("PSHELL", 3, "T"), 3.25,
        "PSHELL         3       1    3.25       1\n",
    ),
    "small field at the line's end": (
        "PSHELL  3       1       2.5\n", ("PSHELL", 3, "T"), 3.125,
        "PSHELL  3       1       3.125\n",
    ),
    "trailing blanks stay": (
        "PSHELL  3       1       2.5     \n", ("PSHELL", 3, "T"), 3.125,
        "PSHELL  3       1       3.125   \n",
    ),
    "comment stays in its column": (
        "PSHELL  3       1       2.5       $ skin\n", ("PSHELL", 3, "T"), 3.125,
        "PSHELL  3       1       3.125     $ skin\n",
    ),
    "comment moves where it must": (
        "PSHELL  3       1       2.5 $ skin\n", ("PSHELL", 3, "T"), 3.1234567e-4,
        "PSHELL* 3               1               3.1234567E-4 $ skin\n",
    ),
    "comment stands where the field goes": (
        "PSHELL  3       1       2.5 $ skin\n", ("PSHELL", 3, "NSM"), 1.5,
        "PSHELL  3       1       2.5                                     1.5 $ skin\n",
    ),
    "short line is extended": (
        "PSHELL  3       1       2.5\n", ("PSHELL", 3, "12I/T**3"), 1.5,
        "PSHELL  3       1       2.5             1.5\n",
    ),
    "continuation is appended": (
        "PSHELL  3       1       2.5\n", ("PSHELL", 3, "Z2"), 1.5,
        "PSHELL  3       1       2.5\n+               1.5\n",
    ),
    "two continuations are appended": (
        "PBAR    3       1       2.5\n", ("PBAR", 3, "I12"), 1.5,
        "PBAR    3       1       2.5\n+\n+                       1.5\n",
    ),
    "continuation takes the waiting tag": (
        "PSHELL  3       1       2.5" + " " * 45 + "+S3\n", ("PSHELL", 3, "Z1"), 1.5,
        "PSHELL  3       1       2.5" + " " * 45 + "+S3\n+S3     1.5\n",
    ),
    "continuation in large fields after large fields": (
        "PSHELL* 3               1               2.5\n", ("PSHELL", 3, "Z1"), 1.5,
        "PSHELL* 3               1               2.5\n*\n*       1.5\n",
    ),
    "continuation in large fields where eight columns round": (
        "PSHELL  3       1       2.5\n", ("PSHELL", 3, "Z1"), 1.23456789,
        "PSHELL  3       1       2.5\n*       1.23456789\n",
    ),
    "no line end at the end of the file": (
        "PSHELL  3       1       2.5", ("PSHELL", 3, "Z1"), 1.5,
        "PSHELL  3       1       2.5\n+       1.5",
    ),
    "eight columns would round": (
        "MAT1    1       70000.          0.33    2.7-9\n", ("MAT1", 1, "E"), 70864.1975230864,
        "MAT1*   1               70864.1975230864                0.33\n*       2.7-9\n",
    ),
    "one line of large fields is enough": (
        "PROD    7       1       100.\n", ("PROD", 7, "A"), 100.123456789,
        "PROD*   7               1               100.123456789\n",
    ),
    "large field": (
        "PROD*   7               1               100.            2.\n", ("PROD", 7, "A"),
        100.123456789,
        "PROD*   7               1               100.123456789   2.\n",
    ),
    "second large line is missing": (
        "MAT1*   1               70000.                          0.33\n", ("MAT1", 1, "RHO"),
        2.7e-9,
        "MAT1*   1               70000.                          0.33\n*       2.7E-9\n",
    ),
    "only the line that holds the field becomes large": (
        "PBAR,1,1,2.,3.,4.,5.\n+,1.,1.\n", ("PBAR", 1, "C2"), 1.23456789,
        "PBAR,1,1,2.,3.,4.,5.\n*,1.,1.23456789\n",
    ),
    "free field": (
        "PROD, 7 , 1 , 100. , 2.\n", ("PROD", 7, "A"), 50.5,
        "PROD, 7 , 1 , 50.5 , 2.\n",
    ),
    "free field, short": (
        "PROD,7,1,100.  $ rod\n", ("PROD", 7, "NSM"), 50.5,
        "PROD,7,1,100.,,,50.5  $ rod\n",
    ),
    "free field that eight characters would round": (
        "PROD,7,1,100.,2.,,3.\n", ("PROD", 7, "A"), 100.123456789,
        "PROD*,7,1,100.123456789,2.\n*,,3.\n",
    ),
    "free field, large": (
        "PROD*,7,1,100.,2.\n*,,3.\n", ("PROD", 7, "A"), 100.123456789,
        "PROD*,7,1,100.123456789,2.\n*,,3.\n",
    ),
    "free field with a tag": (
        "PSHELL,3,1,2.5,1,,1,,,+A\n+A,1.\n", ("PSHELL", 3, "T"), 2.123456789,
        "PSHELL*,3,1,2.123456789,1\n*,,1,,,+A\n+A,1.\n",
    ),
    "free field is extended by a continuation": (
        "PSHELL,3,1,2.5\n", ("PSHELL", 3, "Z2"), 1.5,
        "PSHELL,3,1,2.5\n+,,1.5\n",
    ),
    "tag and what stands behind it stay": (
        "PSHELL  3       1       2.5     1               1                       +A      x\n"
        "+A      1.\n", ("PSHELL", 3, "T"), 2.123456789,
        "PSHELL* 3               1               2.123456789     1\n"
        "*                       1                                               +A      x\n"
        "+A      1.\n",
    ),
    "comment between continuations": (
        "PSHELL  3       1       2.5\n$ offsets\n        1.      2.\n", ("PSHELL", 3, "Z1"), 1.5,
        "PSHELL  3       1       2.5\n$ offsets\n        1.5     2.\n",
    ),
    "tabs": (
        "PSHELL\t3\t1\t2.5\t1\n", ("PSHELL", 3, "T"), 3.25,
        "PSHELL\t3\t1\t3.25    1\n",
    ),
    "byte order mark": (
        "\xef\xbb\xbfPROD,1,1,2.\n", ("PROD", 1, "A"), 3.0, "\xef\xbb\xbfPROD,1,1,3.\n",
    ),
    "name not in the first column": (
        "  PROD  1       1       2.\n", ("PROD", 1, "A"), 3.0,
        "  PROD  1       1       3.\n",
    ),
    "lower case": (
        "pshell  3       1       2.5\n", ("PSHELL", 3, "T"), 3.25,
        "pshell  3       1       3.25\n",
    ),
    "second property of the card": (
        "PELAS   4       1000.   0.      0.      5       2000.\n", ("PELAS", 5, "K"), 2500.0,
        "PELAS   4       1000.   0.      0.      5       2500.\n",
    ),
    "blank field": (
        "MAT1    1       70000.          0.33\n", ("MAT1", 1, "G"), 26000.0,
        "MAT1    1       70000.  26000.  0.33\n",
    ),
    "carriage returns": (
        "PSHELL  3       1       2.5\rPSHELL  4       1       2.5\r", ("PSHELL", 3, "Z1"), 1.5,
        "PSHELL  3       1       2.5\r+       1.5\rPSHELL  4       1       2.5\r",
    ),
    "a line end of its own kind": (
        "PSHELL  3       1       2.5\r\nPROD,1,1,2.\nPROD,2,1,2.\n", ("PSHELL", 3, "Z1"), 1.5,
        "PSHELL  3       1       2.5\r\n+       1.5\r\nPROD,1,1,2.\nPROD,2,1,2.\n",
    ),
}  # fmt: skip


@pytest.mark.parametrize("case", CASES)
def test_one_change(case):
    before, ref, value, after = CASES[case]
    assert edit(before, ref, value) == after


# One fault a row: the deck, the value asked for, what the message must say.
FAULTS = {
    "no such number": (
        "PSHELL,3,1,2.5\nPSHELL,14,1,2.5\n", ("PSHELL", 13, "T"), "PSHELL cards are 3, 14",
    ),
    "no such card": (
        "PROD,3,1,2.5\n", ("PSHELL", 3, "T"), "no PSHELL card in the deck",
    ),
    "twice": (
        "PSHELL,3,1,2.5\nPSHELL,3,1,2.5\n", ("PSHELL", 3, "T"), "line 1, deck.bdf line 2",
    ),
    "in two superelements": (
        "CEND\nBEGIN BULK\nPROD,3,1,1.\nBEGIN SUPER=5\nPROD,3,1,1.\n", ("PROD", 3, "A"),
        "SUPER=5",
    ),
    "after the end": (
        "PROD,3,1,2.5\nENDDATA\nPROD,4,1,2.5\n", ("PROD", 4, "A"), "no PROD 4",
    ),
    "in case control": (
        "CEND\nPROD,3,1,1.\nBEGIN BULK\n", ("PROD", 3, "A"), "no PROD 3",
    ),
    "commented out": (
        "$PROD,3,1,2.5\nPROD,4,1,1.\n", ("PROD", 3, "A"), "no PROD 3",
    ),
    "no number": (
        "PROD,3,1,thick\n", ("PROD", 3, "A"), "'THICK', which is not a number",
    ),
    "ply that is not there": (
        "PCOMP,3\n,1,.1,0.\n", ("PCOMP", 3, "T2"), "has no T2",
    ),
    "section without that dimension": (
        "PBARL,3,1,,TUBE\n,5.,4.\n", ("PBARL", 3, "DIM3"), "line 1: this PBARL 3 has no DIM3",
    ),
    "replicated": (
        "PROD,3,1,1.\n=,*(1),==\n", ("PROD", 3, "A"), "line 2: the PROD above is replicated",
    ),
    "fields taken by the next": (
        "PROD,3,1,1.,2.\nPROD,4,2,==\n", ("PROD", 3, "A"), "line 2: the PROD above is replicated",
    ),
    "fields taken": (
        "PROD,3,1,1.,2.\nPROD,4,2,==\n", ("PROD", 4, "A"), "line 2: the PROD here is replicated",
    ),
    "a copy of one replicated": (
        "PROD,3,1,1.\n=,*(1),==\n", ("PROD", 4, "A"), "those that '=' replicates",
    ),
    "half a pair": (
        "PSHELL* 3               1               2.\n+       1.\n", ("PSHELL", 3, "T"),
        "second half",
    ),
    "tags do not match": (
        "PSHELL,3,1,2.5,,,,,,+A\n+B,1.\n", ("PSHELL", 3, "T"), "'+A' does not follow",
    ),
    "continuation elsewhere": (
        "PSHELL,3,1,2.5,,,,,,+A\nPROD,1,1,1.,,,,,,+B\n+B\n+A,1.\n", ("PSHELL", 3, "T"),
        "'+A' does not follow",
    ),
}  # fmt: skip


@pytest.mark.parametrize("fault", FAULTS)
def test_one_fault_is_one_clear_sentence(fault):
    before, ref, says = FAULTS[fault]
    with pytest.raises(InputError) as error:
        edit(before, ref, 1.5)
    assert says in str(error.value)
    assert "\n" not in str(error.value)


def test_a_value_that_is_not_finite_is_refused():
    with pytest.raises(InputError, match="not a finite number"):
        edit("PROD,3,1,1.\n", ("PROD", 3, "A"), math.nan)


def test_the_text_that_was_read_is_not_changed():
    deck = as_read(b"PROD,3,1,1.\n")
    set_values(deck, {FieldRef("PROD", 3, "A"): 2.0})
    assert deck.files[0].data == b"PROD,3,1,1.\n"
    assert read_value(deck, FieldRef("PROD", 3, "A")) == 1.0
