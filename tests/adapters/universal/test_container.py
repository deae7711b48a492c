"""Datasets are found whatever became of the lines that separate them."""

from contextlib import ExitStack

import pytest

from trueup.adapters.universal.open_file import open_source
from trueup.core.errors import InputError

TWO = "    -1\n   151\nname\n    -1\n    -1\n    15\n         1         0\n    -1\n"


@pytest.fixture
def opened(write):
    """Open a universal file of the given content; it is closed after the test."""
    with ExitStack() as stack:
        yield lambda content: stack.enter_context(open_source(write(content)))


def found(source):
    return [(s.number, s.line, s.closed) for s in source.sections]


def test_number_and_line_of_each_dataset(opened):
    assert found(opened(TWO)) == [(151, 2, True), (15, 6, True)]


@pytest.mark.parametrize("end", ["\r\n", "\r"])
def test_any_line_end(opened, end):
    source = opened(TWO.replace("\n", end))
    assert [(s.number, s.line) for s in source.sections] == [(151, 2), (15, 6)]
    assert [source.lines(s) for s in source.sections] == [[b"name"], [b"         1         0"]]


def test_trailing_blanks_nulls_and_no_last_line_end(opened):
    text = TWO.replace("    -1\n", "    -1" + 74 * " " + "\n").rstrip("\n")
    assert found(opened(text)) == [(151, 2, True), (15, 6, True)]
    assert found(opened(TWO + "\x1a")) == [(151, 2, True), (15, 6, True)]


def test_a_stray_delimiter_loses_nothing_and_is_told(opened):
    text = TWO.replace("    -1\n    -1\n", "    -1\n    -1\n    -1\n")
    source = opened(text)
    assert [s.number for s in source.sections] == [151, 15]
    assert len(source.warnings) == 1
    assert "line 5: a stray -1" in source.warnings[0]


def test_a_lost_delimiter_loses_nothing_and_is_told(opened):
    source = opened(TWO.replace("    -1\n    -1\n", "    -1\n"))
    assert [s.number for s in source.sections] == [151, 15]
    assert [source.lines(s) for s in source.sections] == [[b"name"], [b"         1         0"]]
    assert "closes dataset 151 is missing" in source.warnings[0]


@pytest.mark.parametrize("last", [False, True])
def test_delimiter_glued_to_the_last_line(opened, last):
    head, tail = "    -1\n    15\n1.5    -1\n", "    -1\n   151\nname\n    -1\n"
    source = opened(tail + head if last else head + tail)
    by_number = {s.number: source.lines(s) for s in source.sections}
    assert by_number == {15: [b"1.5"], 151: [b"name"]}
    assert all(s.closed for s in source.sections)


def test_a_number_minus_one_in_ten_columns_is_data(opened):
    source = opened("    -1\n    82\n         1         2\n        -1\n    -1\n")
    assert source.lines(source.sections[0])[-1] == b"        -1"


def test_text_outside_datasets_is_listed(opened):
    source = opened("made by hand\n" + TWO + "\nthe end\n")
    assert [(s.what, s.line) for s in source.skipped] == [
        ("text outside any dataset", 1),
        ("text outside any dataset", 11),
    ]


def test_comments_after_the_number(opened):
    assert found(opened("    -1\n    55   %VALEURS AUX NOEUDS\nx\n    -1\n")) == [(55, 2, True)]


def test_cut_off(opened):
    assert found(opened(TWO[:-8])) == [(151, 2, True), (15, 6, False)]


def binary(block, n_byte, glued=True):
    head = b"    58b%6d%6d%12d%12d\n" % (1, 2, 11, n_byte)
    lines = [b"NONE"] * 6 + [b"%10d%10d%10d" % (2, 4, 1)] + [b"NONE"] * 4
    return (
        b"".join(
            [b"    -1\n", head, *(line + b"\n" for line in lines), block, b"" if glued else b"\r\n"]
        )
        + b"    -1\n"
    )


@pytest.mark.parametrize("announced", [16, 0, 999])
@pytest.mark.parametrize("glued", [True, False])
def test_binary_block_full_of_delimiters(opened, announced, glued):
    block = b"\0\n    -1\n    15\n"
    assert len(block) == 16
    source = opened(binary(block, announced, glued) + TWO.encode())
    assert [s.number for s in source.sections] == [58, 151, 15]
    assert source.read(source.sections[0].end - 16, source.sections[0].end) == block
    # lines as an editor counts them, those in the block included
    lines = source.path.read_bytes().split(b"\n")
    assert [lines[s.line - 1].split()[0] for s in source.sections] == [b"58b", b"151", b"15"]


def test_what_is_no_universal_file(write, tmp_path):
    with pytest.raises(InputError, match="not a universal file"):
        open_source(write("GRID,1,,0.,0.,0.\n"))
    with pytest.raises(InputError, match="is empty"):
        open_source(write(""))
    with pytest.raises(InputError, match=r"absent\.unv"):
        open_source(tmp_path / "absent.unv")
    with pytest.raises(InputError, match="cannot read"):
        open_source(tmp_path)
