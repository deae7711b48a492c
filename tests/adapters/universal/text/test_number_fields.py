"""Numbers as Fortran and C print them are read exactly; what is no number is an error."""

import numpy as np
import pytest
from hypothesis import given, strategies as st

from trueup.adapters.universal.text.number_fields import NotANumber, floats, integers, table, text
from trueup.adapters.universal.text.print_columns import print_lines
from trueup.adapters.universal.text.printing import tight
from trueup.adapters.universal.text.read_columns import block


@pytest.mark.parametrize(
    ("printed", "values"),
    [
        (b"1.5 -2", [1.5, -2.0]),
        (b" 1.00000E+00-2.00000E-03", [1.0, -0.002]),
        (b"-1.33781e-001-5.07456e-003", [-0.133781, -0.00507456]),
        (b"1.0D+01 2.5d0", [10.0, 2.5]),
        (b"1.0-14 -3.25+102", [1e-14, -3.25e102]),
        (b"0.17977+309", [1.7977e308]),
        (b".5 5.", [0.5, 5.0]),
    ],
)
def test_floats_as_they_are_met(printed, values):
    np.testing.assert_array_equal(floats([printed]), values)


@pytest.mark.parametrize("word", [b"*************", b"1.0E", b"--1", b"abc", b"1.2.3"])
def test_what_is_no_number_is_an_error_that_knows_its_line(word):
    with pytest.raises(NotANumber) as caught:
        floats([b"1.0 2.0", b"3.0 " + word])
    assert caught.value.row == 1
    assert caught.value.text == word.decode()


def test_nan_stays_nan():
    assert np.isnan(floats([b"NaN"])).all()


def test_columns_where_labels_fill_them():
    line = b"12345678901234567890         0        11  1.00000E+00"
    np.testing.assert_array_equal(
        table([line], (10, 10, 10, 10, 13)), [[1234567890, 1234567890, 0, 11, 1.0]]
    )


def test_a_blank_field_is_an_error_not_a_zero():
    with pytest.raises(NotANumber):
        table([b"         1                   3"], (10, 10, 10))


def test_integers_stop_at_a_comment():
    assert integers(b"      1011     % NOEUD NO1011") == [1011]


def test_text_is_utf8_or_latin1():
    assert text("Größe²".encode()) == text("Größe²".encode("latin-1")) == "Größe²"


def from_bytes(content):
    """What `block` reads by: the bytes between two offsets."""
    return lambda begin, end: content[begin:end]


NUMBERS = st.lists(
    st.floats(allow_nan=False, allow_infinity=False, width=64), min_size=1, max_size=60
)


@given(NUMBERS, st.sampled_from([(13, "5E", 6), (20, "12e", 4), (13, "4E", 6), (20, "11E", 4)]))
def test_blocks_are_read_as_python_reads_each_number(values, form):
    width, kind, per_line = form
    fields = [f"{v:{width}.{kind}}" for v in values]
    lines = ["".join(fields[k : k + per_line]) for k in range(0, len(fields), per_line)]
    content = "".join(line + "\n" for line in lines).encode()
    found, surplus = block(from_bytes(content), 0, len(content), (width,) * per_line, len(values))
    np.testing.assert_array_equal(found, [float(f) for f in fields])
    assert surplus == 0


TIES = st.builds(lambda m, k: (m + 0.5) * 10.0**k, st.integers(0, 10**6), st.integers(-6, 6))
NINES = st.builds(lambda n, k: (1.0 - 10.0**-n) * 10.0**k, st.integers(1, 16), st.integers(-99, 99))


@given(
    st.lists(
        st.floats(allow_nan=False, allow_infinity=False) | TIES | NINES | st.just(-0.0),
        min_size=1,
        max_size=30,
    ),
    st.sampled_from([(13, 5, 6), (20, 12, 4)]),
)
def test_lines_are_printed_as_python_prints_each_number(values, form):
    width, decimals, per_line = form
    fields = [f"{v:{width}.{decimals}E}" for v in values]
    lines = ["".join(fields[k : k + per_line]) for k in range(0, len(fields), per_line)]
    printed = b"".join(print_lines(np.array(values), width, decimals, per_line))
    assert printed.decode() == "".join(line + "\n" for line in lines)


@given(st.lists(st.floats(-1e6, 1e6), min_size=24, max_size=24), st.integers(0, 23))
def test_one_odd_field_among_regular_ones(values, at):
    fields = [f"{v:13.5E}" for v in values]
    fields[at] = " 1.00000-101 "
    content = "".join("".join(fields[k : k + 6]) + "\n" for k in range(0, len(fields), 6)).encode()
    found, _ = block(from_bytes(content), 0, len(content), (13,) * 6, 24)
    expected = [float(f"{v:13.5E}") for v in values]
    expected[at] = 1e-101
    np.testing.assert_array_equal(found, expected)


def test_padding_of_the_last_line_is_surplus():
    content = b"  1.00000E+00  2.00000E+00  3.00000E+00  0.00000E+00  0.00000E+00  0.00000E+00\n"
    found, surplus = block(from_bytes(content), 0, len(content), (13,) * 6, 3)
    np.testing.assert_array_equal(found, [1, 2, 3])
    assert surplus == 3


@pytest.mark.parametrize("bad", [b"    *********", b"  1.0000oE+00", b"  x.00000E+00"])
def test_a_bad_field_in_a_long_block_names_its_line(bad):
    line = b"  1.00000E+00" * 6 + b"\n"
    content = line * 40 + line.replace(b"  1.00000E+00", bad, 1) + line * 5
    with pytest.raises(NotANumber) as caught:
        block(from_bytes(content), 0, len(content), (13,) * 6, 46 * 6)
    assert caught.value.row == 40


@given(st.floats(allow_nan=False, allow_infinity=False))
def test_tight_fits_its_columns_and_keeps_the_most(value):
    printed = tight(value)
    assert len(printed) == 13
    assert printed[:1] == b" "
    assert b"." in printed  # without a point Fortran would divide by 100000
    if value and 1e-99 < abs(value) < 1e99:
        assert abs(float(printed) / value - 1.0) < 1e-5
    if 1.0 <= abs(value) < 1e9:
        assert abs(float(printed) / value - 1.0) < 1e-9
