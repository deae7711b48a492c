"""Decks of real programs: given back byte for byte, and changed in one field only."""

from pathlib import Path

import pytest

from trueup.adapters.nastran.cards import definitions
from trueup.adapters.nastran.editing.deck_diff import unified_diff
from trueup.adapters.nastran.editing.find_cards import find_card, names_in
from trueup.adapters.nastran.editing.set_values import read_value, set_values
from trueup.adapters.nastran.editing.write_deck import names_in_tree, write_deck
from trueup.adapters.nastran.fields.layouts import movable
from trueup.adapters.nastran.fields.parameter_references import FieldRef
from trueup.adapters.nastran.text.deck_text import read_deck_text
from trueup.adapters.nastran.text.real_numbers import writable

ROOT = Path(__file__).resolve().parents[4]
DATA = ROOT.parent / "shared" / "data"

_TOPS = ("*.dat", "*.bdf")
_PARTS = ("mesh.bdf", "properties.bdf", "svanberg.bdf", "tenBar.bdf")
DECKS = sorted(p for top in _TOPS for p in DATA.rglob(top) if p.name not in _PARTS)
needs_data = pytest.mark.skipif(not DATA.is_dir(), reason=f"no shared data beside {ROOT.name}")
DECKS = DECKS or [pytest.param(DATA, marks=needs_data, id="shared data")]
DECKS += [ROOT / "fixtures" / "duct" / "duct.bdf"]

# How pyNastran's objects call the values that are changed here.
BY_PYNASTRAN = {
    ("CELAS2", "K"): lambda m, n: m.elements[n].k,
    ("CONM2", "M"): lambda m, n: m.masses[n].mass,
    ("CONROD", "A"): lambda m, n: m.elements[n].A,
    ("MAT1", "E"): lambda m, n: m.materials[n].e,
    ("MAT1", "RHO"): lambda m, n: m.materials[n].rho,
    ("MAT8", "E1"): lambda m, n: m.materials[n].e11,
    ("MAT11", "E1"): lambda m, n: m.materials[n].e1,
    ("PBAR", "I1"): lambda m, n: m.properties[n].i1,
    ("PELAS", "K"): lambda m, n: m.properties[n].k,
    ("PROD", "A"): lambda m, n: m.properties[n].A,
    ("PSHEAR", "T"): lambda m, n: m.properties[n].t,
    ("PSHELL", "T"): lambda m, n: m.properties[n].t,
    ("PTUBE", "OD"): lambda m, n: m.properties[n].OD1,
}


def deck_id(path):
    return f"{path.parent.name}/{path.name}" if isinstance(path, Path) else None


def first_values(deck):
    """The first card of every name that holds each value pyNastran is asked for."""
    for card, field in BY_PYNASTRAN:
        if card not in names_in(deck):
            continue
        numbers = [n for s in deck.segments for _, n in deck.rows_in(s, card)]
        ref = FieldRef(card, numbers[0], field)
        if read_value(deck, ref):
            yield ref


@pytest.mark.parametrize("path", DECKS, ids=deck_id)
def test_nothing_changed_is_given_back_byte_for_byte(path, tmp_path):
    deck = read_deck_text(path)
    write_deck(deck, tmp_path / "deck")
    written = [p for p in (tmp_path / "deck").rglob("*") if p.is_file()]
    assert len(written) == len(deck.files)
    for copy in written:
        original = path.parent / copy.relative_to(tmp_path / "deck")
        assert copy.read_bytes() == original.read_bytes()


@pytest.mark.parametrize("path", DECKS, ids=deck_id)
def test_every_value_is_changed_alone(path):
    deck = read_deck_text(path)
    seen = 0
    for name in sorted(set(names_in(deck)) & movable().keys()):
        numbers = [n for s in deck.segments for _, n in deck.rows_in(s, name)][:3]
        for number in numbers:
            refs = [FieldRef(name, number, f) for f in definitions()[name].reals]
            values = {r: read_value(deck, r) for r in refs}
            for ref in [r for r in refs if values[r] is not None]:
                seen += 1
                new = writable((values[ref] or 1.0) * 1.0123456789)
                edited = set_values(deck, {ref: new})
                now = {r: read_value(edited, r) for r in refs}
                assert now == {**values, ref: new}
                assert set(changed_rows(deck, edited)) <= rows_of(deck, ref)
    assert seen


def rows_of(deck, ref):
    card = find_card(deck, ref.card, ref.id)
    return {(card.file, row) for row in card.rows}


def changed_rows(before, after):
    """Lines of the deck that a diff without context takes away."""
    files = {f"--- a/{name}": k for k, name in enumerate(names_in_tree(before))}
    file = -1
    for line in unified_diff(before, after, context=0).splitlines():
        if line in files:
            file = files[line]
        elif line.startswith("@@"):
            start, _, n = line.split()[1][1:].partition(",")
            yield from ((file, int(start) - 1 + k) for k in range(int(n or 1)))


@pytest.mark.parametrize("path", DECKS, ids=deck_id)
def test_pynastran_reads_the_value_that_is_reported(path, tmp_path):
    pytest.importorskip("pyNastran")
    from pyNastran.bdf.bdf import BDF

    deck = read_deck_text(path)
    new = {r: 1.0123456789 * (read_value(deck, r) or 0.0) for r in first_values(deck)}
    edited = set_values(deck, new)
    top = write_deck(edited, tmp_path / "deck")
    model = BDF(debug=None)
    model.enable_cards({card for card, _ in BY_PYNASTRAN})  # it refuses others that Nastran reads
    model.read_bdf(str(top), xref=False, punch=None)
    assert new
    for ref, value in new.items():
        found = BY_PYNASTRAN[ref.card, ref.field](model, ref.id)
        assert found == writable(value) == read_value(edited, ref)


@needs_data
def test_strided_cards_of_the_data_are_all_found():
    deck = read_deck_text(DATA / "nastran" / "all_elements" / "modes_elements.bdf")
    assert all(
        definitions()[name].several and name in names_in(deck) for name in ("PELAS", "PDAMP")
    )
