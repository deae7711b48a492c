"""`trueup.inspect` and `trueup.convert`: files or nouns."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest

import trueup
from trueup.adapters.store import read_store

DUCT = Path(__file__).parents[2] / "fixtures" / "duct"


def test_what_a_file_holds_is_a_row() -> None:
    told = trueup.inspect([DUCT / "duct.bdf", DUCT / "duct_test.unv"])
    assert [f.format for f in told.files] == ["Nastran deck", "universal file"]
    assert trueup.inspect(trueup.read_deck(DUCT / "duct.bdf")).files[0] == told.files[0]
    assert isinstance(told.files[1].contents, dict)


def test_nouns_are_converted_like_the_files_they_came_from(tmp_path: Path) -> None:
    test = trueup.read_test(DUCT / "duct_test.unv")
    told = trueup.convert(test, tmp_path / "test.h5")
    assert set(told.written) == {"geometry", "modes"}
    held = read_store(tmp_path / "test.h5").modes["test"]
    assert test.modes is not None
    np.testing.assert_array_equal(held.shapes, test.modes.shapes)
    solved = trueup.solve(DUCT / "duct.bdf", 8)
    trueup.convert(solved, tmp_path / "analysis.unv")
    again = trueup.read_test(tmp_path / "analysis.unv").modes
    assert again is not None
    assert len(again) == 8


def test_a_deck_is_converted_like_its_file(tmp_path: Path) -> None:
    for name, source in (("a", DUCT / "duct.bdf"), ("b", trueup.read_deck(DUCT / "duct.bdf"))):
        trueup.convert(source, tmp_path / f"{name}.op4")
    assert (tmp_path / "a.op4").read_bytes() == (tmp_path / "b.op4").read_bytes()


@pytest.mark.parametrize(
    ("sources", "destination", "said"),
    [
        (3, "a.unv", "int cannot be converted"),
        ([], "a.unv", "at least one source"),
        ("nowhere.bdf", "a.unv", "does not exist"),
        (DUCT / "duct_test.unv", 3, "the destination is given as int"),
        (DUCT / "duct_test.unv", "a.xyz", "no format that can be written"),
        (DUCT / "duct_test.unv", "a.op4", "nothing that OP4 can hold"),
        ([DUCT / "duct_test.unv", 3], "a.unv", "files and objects"),
    ],
)
def test_what_cannot_be_converted_is_named(
    sources: Any, destination: Any, said: str, tmp_path: Path
) -> None:
    to = tmp_path / destination if isinstance(destination, str) else destination
    with pytest.raises(trueup.InputError, match=said):
        trueup.convert(sources, to)


@pytest.mark.parametrize("files", [3, [], [None], "nowhere.bdf"])
def test_what_cannot_be_inspected_is_named(files: Any) -> None:
    with pytest.raises(trueup.InputError):
        trueup.inspect(files)


def test_a_store_gives_matrices_the_names_of_their_source(tmp_path: Path) -> None:
    from trueup.adapters.nastran import matrix_of
    from trueup.verbs.files.delivery import TARGETS
    from trueup.verbs.files.exchange import Cargo, load

    cargo, store = Cargo(), tmp_path / "all.h5"
    for own in ("M", "M", "M_3"):
        cargo.add("matrices", own, matrix_of(own, np.eye(2)))
    TARGETS["h5"].write(store, cargo)
    again = load([store], None, None).matrices
    assert {name: m.name for name, m in again.items()} == {"M": "M", "M_2": "M", "M_3": "M_3"}
