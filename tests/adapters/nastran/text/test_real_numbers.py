"""Reals in 8 and 16 columns: exact where they fit, else the nearest; pyNastran reads the same."""

import math

import pytest
from hypothesis import given, strategies as st

from trueup.adapters.nastran.text.real_numbers import (
    format_exact,
    format_field,
    format_real,
    justified,
    parse_real,
    writable,
)
from trueup.core.errors import InputError

# Magnitudes that properties have in any consistent system of units.
REALS = st.floats(1e-30, 1e30) | st.floats(-1e30, -1e-30) | st.just(0.0)


@pytest.mark.parametrize(
    ("text", "value"),
    [
        ("2.1+5", 2.1e5),
        ("2.1-5", 2.1e-5),
        ("2.1D5", 2.1e5),
        ("2.1d+5", 2.1e5),
        ("2.1E5", 2.1e5),
        ("-.3", -0.3),
        (" 7.85E-9 ", 7.85e-9),
        ("1.", 1.0),
        ("+1.5", 1.5),
        ("12", 12.0),
    ],
)
def test_reads_the_forms_of_the_guide(text, value):
    assert parse_real(text) == value


@pytest.mark.parametrize("text", ["", "abc", "1.2.3", "nan", "inf", "1_0.", "1. 5", "0x1", "1e"])
def test_refuses_what_is_no_number(text):
    with pytest.raises(ValueError, match="not a number"):
        parse_real(text)


@pytest.mark.parametrize(
    ("value", "text"),
    [
        (70000.0, "70000."),
        (0.33, "0.33"),
        (2.7e-9, "2.7E-9"),
        (2.1e11, "2.1E+11"),
        (0.0, "0.0"),
        (-0.0, "0.0"),
        (1.234567, "1.234567"),
        (0.1234567, ".1234567"),
        (1.2345e-9, "1.2345-9"),
        (123456789.0, None),
        (1.23456789, None),
    ],
)
def test_eight_columns_hold_it_exactly_or_not_at_all(value, text):
    assert format_exact(value, 8) == text


@given(REALS)
def test_sixteen_columns_read_back_to_what_is_reported(value):
    text = format_real(value, 16)
    assert len(text) <= 16
    assert parse_real(text) == writable(value)
    assert "." in text
    assert math.isclose(writable(value), value, rel_tol=1e-10)


@given(st.floats(1e-9, 1e9))
def test_values_of_one_digit_exponents_keep_twelve_digits(value):
    assert math.isclose(writable(value), value, rel_tol=1e-12)


@given(REALS)
def test_writing_what_was_written_changes_nothing(value):
    assert writable(writable(value)) == writable(value)


@given(REALS)
def test_eight_columns_are_never_a_rounded_value(value):
    text = format_exact(value, 8)
    assert text is None or (len(text) <= 8 and parse_real(text) == value)


@given(REALS)
def test_pynastran_reads_the_same(value):
    pytest.importorskip("pyNastran")
    from pyNastran.bdf.bdf_interface.assign_type import double
    from pyNastran.bdf.bdf_interface.bdf_card import BDFCard

    card = BDFCard(["MAT1", format_real(value, 16)])
    assert double(card, 1, "E") == writable(value)


@pytest.mark.parametrize("value", [math.nan, math.inf, -math.inf])
def test_what_is_not_finite_is_never_written(value):
    with pytest.raises(InputError, match="not a finite number"):
        format_real(value)


def test_text_longer_than_a_field_is_refused():
    with pytest.raises(InputError, match="eight columns"):
        format_field("ABCDEFGHI", 16)
    with pytest.raises(InputError, match="eight columns"):
        format_field(123456789, 16)


@pytest.mark.parametrize(
    ("value", "error", "written"),
    [
        (15982.890983, 412.3, 15980.0),
        (15982.890983, 0.0412, 15982.891),
        (1.0234567891, 1e-9, 1.0234567891),
        (0.0123456, 0.00098, 0.01235),
        (-3.14159, 0.05, -3.142),
        (0.004, 0.3, 0.004),
        (2.5, float("nan"), 2.5),
        (2.5, 0.0, 2.5),
    ],
)
def test_a_value_has_the_figures_that_its_error_justifies(value, error, written):
    assert justified(value, error) == pytest.approx(written, rel=1e-14)
