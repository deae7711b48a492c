"""The line index against Python's own splitting, and against a plain reading of first words."""

import re

import pytest
from hypothesis import given, settings, strategies as st
from tests.work import calls_of

from trueup.adapters.nastran.text.source_file import (
    BLANK,
    CONTINUATION,
    REPLICATION,
    TextFile,
    index_lines,
    key_of,
    name_of,
)

PIECES = st.sampled_from(
    [b"GRID", b"grid*", b"PSHELL,3", b"+", b"*A", b"$ x", b" ", b"        ", b"\t", b",", b"=",
     b"1.5", b"\xe9", b"INCLUDE'a'", b"ENDDATA", b"\r", b"\n", b"\r\n", b"\x0c"]
)  # fmt: skip


@given(st.lists(PIECES, max_size=30).map(b"".join))
def test_lines_are_those_of_any_line_end(data):
    index = index_lines(data)
    expected = re.split(rb"\r\n|\n|\r", data)
    if expected[-1] == b"":
        expected.pop()
    assert [data[a:b] for a, b in zip(index.starts, index.ends, strict=True)] == expected


@pytest.mark.parametrize(
    ("line", "key"),
    [
        (b"GRID    1", key_of("GRID")),
        (b"grid*   1", key_of("GRID")),
        (b"PSHELL,3", key_of("PSHELL")),
        (b"PSHELL\t3", key_of("PSHELL")),
        (b"  PSHELL 3", key_of("PSHELL")),
        (b"INCLUDE'a.bdf'", key_of("INCLUDE")),
        (b"ENDDATA", key_of("ENDDATA")),
        (b"BCTPARAM1", key_of("BCTPARAM")),
        (b"+A1     1.", CONTINUATION),
        (b"*       1.", CONTINUATION),
        (b",1.", CONTINUATION),
        (b"        1.", CONTINUATION),
        (b"\t1.", CONTINUATION),
        (b"   +    1.", CONTINUATION),
        (b" " * 40 + b"1.", CONTINUATION),
        (b"$ GRID", BLANK),
        (b"   $ GRID", BLANK),
        (b" " * 12 + b"$ 1.", BLANK),
        (b" " * 30 + b"$ 1.", BLANK),
        (b"", BLANK),
        (b" " * 30, BLANK),
        (b"\t\t", BLANK),
        (b"=,*(1)", REPLICATION),
    ],
)
def test_what_a_line_starts(line, key):
    assert index_lines(b"$\n" + line + b"\nGRID").keys[1] == key


def test_names_come_back_from_their_keys():
    assert name_of(key_of("CQUAD4")) == "CQUAD4"


@pytest.mark.parametrize(
    ("line", "number"),
    [
        (b"GRID    12", 12),
        (b"GRID          12", 12),
        (b"GRID*                 12", 12),
        (b"GRID*   12", 12),
        (b"GRID,12,,1.", 12),
        (b"GRID*,12,,1.", 12),
        (b"GRID\t12\t0", 12),
        (b"GRID    12$ 3", 12),
        (b"GRID    1 2", -1),
        (b"GRID    A", -1),
        (b"GRID", -1),
        (b"GRID    99999999       1", 99999999),
        (b"  GRID,12", 12),
    ],
)
def test_numbers_in_all_formats(line, number):
    rows, ids = TextFile(None, line, line).rows_named("GRID")
    assert (rows.tolist(), ids.tolist()) == ([0], [number])


@settings(max_examples=30)
@given(st.lists(st.integers(1, 99_999_999), min_size=1, max_size=20))
def test_numbers_of_many_lines(numbers):
    data = b"".join(b"CQUAD4  %-8d1\n" % n for n in numbers)
    assert TextFile(None, data, data).rows_named("CQUAD4")[1].tolist() == numbers


def test_an_index_takes_no_call_a_line():
    def calls(n):
        data = b"".join(b"GRID    %-8d        1234.567-234.56789876.5432\n" % k for k in range(n))
        return calls_of(lambda: TextFile(None, data, data).rows_named("GRID"))

    assert calls(200_000) < calls(1_000) + 500  # some a hundred thousand lines
