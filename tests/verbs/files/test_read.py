"""`read` gives the noun of any file that ``inspect`` knows."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
import scipy.sparse as sp

import trueup
from trueup.adapters.nastran import NastranMatrix, matrix_of, write_op4
from trueup.adapters.store import StoreContent, write_store
from trueup.adapters.universal import UniversalContent, write_universal
from trueup.verbs.files.read import FILE_KINDS, kind_of_file

FIXTURES = Path(__file__).parents[3] / "fixtures" / "duct"


def test_a_deck_and_a_test_are_those_of_their_own_readers() -> None:
    deck, test = trueup.read(FIXTURES / "duct.bdf"), trueup.read(str(FIXTURES / "duct_test.unv"))
    assert isinstance(deck, trueup.Deck)
    assert isinstance(test, trueup.Measurement)
    assert deck.counts == trueup.read_deck(FIXTURES / "duct.bdf").counts
    assert test.modes is not None
    assert len(test.modes) == 24


def test_a_part_of_a_test_is_what_the_file_holds(tmp_path: Path) -> None:
    test = trueup.read_test(FIXTURES / "duct_test.unv")
    write_universal(tmp_path / "geometry.unv", geometry=test.geometry)
    part = trueup.read(tmp_path / "geometry.unv")
    assert isinstance(part, UniversalContent)
    assert np.array_equal(part.geometry.ids, test.geometry.ids)


def test_matrices_and_stores(tmp_path: Path) -> None:
    matrix = matrix_of("KAAX", sp.csr_matrix(np.eye(3)))
    write_op4(tmp_path / "k.op4", [matrix])
    (again,) = trueup.read(tmp_path / "k.op4")
    assert isinstance(again, NastranMatrix)
    assert again.matrix.toarray().tolist() == np.eye(3).tolist()
    test = trueup.read_test(FIXTURES / "duct_test.unv")
    write_store(tmp_path / "test.h5", geometry=test.geometry)
    assert isinstance(trueup.read(tmp_path / "test.h5"), StoreContent)


def test_a_folder_that_is_no_run_and_a_file_of_no_format_are_refused(tmp_path: Path) -> None:
    with pytest.raises(trueup.InputError, match="is not a run folder"):
        trueup.read(tmp_path)
    (tmp_path / "a.txt").write_text("hello")
    with pytest.raises(trueup.InputError, match="the format is not recognised") as raised:
        trueup.read(tmp_path / "a.txt")
    assert raised.value.file == tmp_path / "a.txt"


def test_every_kind_has_its_readers() -> None:
    assert len({kind.name for kind in FILE_KINDS}) == len(FILE_KINDS) == 7
    for kind in FILE_KINDS:
        for function in (kind.describe, kind.read):
            with pytest.raises(trueup.InputError):
                function(FIXTURES / "absent.file")
    assert kind_of_file(FIXTURES / "mesh.bdf").name == "deck"
