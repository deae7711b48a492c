"""Factors of matrices that case control selects."""

from pathlib import Path

import pytest

from trueup.adapters.nastran.deck.case_control import read_case_control
from trueup.adapters.nastran.deck.logical_lines import Line
from trueup.adapters.nastran.deck_reader import read_deck
from trueup.core.errors import InputError


def read(text: str):
    return read_all(f"SUBCASE 1\n{text}")[0]


def read_all(text: str):
    lines = [Line(line, 0, 4 + k) for k, line in enumerate(text.splitlines())]
    return read_case_control(lines, [Path("a.bdf")])


def test_matrices_have_factors_as_nastran_writes_them():
    assert read("K2GG = STIF, (1.5+3)*MORE, 2.D0*LAST").k2gg == (
        ("STIF", 1.0), ("MORE", 1500.0), ("LAST", 2.0),
    )  # fmt: skip


@pytest.mark.parametrize("factor", ["1..2", "+", "2.-"])
def test_a_factor_that_is_no_number_is_refused_with_its_line(factor):
    with pytest.raises(InputError, match=r"a\.bdf line 5: K2GG: .* is not a number") as caught:
        read(f"K2GG = {factor}*STIF")
    assert caught.value.line == 5


@pytest.mark.parametrize(
    "text",
    [
        "METHOD = 1\nSTATSUB(PRELOAD) = 1",
        "SUBCASE 1\nLOAD = 2\nSUBCASE 2\nMETHOD = 1\nSTATSUB = 1",
        "METHOD = 1\nSUBCASE 1\nANALYSIS = STATICS\nSUBCASE 2\nANALYSIS = MODES",
    ],
)
def test_loads_that_would_stiffen_the_structure_are_said(text):
    _, warnings = read_all(text)
    assert any("unloaded structure" in w for w in warnings)
    _, quiet = read_all("SUBCASE 1\nANALYSIS = MODES\nMETHOD = 1\nSUBCASE 2\nANALYSIS = STATICS")
    assert not quiet


def test_subcases_of_an_optimisation_do_not_load_each_other(tmp_path):
    cases = "SUBCASE 1\nANALYSIS = STATICS\nSUBCASE 2\nANALYSIS = MODES\nMETHOD = 1\n"
    bulk = "BEGIN BULK\nEIGRL,1,,,1\nGRID,1\nCELAS2,1,1.,1,1\nCONM2,2,1,,1.\nENDDATA\n"
    for number, loaded in (("200", False), ("401", True)):
        path = tmp_path / "deck.bdf"
        path.write_text(f"SOL {number}\nCEND\n{cases}{bulk}")
        assert any("unloaded" in w for w in read_deck(path).warnings) is loaded


def test_parameters_of_other_subcases_are_theirs(tmp_path):
    path = tmp_path / "deck.bdf"
    for first, mine in ((1, "2."), (2, "3.")):
        cases = f"SUBCASE {first}\nMETHOD = 1\nPARAM,WTMASS,{mine}\nSUBCASE 7\nPARAM,WTMASS,4.\n"
        path.write_text(f"SOL 103\nCEND\n{cases}BEGIN BULK\nEIGRL,1,,,1\nGRID,1\nENDDATA\n")
        assert read_deck(path).param("WTMASS", 1.0) == float(mine)


def test_of_subcases_without_modes_the_first_of_structure_is_taken_and_said():
    text = "SUBCASE 1\nSPC = 1\nTHERMAL = ALL\nSUBCASE 2\nSPC = 2\nSUBCASE 3\nSPC = 3\n"
    case, (told,) = read_all(text)
    assert (case.subcase, case.spc) == (2, 2)
    assert told.startswith("subcase 2 is used; subcases 3 select other constraints")
    assert read_all("THERMAL = ALL\nSPC = 4\nSUBCASE 1\nLOAD = 2\n")[0].spc == 4


def test_a_subcase_may_be_for_a_set_of_superelements():
    text = "SET 1 = 1 THRU 99999999\nSET 5 = 2, 4 THRU 6\nSUBCASE 1\nSUPER = 5\nSPC = 7\n"
    case, _ = read_all(f"{text}SUBCASE 2\nMETHOD = 3\nSUPER = 0\nSPC = 8\n")
    assert (case.subcase, case.spc) == (2, 8)
    assert case.of_parts == tuple((k, (7, None)) for k in (2, 4, 5, 6))
    shared, _ = read_all("SET 9 = 0, 3\nMETHOD = 3\nSUBCASE 1\nSUPER = 9\nSPC = 7\n")
    assert (shared.spc, shared.of_parts) == (7, ((3, (7, None)),))
