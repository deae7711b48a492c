"""`convert` takes a deck with its INCLUDE files to another place."""

from pathlib import Path

import numpy as np
import pytest

import trueup
from trueup.core.errors import InputError

TOP = b"SOL 103\r\nCEND\r\nMETHOD=1\r\nSPC=1\r\nBEGIN BULK\r\nINCLUDE 'parts/\r\nmesh.inc'\r\n"
REST = b"EIGRL,1,,,3\r\nSPC1,1,123456,1\r\nENDDATA\r\nnotes at the end \xe4\r\n"
MESH = b"GRID,1,,0.,0.,0.\nGRID,2,,9.,0.,0.\nINCLUDE bars.inc\nCONM2,9,2,,.1"
BARS = b"$ \xb5m\nCBAR,1,1,1,2,0.,1.,0.\nPBAR,1,1,1.,1.,1.,1.\nMAT1,1,2.+5,,.3,1.-3\n"


@pytest.fixture
def deck(tmp_path: Path) -> Path:
    home = tmp_path / "home"
    (home / "parts").mkdir(parents=True)
    (home / "parts" / "mesh.inc").write_bytes(MESH)
    (home / "parts" / "bars.inc").write_bytes(BARS)
    (home / "top.bdf").write_bytes(TOP + REST)
    return home / "top.bdf"


def test_a_folder_gets_every_file_byte_for_byte(deck: Path, tmp_path: Path) -> None:
    told = trueup.convert(deck, tmp_path / "copy")
    assert told.written == {"files": "3, as they were"}
    for name in ("top.bdf", "parts/mesh.inc", "parts/bars.inc"):
        assert (tmp_path / "copy" / name).read_bytes() == (deck.parent / name).read_bytes()
    with pytest.raises(InputError, match="exists already"):
        trueup.convert(deck, tmp_path / "copy")


def test_one_file_holds_all_and_is_the_same_model(deck: Path, tmp_path: Path) -> None:
    with pytest.raises(InputError, match="2 INCLUDE files: give a folder, or merge=True"):
        trueup.convert(deck, tmp_path / "one.bdf")
    told = trueup.convert(deck, tmp_path / "one.bdf", merge=True)
    assert told.written == {"files": "3 in one"}
    text = (tmp_path / "one.bdf").read_bytes()
    assert b"INCLUDE" not in text
    assert text.startswith(TOP.partition(b"INCLUDE")[0])
    assert text.endswith(REST)
    assert BARS in text
    one, several = (trueup.solve(path).modes for path in (tmp_path / "one.bdf", deck))
    np.testing.assert_array_equal([m.frequency_hz for m in one], [m.frequency_hz for m in several])
    again = trueup.convert(tmp_path / "one.bdf", tmp_path / "two.bdf")
    assert again.written == {"files": "1, as it was"}
    assert (tmp_path / "two.bdf").read_bytes() == text


def test_merging_is_of_one_deck_into_one_file(deck: Path, tmp_path: Path) -> None:
    with pytest.raises(InputError, match="merge=True makes one file: give it one of"):
        trueup.convert(deck, tmp_path / "folder", merge=True)
    with pytest.raises(InputError, match="a deck as the only source"):
        trueup.convert([deck, deck], tmp_path / "one.bdf", merge=True)
    with pytest.raises(InputError, match="suffix '' is no format"):
        trueup.convert([deck, deck], tmp_path / "folder")
