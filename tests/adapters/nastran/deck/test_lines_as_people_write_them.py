"""Replicated cards, wrong labels, names over two lines, values run together, stray statements."""

import pytest

from trueup.adapters.nastran import read_deck
from trueup.core.errors import InputError


@pytest.fixture
def read(tmp_path):
    def of(text):
        (tmp_path / "a.bdf").write_text(text)
        return read_deck(tmp_path / "a.bdf")

    return of


@pytest.mark.parametrize(
    ("above", "again"),
    [
        ("GRID,1,,0.5,1.,0.,,345\n", "=,*(1),=,*(0.1),*(-1.),==\n=(2)\n"),
        ("GRID,1,,0.5,1.,0.,,345\n", "=(3),*(1),=,*(.1),*(-1.),==\n"),
        (
            "GRID    1               0.5     1.      0.              345\n",
            "=       *1      =       *.1     *-1.    ==\n$ between\n=2\n",
        ),
        (
            "GRID*   1                               0.5             1.\n",
            "=,*(1),=,*(1.-1),*(-1.)\n=(2)\n",
        ),
    ],
)
def test_replication_writes_cards_out(read, above, again):
    """Steps are added in decimals: 0.5, 0.6, 0.7, 0.8, as they would be typed."""
    grids = read(above + again + "GRID,9,,1.,1.,1.\n").bulk.table("GRID")
    assert list(grids) == [1, 2, 3, 4, 9]
    assert [grids[k].xyz for k in (2, 3, 4)] == [
        (0.6, 0.0, 0.0),
        (0.7, -1.0, 0.0),
        (0.8, -2.0, 0.0),
    ]
    assert {grids[k].ps for k in (1, 2, 3, 4)} in ({"345"}, {None})


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("=,*(1)\n", "line 1: '=' replicates the card above"),
        ("CBAR,1,1,1,2,0.,1.,0.\n,,,.1\n=,*(1),==\n", "line 3: .* not a card of one line"),
        ("GRID,1,,1.,0.,0.\n=(2)\n", r"line 2: '=\(n\)' has no steps"),
        ("GRID,1,,1.,0.,0.\n=,*(1),*(1),==\n", r"line 2: \*\(1\) steps a field that holds ''"),
        ("GRID,1,,1.,0.,0.\n=x,*(1)\n", "line 2: '=x' is neither"),
    ],
)
def test_replication_of_nothing_is_named(read, text, message):
    with pytest.raises(InputError, match=rf"a\.bdf {message}"):
        read(text)


def test_a_card_may_take_fields_of_the_one_above(read):
    found = read("PBAR,1,9,12.5,3.,4.,5. $ a\nPBAR,2,8,==  $ b\nPBAR,3,=,*(.5),==\nMAT1,9,1.,,.3\n")
    bars = found.bulk.table("PBAR")
    assert [(bars[k].mid, bars[k].a, bars[k].j) for k in (1, 2, 3)] == [
        (9, 12.5, 5.0),
        (8, 12.5, 5.0),
        (8, 13.0, 5.0),
    ]


@pytest.mark.parametrize(
    ("again", "fine"),
    [("GRID*,1,0,1.0,0.", True), ("GRID,1,,.1+1,0.", True), ("GRID,1,,2.", False)],
)
def test_a_card_may_be_repeated_with_the_same_values(read, again, fine):
    text = f"GRID,1,,1.,,\n{again}\n"
    if fine:
        assert list(read(text).bulk.table("GRID")) == [1]
    else:
        with pytest.raises(InputError, match="GRID 1 is defined twice"):
            read(text)


def test_a_file_ahead_of_cend_may_be_missing(read):
    found = read("SOL 103\nINCLUDE 'alter.v9'\nCEND\nSPC = 3\nBEGIN BULK\nGRID,1,,0.\n")
    assert (found.case.spc, found.counts) == (3, {"GRID": 1})
    assert any("line 2: the INCLUDE file 'alter.v9' does not exist" in w for w in found.warnings)


def test_wrong_labels_of_continuations_are_named(read):
    mass = "CONM2   7       1               2.".ljust(72)
    found = read(f"{mass}+AA\n+BB     0.5\n{mass.replace('7 ', '8 ')}+CC\n+CC     0.25\n")
    assert found.bulk.table("CONM2")[7].i[0] == 0.5
    told = [w for w in found.warnings if "continuation" in w]
    assert len(told) == 1
    assert "a.bdf line 2: the continuation '+BB' follows a line that calls '+AA'" in told[0]


@pytest.mark.parametrize("name", ["sub/\ngrids.bdf", "sub/gr\n  ids.bdf", "sub/gr\nids\n.bdf $ x"])
def test_a_name_without_quotes_may_go_on(read, tmp_path, name):
    (tmp_path / "sub").mkdir()
    (tmp_path / "sub/grids.bdf").write_text("GRID,1,,0.,0.,0.\n")
    found = read(f"INCLUDE {name}\nGRID,2,,1.,0.,0.\n")
    assert found.counts == {"GRID": 2}
    assert b"".join(file.data for file in found.text.files[:1]) == (tmp_path / "a.bdf").read_bytes()


@pytest.mark.parametrize("form", ["INCLUDE,'x.bdf'", "INCLUDE='x.bdf'", "include = x.bdf $ c"])
def test_signs_ahead_of_a_name_are_no_part_of_it(read, tmp_path, form):
    (tmp_path / "x.bdf").write_text("GRID,1,,0.,0.,0.\n")
    assert read(f"{form}\nGRID,2,,1.,0.,0.\n").counts == {"GRID": 2}


def test_a_file_that_is_not_there_is_named_as_it_is_written(read):
    with pytest.raises(InputError, match=r"a\.bdf line 1: the INCLUDE file 'absent\.bdf' does not"):
        read("INCLUDE absent.bdf\nGRID,2,,1.,0.,0.\n")


def test_values_run_together_are_called_that(read):
    with pytest.raises(InputError, match=r"line 1: .*'401     1       1\.0', several values run"):
        read("CONM2,401     1       1.0\n")


def test_comments_and_statements_anywhere(read):
    found = read(
        "$ first\nNASTRAN SYSTEM(151)=1\nSOL 103 $ modes\nCEND\n$ case\nSPC = 1 $ held\n"
        "BEGIN BULK $ now\n  $ indented\n\nNASTRAN BUFFSIZE=65537\nGRID,1,,0.,0.,0. $ one\n"
        + "CONM2   7       1               2.".ljust(72)
        + "+A\n$ between\n\n+A      0.5  $ last\n"
    )
    assert (found.case.spc, list(found.bulk.table("GRID"))) == (1, [1])
    assert not [w for w in found.warnings if "NASTRAN" in w]


@pytest.mark.parametrize(
    ("cards", "command"),
    [("BGSET,1,1,2,.1\n", "BGSET = 1"), ("BCTABLE,1,,,1\nBCBODY,1,3D\n", "BCONT = 1")],
)
def test_glue_counts_where_it_is_selected(read, cards, command):
    text = "SOL 103\nCEND\n{}\nBEGIN BULK\nGRID,1,,0.\n" + cards
    left = read(text.format(""))
    assert not left.refused
    assert any("is left out: B" in w and "selects none" in w for w in left.warnings)
    assert read(text.format(command)).refused
