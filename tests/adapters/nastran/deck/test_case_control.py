"""Factors of matrices that case control selects."""

from pathlib import Path

import pytest

from trueup.adapters.nastran.deck.case_control import read_case_control
from trueup.adapters.nastran.deck.logical_lines import Line
from trueup.core.errors import InputError


def read(text: str):
    return read_case_control([Line("SUBCASE 1", 0, 4), Line(text, 0, 5)], [Path("a.bdf")])[0]


def test_matrices_have_factors_as_nastran_writes_them():
    assert read("K2GG = STIF, (1.5+3)*MORE, 2.D0*LAST").k2gg == (
        ("STIF", 1.0), ("MORE", 1500.0), ("LAST", 2.0),
    )  # fmt: skip


@pytest.mark.parametrize("factor", ["1..2", "+", "2.-"])
def test_a_factor_that_is_no_number_is_refused_with_its_line(factor):
    with pytest.raises(InputError, match=r"a\.bdf line 5: K2GG: .* is not a number") as caught:
        read(f"K2GG = {factor}*STIF")
    assert caught.value.line == 5
