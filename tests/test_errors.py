"""Every error tells its file, line and card as data, beside the sentence a person reads."""

from __future__ import annotations

import pickle
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

import trueup
from trueup.adapters import nastran, store
from trueup.adapters.nastran import set_values
from trueup.adapters.nastran.editing.find_cards import find_card
from trueup.adapters.nastran.matrices.read_matrices import read_matrices
from trueup.adapters.nastran.text.deck_text import read_deck_text
from trueup.core.eigen.mechanisms import Massless
from trueup.core.errors import CheckError, InputError, Place, naming
from trueup.verbs.studies.study import read_study

ROD = "GRID,1\nGRID,2,,1.,0.,0.\nCROD,5,7,1,2\nPROD,7,1,1.\nMAT1,1,1.,,.3,1.\n"
BAR = ROD.replace("CROD,5,7,1,2", "CBAR,5,7,1,2,{},0.,0.").replace("PROD,7,1,1.", "{}")


def built(path: Path) -> object:
    return nastran.build_model(trueup.read_deck(path))


def moved(path: Path, value: str = "PROD 7 J") -> object:
    return nastran.build_model(trueup.read_deck(path), [nastran.parse_parameter(value)])


def written(path: Path) -> object:
    (ref,) = nastran.parse_parameter("PROD 7 A").fields
    return set_values(read_deck_text(path), {ref: 1.5})


CASES: list[tuple[str, str, Callable[[Path], object], int | None, str | None, str]] = [
    ("a.bdf", "GRID,1\nCBAR,9,x,1,2\n", trueup.read_deck, 2, "CBAR 9", "{} line 2: CBAR 9: "),
    ("b.bdf", "+A,1\n", trueup.read_deck, 1, None, "{} line 1: a continuation without its card"),
    ("c.bdf", "INCLUDE 'no.bdf'\n", trueup.read_deck, 1, None, "{} line 1: the INCLUDE file"),
    ("d.bdf", ROD + "GRID,1,,9.\n", trueup.read_deck, 6, "GRID 1", "{} line 6: GRID 1 is defined"),
    ("u.bdf", "GRID,-3\n", built, 1, "GRID -3", "GRID -3 ({} line 1): the number"),
    ("e.bdf", "$ nothing\n", trueup.read_deck, None, None, "{}: no bulk data card was found"),
    ("f.bdf", ROD.replace("1,2\nP", "1,3\nP"), built, 3, "CROD 5", "CROD 5 ({} line 3) refers to"),
    ("g.bdf", ROD.replace("CROD,5,7", "CROD,5,8"), built, 3, "CROD 5", "CROD 5 ({} line 3) refers"),
    ("h.bdf", ROD.replace(",.3", ",.9"), built, 5, "MAT1 1", "MAT1 1 ({} line 5): Poisson"),
    ("i.bdf", BAR.format("1.", "PBAR,7,1,1.,1.,1.,1."), built, 3, "CBAR 5", "CBAR 5 ("),
    ("j.bdf", ROD + "CAABSF,8,1,1\n", built, 6, "CAABSF 8", "{} line 6: CAABSF 8"),
    ("k.bdf", ROD, moved, 4, "PROD 7", "parameter 'PROD 7 J': J is blank on PROD 7 ({} line 4)"),
    ("l.bdf", ROD, lambda p: find_card(read_deck_text(p), "PBAR", 3), None, "PBAR 3", ""),
    ("t.bdf", ROD, lambda p: moved(p, "PBAR 9 I1"), None, "PBAR 9", "{}: parameter 'PBAR 9 I1': "),
    ("m.bdf", ROD.replace("7,1,1.", "7,1,x"), written, 4, None, "m.bdf line 4: PROD 7 A is"),
    ("n.unv", "no universal file", trueup.read_test, None, None, "{} is not a universal file"),
    ("o.unv", "    -1\n  2411\n 1 1 1\n", trueup.read_test, 2, None, "{} line 2: the file ends"),
    ("p.h5", "no store", store.read_store, None, None, "{} is not an HDF5 file"),
    ("q.pch", "$\n", read_matrices, None, None, "{} holds no DMIG matrices"),
    ("r.op2", "abc", nastran.read_modes, None, None, "{}"),
    ("s.toml", "decc = 1\n", read_study, None, None, "study file {}: unknown key 'decc'"),
]  # fmt: skip


@pytest.mark.parametrize(("name", "text", "read", "line", "card", "sentence"), CASES)
def test_an_error_carries_file_line_and_card(
    tmp_path: Path, name: str, text: str, read: Callable[[Path], object],
    line: int | None, card: str | None, sentence: str,
) -> None:  # fmt: skip
    path = tmp_path / name
    path.write_text(text)
    with pytest.raises(InputError) as raised:
        read(path)
    error = raised.value
    assert (error.file, error.line, error.card) == (path, line, card), error
    assert str(error).startswith(sentence.format(path)), error


def test_a_place_is_named_as_a_person_would() -> None:
    file = Path("models/wing.bdf")
    assert str(Place(file, 40, "CBAR 12")) == "CBAR 12 (models/wing.bdf line 40)"
    assert str(Place(file, 40)) == "models/wing.bdf line 40"
    assert str(Place(file)) == "models/wing.bdf"
    assert str(Place(card="CBAR 12")) == "CBAR 12"
    assert str(Place(file, 40, shown="wing.bdf")) == "wing.bdf line 40"


def test_the_file_at_fault_is_named_once() -> None:
    with pytest.raises(CheckError, match=r"^a\.bdf: lost$") as outer, naming(Path("a.bdf")):
        raise CheckError("lost", card="GRID 1")
    assert (outer.value.file, outer.value.card) == (Path("a.bdf"), "GRID 1")
    with pytest.raises(InputError, match=r"^b\.bdf line 3: lost$"), naming(Path("a.bdf")):
        raise Place(Path("b.bdf"), 3).error("lost")


def test_an_error_comes_whole_out_of_another_process() -> None:
    error = Place(Path("a.bdf"), 3, "GRID 1").error("lost")
    again = pickle.loads(pickle.dumps(error))
    assert (str(again), vars(again)) == (str(error), vars(error))


def test_an_error_in_other_words_keeps_what_it_holds() -> None:
    found = Massless("two motions", np.eye(2)).reworded("a.bdf: two motions")
    assert str(found) == "a.bdf: two motions"
    assert found.motions.shape == (2, 2)


def test_a_real_beyond_nastran_s_range_is_named(tmp_path: Path) -> None:
    path = tmp_path / "a.bdf"
    for value in ("1.+39", "-2.E300"):
        path.write_text(ROD.replace("MAT1,1,1.,", f"MAT1,1,{value},"))
        with pytest.raises(InputError, match=r"line 5: MAT1 1: E .field 3. holds .*below 1\.E38"):
            trueup.read_deck(path)
