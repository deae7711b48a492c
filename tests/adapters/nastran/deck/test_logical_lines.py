"""Where a deck ends."""

from pathlib import Path

import pytest

from trueup.adapters.nastran import read_deck
from trueup.core.errors import InputError


def test_nothing_after_enddata_is_read(tmp_path: Path) -> None:
    (tmp_path / "a.bdf").write_text("GRID,1,,0.,0.,0.\nENDDATA\nINCLUDE 'absent.bdf'\nGRID,2\n")
    deck = read_deck(tmp_path / "a.bdf")
    assert deck.counts == {"GRID": 1}
    assert len(deck.files) == 1


def test_enddata_in_an_included_file_ends_the_deck(tmp_path: Path) -> None:
    (tmp_path / "a.bdf").write_text("GRID,1,,0.,0.,0.\nINCLUDE 'b.bdf'\nINCLUDE 'absent.bdf'\n")
    (tmp_path / "b.bdf").write_text("GRID,2,,0.,0.,0.\nENDDATA\n")
    assert read_deck(tmp_path / "a.bdf").counts == {"GRID": 2}


def test_an_include_before_enddata_must_exist(tmp_path: Path) -> None:
    (tmp_path / "a.bdf").write_text("GRID,1,,0.,0.,0.\nINCLUDE 'absent.bdf'\nENDDATA\n")
    with pytest.raises(InputError, match=r"a\.bdf line 2.*absent\.bdf"):
        read_deck(tmp_path / "a.bdf")


def test_continuations_of_a_sorted_deck_go_back_to_their_cards(tmp_path: Path) -> None:
    (tmp_path / "a.bdf").write_text(
        "CONM2   7       1               2.".ljust(72) + "+M7\n"
        "GRID    1               0.      0.      0.\n"
        "CONM2,8,1,,3.,,,,,+M8\n"
        "+M7     0.5\n"
        "+M8,0.25,,,,,,,,+M9\n"
    )
    masses = read_deck(tmp_path / "a.bdf").bulk.table("CONM2")
    assert masses[7].i[0] == 0.5
    assert masses[8].i[0] == 0.25


def test_a_label_that_fits_nowhere_continues_the_card_above(tmp_path: Path) -> None:
    (tmp_path / "a.bdf").write_text("GRID,1\nCONM2,8,1,,3.,,,,,+OLD\n+NEW,0.25\n")
    assert read_deck(tmp_path / "a.bdf").bulk.table("CONM2")[8].i[0] == 0.25


@pytest.mark.parametrize(
    ("one", "other"),
    [
        ("CORD2R,1,,0.,0.,0.,0.,0.,1.\n,1.,0.,0.", "CORD2C,1,,0.,0.,0.,0.,0.,1.\n,1.,0.,0."),
        ("PSHELL,1,1,1.", "PCOMP,1\n,1,1.,0."),
        ("MAT1,1,1.,,.3", "MAT8,1,1.,1.,.3"),
    ],
)
def test_numbers_that_mean_two_things(tmp_path: Path, one: str, other: str) -> None:
    (tmp_path / "a.bdf").write_text(f"{one}\n{other}\n")
    with pytest.raises(InputError, match=r"a\.bdf line \d: \w+ 1 has the number of \w+ 1 \("):
        read_deck(tmp_path / "a.bdf")


def test_an_auxiliary_model_is_left_out(tmp_path: Path) -> None:
    (tmp_path / "a.bdf").write_text(
        "SOL 200\nCEND\nBEGIN BULK\nGRID,1,,0.,0.,0.\nBEGIN BULK AUXMODEL = 1\nGRID,1,,5.\n"
        "GRID,7,,1.\nENDDATA\n"
    )
    deck = read_deck(tmp_path / "a.bdf")
    assert list(deck.bulk.table("GRID")) == [1]
    assert deck.bulk.table("GRID")[1].xyz == (0.0, 0.0, 0.0)
    assert any("a.bdf line 5" in w and "auxiliary" in w for w in deck.warnings)
