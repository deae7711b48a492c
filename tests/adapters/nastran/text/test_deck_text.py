"""All files of a deck as text: INCLUDE in all its forms, sections, and not a byte lost."""

from pathlib import Path

import pytest

from trueup.adapters.nastran.editing.find_cards import free_id, names_in
from trueup.adapters.nastran.text.deck_text import read_deck_text
from trueup.core.errors import InputError


def numbers(deck, name):
    return sorted(n for segment in deck.segments for _, n in deck.rows_in(segment, name))


def write(folder: Path, **files: str) -> Path:
    """Write files (``__`` in a name is a folder, ``_bdf`` its suffix); return the first."""
    paths = []
    for name, text in files.items():
        path = folder / (name.replace("__", "/").replace("_bdf", ".bdf"))
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_bytes(text.encode("latin-1"))
        paths.append(path)
    return paths[0]


@pytest.mark.parametrize(
    "statement",
    [
        "INCLUDE 'sub/mesh.bdf'",
        'INCLUDE "sub/mesh.bdf"',
        "INCLUDE sub/mesh.bdf",
        "include 'sub/mesh.bdf'",
        "INCLUDE'sub/mesh.bdf'",
        "INCLUDE 'sub/mesh.bdf' $ the mesh",
        "INCLUDE sub/mesh.bdf $ the mesh",
        "INCLUDE 'sub/\nmesh.bdf'",
        "INCLUDE 'sub/\n         mesh\n         .bdf'",
        "INCLUDE 'sub\\mesh.bdf'",
        "INCLUDE './sub/../sub/mesh.bdf'",
        "INCLUDE 'SUB:mesh.bdf'",
        "INCLUDE '$SUB/mesh.bdf'",
        "INCLUDE '%SUB%/mesh.bdf'",
        "INCLUDE 'sub/Mesh.BDF'",
    ],
)
def test_include_in_all_its_forms(tmp_path, monkeypatch, statement):
    monkeypatch.setenv("SUB", str(tmp_path / "sub"))
    top = write(
        tmp_path, deck_bdf=f"CEND\nBEGIN BULK\n{statement}\nPROD,2,1,1.\n", sub__mesh_bdf="GRID,1\n"
    )
    deck = read_deck_text(top)
    assert [f.path for f in deck.files] == [top, tmp_path / "sub" / "mesh.bdf"]
    assert (numbers(deck, "GRID"), numbers(deck, "PROD")) == ([1], [2])


def test_nested_includes_are_relative_to_their_own_file_first(tmp_path):
    top = write(
        tmp_path,
        run__deck_bdf="INCLUDE '../parts/wing.bdf'\nENDDATA\n",
        parts__wing_bdf="INCLUDE 'mesh.bdf'\nINCLUDE 'common.bdf'\n",
        parts__mesh_bdf="GRID,1\n",
        run__mesh_bdf="GRID,2\n",
        run__common_bdf="GRID,3\n",
    )
    deck = read_deck_text(top)
    assert numbers(deck, "GRID") == [1, 3]


def test_sections_may_stand_in_included_files(tmp_path):
    top = write(
        tmp_path,
        deck_bdf="INCLUDE 'control.bdf'\nGRID,1\nINCLUDE 'end.bdf'\nGRID,3\n",
        control_bdf="SOL 103\nCEND\nGRID,9\nBEGIN BULK\n",
        end_bdf="GRID,2\nENDDATA\nGRID,8\n",
    )
    deck = read_deck_text(top)
    assert numbers(deck, "GRID") == [1, 2]


def test_an_include_after_the_end_is_not_followed(tmp_path):
    top = write(tmp_path, deck_bdf="GRID,1\nENDDATA\nINCLUDE 'missing.bdf'\n")
    assert len(read_deck_text(top).files) == 1


def test_a_commented_include_is_not_followed(tmp_path):
    top = write(tmp_path, deck_bdf="GRID,1\n$INCLUDE 'missing.bdf'\n")
    assert len(read_deck_text(top).files) == 1


# One fault a row: the files, and what the message must say.
FAULTS = {
    "missing": ({"deck_bdf": "\nINCLUDE 'none.bdf'\n"}, "deck.bdf line 2: the INCLUDE file 'none"),
    "itself": ({"deck_bdf": "INCLUDE 'deck.bdf'\n"}, "line 1: INCLUDE 'deck.bdf' includes itself"),
    "circle": (
        {"deck_bdf": "INCLUDE 'a.bdf'\n", "a_bdf": "INCLUDE 'deck.bdf'\n"},
        "a.bdf line 1: INCLUDE 'deck.bdf' includes itself",
    ),
    "open quote": ({"deck_bdf": "INCLUDE 'a.bdf\nGRID,1\n"}, "quote after INCLUDE is never closed"),
    "no name": ({"deck_bdf": "INCLUDE \n"}, "INCLUDE names no file"),
    "symbol": ({"deck_bdf": "INCLUDE 'NOSUCH:a.bdf'\n"}, "symbol 'NOSUCH', which is not set"),
    "binary": ({"deck_bdf": "GRID\0\0"}, "is not a text file"),
    "binary part": ({"deck_bdf": "INCLUDE 'a.bdf'\n", "a_bdf": "GRID\0\0"}, "a.bdf is not a text"),
}


@pytest.mark.parametrize("fault", FAULTS)
def test_one_fault_is_one_clear_sentence(tmp_path, fault):
    files, says = FAULTS[fault]
    with pytest.raises(InputError) as error:
        read_deck_text(write(tmp_path, **files))
    assert says in str(error.value)
    assert "\n" not in str(error.value)


def test_a_missing_deck_is_named(tmp_path):
    with pytest.raises(InputError, match=r"nothing\.bdf: No such file"):
        read_deck_text(tmp_path / "nothing.bdf")


def test_an_empty_deck_has_no_cards(tmp_path):
    assert names_in(read_deck_text(write(tmp_path, deck_bdf=""))) == []


@pytest.mark.parametrize(
    ("kind", "bulk", "free"),
    [
        ("element", "CQUAD4,7\nRBE2,9\nGRID,50", 10),
        ("element", "CONM2*                12\nPLOTEL  8", 13),
        ("property", "PSHELL,7\nPARAM,POST,-1\nMAT1,90", 8),
        ("property", "PELAS,4,1.,,,25,2.", 26),
        ("element", "XLINK,30,1,2\nFORCE,7\nRFORCE,40", 41),
        ("material", "MAT1,7\nMAT8,12\nPSHELL,90", 13),
        ("grid", "GRID,7\nSPOINT,20,THRU,30", 31),
        ("grid", "GRID,99999999\nGRID,1\nGRID,2", 3),
        ("grid", "PSHELL,7", 1),
        ("coordinate", "CORD2R,7\nCQUAD4,90", 8),
        ("set", "SPC1,7,123,1\nMPC,3", 8),
    ],
)
def test_a_free_number_is_free_in_all_files(tmp_path, kind, bulk, free):
    top = write(tmp_path, deck_bdf="INCLUDE 'a.bdf'\n", a_bdf=bulk)
    assert free_id(read_deck_text(top), kind) == free


def test_free_numbers_are_not_guessed_where_cards_are_replicated(tmp_path):
    with pytest.raises(InputError, match="line 2: cards are replicated"):
        free_id(read_deck_text(write(tmp_path, deck_bdf="GRID,1\n=,*(1),==\n=(5)\n")), "grid")
    with pytest.raises(InputError, match="no numbers of 'rigid': ask for element, property"):
        free_id(read_deck_text(write(tmp_path, deck_bdf="GRID,1\n")), "rigid")
