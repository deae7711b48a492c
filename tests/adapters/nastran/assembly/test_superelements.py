"""Parts of a deck (BEGIN SUPER) against the same structure in one piece."""

import numpy as np
import pytest

from trueup.adapters.nastran import build_model, read_deck, read_op4
from trueup.core.eigen.normal_modes import solve
from trueup.core.errors import InputError

HEAD = "SOL 103\nCEND\nSPC = 1\nMETHOD = 1\nBEGIN BULK\nEIGRL,1,,,8\n"
MATERIAL = "MAT1,1,7.+10,,.3,2700.\n"
HELD = "SPC1,1,123456,1,4,7,10\n"


def plate(nx, x0, first=1, pid=1, place=lambda x, y: (x, y, 0.0)):
    """Squares of 0.1, three across; grids, elements and the property from `first` and `pid`."""
    cards = []
    for k in range(4 * (nx + 1)):
        j, i = divmod(k, nx + 1)
        x, y, z = place(x0 + 0.1 * i, 0.1 * j)
        cards.append(f"GRID,{first + k},,{x:.6f},{y:.6f},{z:.6f}")
        if j < 3 and i < nx:
            a = first + k
            cards.append(f"CQUAD4,{a},{pid},{a},{a + 1},{a + nx + 2},{a + nx + 1}")
    return "\n".join([*cards, f"PSHELL,{pid},1,.01,1,,1\n"])


MAIN = plate(2, 0.0) + MATERIAL + HELD


@pytest.fixture
def frequencies(tmp_path):
    def found(bulk, head=HEAD):
        path = tmp_path / "parts.bdf"
        path.write_text(head + bulk + "ENDDATA\n")
        deck = read_deck(path)
        return solve(build_model(deck), 8).frequencies_hz, deck

    return found


@pytest.fixture
def whole(frequencies):
    return frequencies(plate(6, 0.0) + MATERIAL + "SPC1,1,123456,1,8,15,22\n")[0]


TURNED = plate(4, 0.2, place=lambda x, y: (5.0 - y, 0.8 + x, 3.0))


@pytest.mark.parametrize(
    ("more", "said"),
    [
        (f"BEGIN SUPER=1\n{plate(4, 0.2, 101, 101)}{MATERIAL}", ""),
        (f"begin bulk super = 1\n{plate(4, 0.2)}{MATERIAL}", "those of its elements, grids"),
        (
            f"BEGIN SUPER 1\n{plate(2, 0.2)}{MATERIAL}BEGIN SUPER=2\n{plate(2, 0.4)}MAT1,1,7.+10,,"
            ".3,2700.,,.1\nQSET1,0,901,THRU,910\nSPOINT,901,THRU,910\nEIGRL,1,,,3\n",
            "materials, properties",
        ),
        (
            "SEBULK,1,,,MANUAL\nSECONCT,1,0\n,101,3,106,6,111,9,116,12\n"
            f"BEGIN SUPER=1\n{plate(4, 0.2, 101, 101)}{MATERIAL}",
            "",
        ),
        (
            f"SELOC,1,1,5,16,3,9001,12\nPOINT,9001,,.6,0.,0.\nBEGIN SUPER=1\n{TURNED}{MATERIAL}",
            "is added",
        ),
        (
            "SEBULK,2,REPEAT,1\nSELOC,2,1,3,10,901,902,903\nPOINT,901,,.4,0.,0.\n"
            f"POINT,902,,.6,0.,0.\nPOINT,903,,.4,.3,0.\nBEGIN SUPER=1\n{plate(2, 0.2)}{MATERIAL}",
            "is added",
        ),
    ],
    ids=["own numbers", "same numbers", "three parts", "listed", "moved", "repeated"],
)
def test_parts_make_the_whole(frequencies, whole, more, said):
    found, deck = frequencies(MAIN + more)
    np.testing.assert_allclose(found, whole, rtol=1e-9)
    assert any("solved whole" in w for w in deck.warnings)
    assert any(said in w for w in deck.warnings)
    assert deck.counts["GRID"] >= 24


@pytest.mark.parametrize("card", ["SEEXCLD,1,0,106,111", "SEBNDRY,1,0,101,116"])
def test_grids_may_be_left_apart(frequencies, whole, card):
    found, _ = frequencies(f"{MAIN}{card}\nBEGIN SUPER=1\n{plate(4, 0.2, 101, 101)}{MATERIAL}")
    assert (found[:4] < whole[:4]).all()


def test_sets_of_a_part_are_those_of_its_subcase(frequencies):
    """The residual structure is free; its subcase is not the first."""
    cases = "METHOD=1\nSUBCASE 1\nSUPER=1\nSPC=7\nSUBCASE 2\nSUPER=0\nSPC=1\n"
    head = f"SOL 103\nCEND\n{cases}BEGIN BULK\n"
    part = f"BEGIN SUPER=1\n{plate(4, 0.2, 101, 101)}{MATERIAL}SPC1,7,123456,105,110,115,120\n"
    both, deck = frequencies(MAIN + part, head)
    assert deck.case.subcase == 2
    ends = "SPC1,1,123456,1,8,15,22\nSPC1,1,123456,7,14,21,28\n"
    np.testing.assert_allclose(both, frequencies(plate(6, 0.0) + MATERIAL + ends)[0], rtol=1e-9)


@pytest.mark.parametrize("residual", ["", "SPC=3\n"])
@pytest.mark.parametrize("sets", ["SPC1,7,123456,{}\n", "SPCADD,7,8\nSPC1,8,123456,{}\n"])
def test_a_part_is_held_by_the_set_of_its_subcase_alone(frequencies, residual, sets):
    cases = f"METHOD=1\nSUBCASE 1\nSUPER=1\nSPC=7\nSUBCASE 2\n{residual}"
    head = f"SOL 103\nCEND\n{cases}BEGIN BULK\n"
    held = sets.format("105,110,115,120") + "SPC1,3,123456,103\nSPC1,1,123456,104\n"
    part = f"BEGIN SUPER=1\n{plate(4, 0.2, 101, 101)}{MATERIAL}{held}"
    found, _ = frequencies(plate(2, 0.0) + MATERIAL + part, head)
    one = plate(6, 0.0) + MATERIAL + "SPC1,1,123456,7,14,21,28\n"
    np.testing.assert_allclose(found, frequencies(one)[0], rtol=1e-9)


def test_sets_of_superelements_in_the_main_bulk_hold_it_too(frequencies):
    """SESET, or SEID on a GRID: their subcases select constraints of the main bulk."""
    cases = "METHOD=1\nSUBCASE 1\nSUPER=1\nSPC=7\nSUBCASE 2\nSPC=1\n"
    bulk = plate(6, 0.0) + MATERIAL + "SPC1,1,123456,1,8\n{},15,22\nSESET,1,15,22\n"
    one = frequencies(bulk.format("SPC1,1,123456"))[0]
    head = f"SOL 103\nCEND\n{cases}BEGIN BULK\n"
    for own in ("SPC1,7,123456", "SPCADD,7,8\nSPC1,8,123456"):
        np.testing.assert_allclose(frequencies(bulk.format(own), head)[0], one, rtol=1e-12)


def test_a_set_that_a_part_does_not_have_is_told_by_its_own_number(frequencies):
    head = "SOL 103\nCEND\nSUBCASE 1\nSUPER=1\nSPC=7\nSUBCASE 2\nSPC=1\nBEGIN BULK\n"
    _, deck = frequencies(f"{MAIN}BEGIN SUPER=1\n{plate(4, 0.2, 101, 101)}{MATERIAL}", head)
    assert any("SPC = 7 of superelement 1, which has no SPC cards" in w for w in deck.warnings)


def test_superelements_of_the_main_bulk_are_solved_whole_and_said(frequencies, whole):
    bulk = plate(6, 0.0) + MATERIAL + "SPC1,1,123456,1,8,15,22\nSESET,1,4,thru,7\nCSUPEXT,1,3\n"
    found, deck = frequencies(bulk)
    np.testing.assert_allclose(found, whole, rtol=1e-12)
    assert any("SESET" in w and "not condensed" in w for w in deck.warnings)


@pytest.mark.parametrize(
    ("more", "sentence"),
    [
        ("SEBULK,1,MIRROR,2\n", "SEBULK 1 .*TYPE MIRROR are not supported"),
        ("SEBULK,2,MIRROR,1\n", "SEBULK 2 .*TYPE MIRROR without a BEGIN SUPER=2 are not"),
        ("SEBULK,2,REPEAT,3\n", "SEBULK 2 .* superelement 3, which the deck does not have"),
        ("SELOC,1,101,105,999,3,6,9\n", "SELOC 1 .* grid 999, which does not exist"),
        ("SECONCT,1,0\n,999,3\n", "SECONCT .* grid 999 of superelement 1, which has none"),
        ("SECONCT,1,0\n,--1,3\n", r"SECONCT 1: GRID \(field 10\) holds '--1'"),
        ("SECONCT,1,0\n,101,THRU,105,3\n", r"SECONCT 1: GRID \(field 15\) must be given"),
        ("CSUPER,1,0,3,6\n", "CSUPER 1.* are not supported"),
    ],
)
def test_what_cannot_be_joined_is_refused_when_it_is_assembled(frequencies, more, sentence):
    bulk = f"{MAIN}{more}BEGIN SUPER=1\n{plate(4, 0.2, 101, 101)}{MATERIAL}"
    with pytest.raises(InputError, match=sentence):
        frequencies(bulk)


def test_components_in_two_directions_are_refused(frequencies):
    part = plate(4, 0.2, 101, 101).replace(
        "GRID,101,,0.200000,0.000000,0.000000", "GRID,101,,.2,,,5"
    )
    cards = f"{MATERIAL}CORD2R,5,,0.,0.,0.,0.,0.,1.\n,0.,1.,0.\nSPC1,1,1,101\n"
    with pytest.raises(InputError, match="SPC1 names components of grid 101, whose displacement"):
        frequencies(f"{MAIN}BEGIN SUPER=1\n{part}{cards}")


def test_cards_that_got_another_number_do_not_vary(frequencies):
    _, deck = frequencies(f"{MAIN}BEGIN SUPER=1\n{plate(4, 0.2)}MAT1,1,6.+10,,.3,2700.\n")
    (number,) = set(deck.bulk.table("PSHELL")) - {1}
    fields = [*deck.bulk.fields("PSHELL", 1)]
    assert deck.bulk.replaced({("PSHELL", 1): fields})
    with pytest.raises(InputError, match="give it its own"):
        deck.bulk.replaced({("PSHELL", number): fields})


EXTERNAL = """ASSIGN INPUTT4='{0}/outboard.op4',UNIT=101
ASSIGN INPUTT4='{0}/inboard.op4',UNIT=102
SOL SEMFREQ
CEND
METHOD = 1
SUBCASE 1
ANALYSIS = MODES
SUPER = 0
BEGIN BULK
EIGR,1,AHOU,,,,100000
INCLUDE '{0}/outboard.asm'
INCLUDE '{0}/inboard.asm'
INCLUDE '{0}/outboard.pch'
INCLUDE '{0}/inboard.pch'
ENDDATA
"""


def test_external_superelements_are_those_of_nx(data, tmp_path):
    """Two components by EXTSEOUT, joined by their assembly punches: NX's 54 eigenvalues."""
    folder, path = data / "matrices/superelements", tmp_path / "assemble.dat"
    path.write_text(EXTERNAL.format(folder))
    found = solve(build_model(read_deck(path)), 54)
    (nx,) = (m for m in read_op4(folder / "nas2cam.op4") if m.name == "LAMBDA")
    hertz = np.sqrt(np.maximum(nx.matrix.toarray().ravel(), 0.0)) / (2.0 * np.pi)
    assert found.rigid_body_modes == 6
    np.testing.assert_allclose(found.frequencies_hz[6:], hertz[6:], rtol=1e-6)


def test_external_superelement_without_its_matrices_is_refused(data, tmp_path):
    folder, path = data / "matrices/superelements", tmp_path / "assemble.dat"
    text = EXTERNAL.format(folder)
    for old, new, sentence in (
        ("UNIT=102", "UNIT=103", "SEBULK 102 .*no unit of an ASSIGN INPUTT4"),
        ("inboard.op4", "outboard.op4", "outboard.op4 holds no KXX and MXX .* of 32 rows"),
    ):
        path.write_text(text.replace(old, new))
        with pytest.raises(InputError, match=sentence):
            build_model(read_deck(path))
