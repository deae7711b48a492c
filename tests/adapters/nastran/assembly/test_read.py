"""Reading decks: files, cards, case control, and what is said when something is wrong."""

from pathlib import Path

import pytest
from hypothesis import given, strategies as st

from trueup.adapters.nastran import build_model, read_deck
from trueup.adapters.nastran.deck.raw_cards import fields_of
from trueup.adapters.nastran.text.real_numbers import parse_real
from trueup.core.errors import InputError

BAR = """\
GRID,1,,0.,0.,0.
GRID,2,,1.,0.,0.
CROD,1,1,1,2
PROD,1,1,1.
MAT1,1,1.,,.3,1.
"""


class TestFiles:
    def test_includes_are_found_beside_the_file_that_names_them(self, tmp_path):
        (tmp_path / "parts" / "deep").mkdir(parents=True)
        (tmp_path / "main.bdf").write_text(
            "SOL 103\nCEND\nBEGIN BULK\nINCLUDE 'parts/grids.bdf'\n"
            'INCLUDE "parts/\n deep/rod.bdf"\nENDDATA\nthis is not read\n'
        )
        (tmp_path / "parts" / "grids.bdf").write_text("GRID,1\ninclude deep/two.bdf $ unquoted\n")
        (tmp_path / "parts" / "deep" / "two.bdf").write_text("GRID    2               1.0\n")
        (tmp_path / "parts" / "deep" / "rod.bdf").write_text(BAR[BAR.index("CROD") :])
        deck = read_deck(tmp_path / "main.bdf")
        assert [f.name for f in deck.files] == ["main.bdf", "grids.bdf", "two.bdf", "rod.bdf"]
        assert deck.counts == {"GRID": 2, "CROD": 1, "PROD": 1, "MAT1": 1}
        deep = tmp_path / "parts" / "deep"
        assert str(deck.bulk.place("GRID", 2)) == f"GRID 2 ({deep / 'two.bdf'} line 1)"
        assert str(deck.bulk.place("PROD", 1)) == f"PROD 1 ({deep / 'rod.bdf'} line 2)"

    @pytest.mark.parametrize(
        ("text", "message"),
        [
            (
                "INCLUDE 'none.bdf'\n",
                r"main.bdf line 1: the INCLUDE file 'none.bdf' does not exist",
            ),
            ("INCLUDE 'none.bdf\n", r"main.bdf line 1: the quote after INCLUDE is never closed"),
            (
                "GRID,1\nINCLUDE 'main.bdf'\n",
                r"main.bdf line 2: INCLUDE 'main.bdf' includes itself",
            ),
            ("+,1\n", r"main.bdf line 1: a continuation without its card"),
            ("GRID,1,,x,0.,0.\n", r"main.bdf line 1: GRID 1: .*x"),
            (
                "GRID,1\nGRID,1,,2.\n",
                r"main.bdf line 2: GRID 1 is defined twice, first in .* line 1",
            ),
            ("GRID,1\n%setrepsym t=1.\n", r"main.bdf line 2: '%setrepsym t=1.': symbols \(%\)"),
            ("GRID,1,,%x%\n", r"main.bdf line 1: 'GRID,1,,%x%': symbols \(%\) are not"),
            ("$ nothing\n", r"no bulk data card was found"),
            ("BEGIN AFPM=1\nGRID,1\n", r"line 1: 'BEGIN AFPM=1' .*does not read"),
        ],
    )
    def test_what_cannot_be_read_is_said_with_file_and_line(self, tmp_path, text, message):
        (tmp_path / "main.bdf").write_text(text)
        with pytest.raises(InputError, match=message) as caught:
            read_deck(tmp_path / "main.bdf")
        assert "\n" not in str(caught.value)

    def test_a_missing_deck_is_named(self, tmp_path):
        with pytest.raises(InputError, match=r"cannot read .*none.bdf: No such file"):
            read_deck(tmp_path / "none.bdf")

    def test_reading_prints_nothing(self, tmp_path, capsys):
        (tmp_path / "main.bdf").write_text("GRID,1,,x,0.,0.\n")
        with pytest.raises(InputError):
            read_deck(tmp_path / "main.bdf")
        assert capsys.readouterr() == ("", "")


class TestFacts:
    def test_the_first_subcase_with_a_method_is_used(self, deck):
        found = deck(
            BAR + "EIGRL,7,0.1,200.,12\nEIGRL,8",
            "SPC = 1\nSUBCASE 3\n LABEL = no modes\nSUBCASE 5\n METHOD(STRUCTURE) = 7\n MPC=4\n"
            "SUBCASE 6\n METHOD=8\n SPC=9\n",
        )
        assert (found.case.subcase, found.case.spc, found.case.mpc) == (5, 1, 4)
        assert (found.eigen.v1, found.eigen.v2, found.eigen.nd) == (0.1, 200.0, 12)
        assert any("subcases 6 select other constraints" in w for w in found.warnings)

    @pytest.mark.parametrize(
        ("line", "unit"),
        [
            ("$ units: mm, t, N, s", "mm"),
            ("$*                      ... LENGTH : meter", "m"),
            ("PARAM,UNITSYS,LBF-IN", "in"),
            ("DTI,UNITS,1,KG,N,M,S", "m"),
            ("$ the unit of this part is 3", None),
        ],
    )
    def test_declared_length_unit(self, deck, line, unit):
        assert deck(BAR + line).length_unit == unit

    def test_units_that_disagree_are_not_guessed(self, deck):
        found = deck(BAR + "$ units: mm, t\nDTI,UNITS,1,KG,N,M,S")
        assert found.length_unit is None
        assert any("length unit is not clear" in w for w in found.warnings)

    def test_what_is_not_used_is_listed_with_line_and_reason(self, deck):
        found = deck(BAR + "FORCE,1,1,,1.,1.,0.,0.\nFORCE,2,1,,1.,1.,0.,0.\nWHATEVER,1")
        assert [(s["line"], s["why"]) for s in found.skipped] == [
            (10, "loads do not enter normal modes"),
            (12, "this card is not known"),
        ]
        assert "FORCE (2 cards" in found.skipped[0]["what"]
        assert any("WHATEVER is not known" in w for w in found.warnings)

    @pytest.mark.parametrize("card", ["CSEAM,9,9,1,2", "CQAUD4,9,9,1,2", "RSSCON,1"])
    def test_what_carries_stiffness_or_constraint_is_refused_by_name(self, deck, card):
        name = card.split(",")[0]
        with pytest.raises(InputError, match=rf"deck.bdf line 10: {name}"):
            build_model(deck(BAR + card))


def _small(values):
    return ["GRID    " + "".join(f"{v:>8}" for v in values)]


def _large(values):
    return [
        "GRID*   " + "".join(f"{v:>16}" for v in values[:4]) + "*A",
        "*A      " + "".join(f"{v:>16}" for v in values[4:]),
    ]


numbers = st.floats(-9999.0, 9999.0).map(lambda x: f"{x:.2f}")


class TestFields:
    @given(st.lists(st.one_of(numbers, st.just("")), min_size=8, max_size=8))
    def test_small_large_and_free_fields_hold_the_same(self, values):
        expected = ["GRID", *[v or None for v in values]]
        while expected[-1] is None:
            expected.pop()
        free = [",".join(["GRID", *values])]
        free_large = [",".join(["GRID*", *values[:4]]), ",".join(["*", *values[4:]])]
        for lines in (_small(values), _large(values), free, free_large):
            assert fields_of(lines) == expected

    @given(st.floats(allow_nan=False, allow_infinity=False))
    def test_reals_as_nastran_writes_them(self, value):
        text = f"{value:.16e}"
        mantissa, exponent = text.split("e")
        assert parse_real(text) == value
        assert parse_real(f"{mantissa}D{exponent}") == value
        assert parse_real(f"{mantissa}{exponent}") == value

    @pytest.mark.parametrize("text", ["", "1_000", "1.2.3", "abc", "--1", "1.+"])
    def test_what_is_no_number(self, text):
        with pytest.raises(ValueError):  # noqa: PT011
            parse_real(text)


@pytest.mark.parametrize(
    "path",
    [
        "truss_72/modes.dat", "ten_bar/modes.dat", "beam_pairs/beam_modes.dat",
        "frame/noReduction-000.dat", "svanberg_beam/modes.dat", "cantilever/noReduction.dat",
        "cantilever/dynamicReduction.dat",
        "plate/plate_py.dat", "mast/pn_mwe_s-solution_1.dat", "space_truss/full.dat",
        "solid_shell_bar/mode_solid_shell_bar.bdf", "all_elements/modes_elements.bdf",
        "garteur/garteur_fem.bdf",
    ],
)  # fmt: skip
def test_real_decks_are_read(data, path):
    file = data / "nastran" / path
    before = file.read_bytes()
    deck = read_deck(file)
    assert deck.counts["GRID"] > 5
    assert deck.eigen is not None
    assert Path(deck.path).read_bytes() == before


def test_what_case_control_selects_no_set_of_is_said(tmp_path):
    cards = "SPC1,4,123,1\nSPC,2,1,1\nMPC,3,1,2,1.,2,2,1.\n"
    (tmp_path / "a.bdf").write_text(f"SOL 103\nCEND\nBEGIN BULK\n{BAR}{cards}")
    told = [w for w in build_model(read_deck(tmp_path / "a.bdf")).warnings if "selects no" in w]
    assert [w.split(": ", 1)[1] for w in told] == [
        f"case control selects no {kind}: nothing is constrained by those of the deck (SID {sets})"
        for kind, sets in (("SPC", "2, 4"), ("MPC", "3"))
    ]


def test_parameters_above_the_subcases_override_bulk_data(tmp_path):
    path = tmp_path / "a.bdf"
    case = "PARAM,WTMASS,.5\nSUBCASE 1\nPARAM,G,.1\nPARAM,W3,7.\n"
    path.write_text(f"SOL 103\nCEND\n{case}BEGIN BULK\nPARAM,WTMASS,.2\nPARAM,G,.3\n{BAR}")
    assert read_deck(path).params == {"WTMASS": ".5", "G": ".3", "W3": "7."}


MASSES = """\
GRID,1
GRID,2
CELAS2,1,100.,1,1,2,1
CONM2,5,2,,{}
CONM2,6,1,,1.
DMIG,KX,0,6,1,0
DMIG,KX,2,1,,2,1,1.
"""


@pytest.mark.parametrize(
    ("text", "sentence"),
    [
        ("PARAM,WTMASS,abc\n" + MASSES.format("1."), r"PARAM \(.* line 1\): WTMASS is 'ABC'"),
        (MASSES.format("-1."), r"CONM2 5 \(.* line 4\): its mass .* leaves -1 at 2:1"),
        (MASSES.format("-1.") + "CONM2,7,2,,-1.\n", r"line 4\): .* \(also CONM2 7\).* -2 at 2:1"),
    ],
)
def test_what_is_wrong_in_numbers_is_told_with_its_line(tmp_path, text, sentence):
    (tmp_path / "a.bdf").write_text(text)
    with pytest.raises(InputError, match=sentence):
        build_model(read_deck(tmp_path / "a.bdf"))


def test_counterweights_are_no_fault(tmp_path):
    (tmp_path / "a.bdf").write_text(MASSES.format("1.5") + "CONM2,7,2,,-1.\n")
    build_model(read_deck(tmp_path / "a.bdf"))


@pytest.mark.parametrize(
    ("command", "said"),
    [
        ("", "DMIG KX is added nowhere: case control (K2GG, M2GG, ...) does not select it"),
        ("M2GG = 2.0*KX", None),
        ("K2GG = KX", None),
        ("B2GG = KX", None),
        ("B2PP = KX", "B2PP = KX is for response analyses; normal modes go without it"),
        ("K2PP = KX", "K2PP = KX is for response analyses; normal modes go without it"),
    ],
)
def test_direct_matrices_that_are_left_out_are_said(tmp_path, command, said):
    path = tmp_path / "a.bdf"
    path.write_text(f"CEND\n{command}\nBEGIN BULK\n{MASSES.format('1.')}")
    told = [w for w in read_deck(path).warnings if "KX" in w]
    assert told == ([] if said is None else told[:1])
    assert all(said in w for w in told)


@pytest.mark.parametrize(
    ("card", "said"),
    [
        ("PARAM,CM1,.5", "PARAM CM1 = .5 is not read"),
        ("PARAM,CK1,2.", None),
        ("MDLPRM,QR6ROT,1.+4,OFFDEF,NOMASS", "MDLPRM OFFDEF NOMASS is not read"),
        ("MDLPRM,HDF5,1,SHEARP,GARVEY", None),
        ("MDLPRM,DELMASS,.1", "MDLPRM DELMASS .1 is not read"),
        ("SET3,5,RBEEX,7", "SET3 5 selects rigid elements (RBEEX), which is not read"),
        ("SET3,6,RBEEX,7", None),
    ],
)
def test_parameters_of_matrices_that_are_not_read_are_said(tmp_path, card, said):
    case = "NASTRAN SYSTEM(414)=0\nCEND\nM2GG = KX\nMPC = 5\nBEGIN BULK\n"
    (tmp_path / "a.bdf").write_text(f"{case}{card}\n{MASSES.format('1.')}")
    told = [w for w in read_deck(tmp_path / "a.bdf").warnings if "is not read" in w]
    assert any(said in w for w in told) if said else not told
