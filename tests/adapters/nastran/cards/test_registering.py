"""Cards and elements that are added from outside the package, as docs/extending.md shows."""

import sys
from dataclasses import replace

import numpy as np
import pytest

import trueup
from trueup.adapters.nastran import (
    FieldRef,
    build_model,
    free_id,
    parse_parameter,
    read_deck,
    read_deck_text,
    read_value,
    set_values,
    split_property,
    write_deck,
)
from trueup.adapters.nastran.cards import FAMILIES, Card, Family, definitions, register_family
from trueup.adapters.universal import write_universal
from trueup.cli.app import run
from trueup.core.eigen.normal_modes import modes_of, solve
from trueup.core.elements import ELEMENTS, register_element
from trueup.core.errors import InputError

DECK = """SOL 103
CEND
METHOD = 1
BEGIN BULK
EIGRL,1,,,3
GRID,1,,0.,0.,0.,,123456
GRID,2,,3.,0.,4.,,456
GRID,3,,3.,0.,9.,,123456
CCABLE,11,3,1,2
CCABLE,12,4,2,3
PCABLE,3,1000.
PCABLE,4,200.,.4
CELAS2,21,50.,2,2
CONM2,31,2,,7.
ENDDATA
"""
# Along (0.6, 0, 0.8) with 1000, along z with 200; across with 50; mass 7 and half of 0.4 * 5.
STIFFNESS = np.array([[360.0, 0.0, 480.0], [0.0, 50.0, 0.0], [480.0, 0.0, 840.0]])
MASS = 8.0


@pytest.fixture
def cables(documented):
    """What docs/extending.md registers, gone again after the test."""
    families, elements = list(FAMILIES), dict(ELEMENTS)
    names = documented("An element") | documented("A card")
    yield names
    FAMILIES[:] = families
    ELEMENTS.clear()
    ELEMENTS.update(elements)


@pytest.fixture
def deck(tmp_path):
    path = tmp_path / "cables.bdf"
    path.write_text(DECK)
    return path


def frequencies(stiffness):
    return np.sqrt(np.linalg.eigvalsh(stiffness) / MASS) / (2.0 * np.pi)


def test_without_the_registration_the_deck_is_refused(deck):
    with pytest.raises(InputError, match=r"CCABLE.*not known") as told:
        build_model(read_deck(deck))
    assert (told.value.file.name, told.value.line) == ("cables.bdf", 9)


def test_it_is_read_and_solved_as_the_closed_form_has_it(cables, deck):
    model = build_model(read_deck(deck))
    assert model.K().toarray() == pytest.approx(STIFFNESS)
    assert model.M().toarray() == pytest.approx(MASS * np.eye(3))
    assert solve(model, 3).frequencies_hz == pytest.approx(frequencies(STIFFNESS))
    assert model.geometry.elements["line"].tolist() == [[0, 1], [1, 2]]


def test_its_property_moves(cables, deck):
    model = build_model(read_deck(deck), [parse_parameter("pull = PCABLE 3 STIFF [0.1, 3]")])
    assert model.parameters[0].handle == ("PCABLE 3 K",)
    moved = STIFFNESS + 1000.0 * np.outer([0.6, 0.0, 0.8], [0.6, 0.0, 0.8])
    assert model.K(np.array([2.0])).toarray() == pytest.approx(moved)


def test_its_text_is_edited_and_a_property_of_it_split(cables, deck, tmp_path):
    text = set_values(read_deck_text(deck), {FieldRef("PCABLE", 3, "K"): 2000.0})
    assert read_value(text, FieldRef("PCABLE", 3, "K")) == 2000.0
    split = split_property(text, "PCABLE", 3, [11], "a cable of its own")
    write_deck(split.deck, tmp_path / "out")
    again = read_deck(tmp_path / "out" / "cables.bdf")
    assert again.bulk.table("CCABLE")[11].pid == split.property
    assert again.bulk.table("PCABLE")[split.property].k == 2000.0


def test_the_command_line_tells_of_it(cables, deck, monkeypatch, capsys):
    monkeypatch.setattr(sys, "argv", ["trueup", "inspect", str(deck), "--json", "-"])
    assert run() == 0
    assert '"CCABLE": 2' in capsys.readouterr().out


@pytest.mark.parametrize(
    ("line", "wrong"),
    [
        ("PCABLE,3,1000", "K .*'1000', which is not a .*real number"),
        ("CCABLE,11,3,1", "must be given"),
        ("CCABLE,11,9,1,2", "refers to property 9, but there is no PCABLE 9"),
        ("CCABLE,11,3,1,7", "refers to grid 7, which does not exist"),
        ("CCABLE,11,3,1,1", "has no length"),
    ],
)
def test_what_is_wrong_with_it_is_said_as_of_any_card(cables, deck, line, wrong):
    name, number = line.split(",")[:2]
    lines = [line if t.startswith(f"{name},{number}") else t for t in DECK.splitlines()]
    deck.write_text("\n".join(lines))
    with pytest.raises(InputError, match=wrong) as told:
        build_model(read_deck(deck))
    assert told.value.line == lines.index(line) + 1


@pytest.mark.parametrize(
    ("card", "wrong"),
    [
        (Card("CONM2", "EID:i!", "eid"), "a card CONM2 already"),
        (Card("MINE", "EID:q!", "eid"), "'EID:q!': no kind of value is 'q'; known: i r w"),
        (Card("MINE", "EID:i!", "eid", elements="mine"), "MINE: there is no element 'mine'"),
        (Card("MINE", "EID:i!", "id"), "MINE: no field of its layout is 'id', its number"),
        (3, "a card of a family is given as int; it must be Card"),
    ],
)
def test_a_card_that_is_there_already_or_not_sound_is_refused(card, wrong):
    with pytest.raises(InputError, match=wrong):
        register_family(Family("mine", (card,)))


def test_a_shell_of_ones_own_needs_no_routine(tmp_path):
    """A card laid out as CQUAD4 that may have a PSHELL: an element of the core under its name."""
    square = """SOL 103
CEND
BEGIN BULK
GRID,1,,0.,0.,0.
GRID,2,,1.,0.,0.
GRID,3,,1.,1.,0.
GRID,4,,0.,1.,0.
CQUAD4,1,1,1,2,3,4
PSHELL,1,1,.01,1,,1
MAT1,1,2.1E11,,.3,7850.
ENDDATA
"""
    layout = definitions()["CQUAD4"].layout
    thin = replace(ELEMENTS["quad4"], name="mine")
    mine = Family("mine", (Card("MINE", layout, "eid", elements="mine", properties="PSHELL"),))
    decks = [tmp_path / "cquad4.bdf", tmp_path / "mine.bdf"]
    decks[0].write_text(square)
    decks[1].write_text(square.replace("CQUAD4", "MINE"))
    register_element(thin)
    register_family(mine)
    try:
        theirs, ours = (build_model(read_deck(path)) for path in decks)
        (told,) = trueup.inspect(decks[1]).files
        free = free_id(read_deck_text(decks[1]), "element")
    finally:
        FAMILIES.remove(mine)
        del ELEMENTS["mine"]
    assert (ours.K() != theirs.K()).nnz == 0
    assert ours.geometry.elements["quad"].tolist() == [[0, 1, 2, 3]]
    assert (told.contents["elements"], free) == ({"MINE": 1}, 2)


def net(n=4):
    """A net of cables on soft springs, held at two corners, a mass at each knot."""
    rng = np.random.default_rng(1)
    lines = ["SOL 103", "CEND", "METHOD = 1", "BEGIN BULK", "EIGRL,1,,,6"]
    lines += ["PCABLE,1,1000.", "PCABLE,2,300."]
    for i, j in np.ndindex(n, n):
        g, held = 10 * i + j + 1, "123456" if i == j and i in (0, n - 1) else "456"
        x, y, z = np.array([i, j, 0.2 * i * j]) + 0.05 * rng.standard_normal(3)
        lines.append(f"GRID,{g},,{x:.4f},{y:.4f},{z:.4f},,{held}")
        lines += [f"CONM2,{1000 + g},{g},,1.", f"CELAS2,{2000 + g},40.,{g},3"]
        for k, (di, dj, pid) in enumerate([(1, 0, 1), (0, 1, 2), (1, 1, 1), (1, -1, 2)], 1):
            if i + di < n and 0 <= j + dj < n:
                lines.append(f"CCABLE,{10 * g + k},{pid},{g},{g + 10 * di + dj}")
    return "\n".join([*lines, "ENDDATA"])


def test_an_update_finds_its_values(cables, tmp_path):
    deck, measured = tmp_path / "net.bdf", tmp_path / "net.unv"
    deck.write_text(net())
    moved = [parse_parameter("PCABLE 1 K"), parse_parameter("PCABLE 2 K")]
    model = build_model(read_deck(deck), moved)
    made = modes_of(model, solve(model, 6, p=np.array([1.3, 0.8])))
    write_universal(measured, geometry=model.geometry, modes=made)
    found = trueup.update(deck, measured, ["PCABLE 1 K", "PCABLE 2 K"], deck_length_unit="m")
    assert [p.factor for p in found.parameters] == pytest.approx([1.3, 0.8], rel=1e-3)
