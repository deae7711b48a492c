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
