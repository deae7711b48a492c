"""Bounds that nobody gave end before the cards stop making sense."""

from __future__ import annotations

import pytest

from trueup.adapters.nastran import parse_parameter
from trueup.core.errors import InputError

ROD = "GRID,1,,,,,,123456\nGRID,2,,1.\nMAT1,1,1.,,.3,1.\nCBAR,1,1,1,2,0.,1.,0.\n"
TUBE = ROD + "PBARL,1,1,,TUBE\n,.1,.085"
CUBE = (
    "".join(
        f"GRID,{1 + i + 2 * j + 4 * k},,{i}.,{j}.,{k}.\n"
        for i in (0, 1) for j in (0, 1) for k in (0, 1)
    )
    + "CHEXA,1,1,1,2,4,3,5,6\n,8,7\nPSOLID,1,1\nMAT1,1,1.,,.3,1."
)  # fmt: skip


@pytest.mark.parametrize(
    ("bulk", "text", "limit"),
    [(TUBE, "PBARL 1 DIM2", 0.1 / 0.085), (CUBE, "MAT1 1 NU", 0.5 / 0.3)],
)
def test_they_stay_within_what_the_cards_can_be(model, bulk, text, limit):
    found = model(bulk, [text])
    (parameter,) = found.parameters
    assert parameter.lower == 0.2
    assert 1.0 + 0.85 * (limit - 1.0) < parameter.upper < limit
    assert any(text in w and "make no sense" in w for w in found.warnings)


@pytest.mark.parametrize(("bulk", "text"), [(TUBE, "PBARL 1 DIM1"), (CUBE, "MAT1 1 E")])
def test_others_keep_theirs(model, bulk, text):
    found = model(bulk, [text])
    (parameter,) = found.parameters
    assert parameter.upper == 5.0
    assert parameter.lower == (0.2 if "E" in text else pytest.approx(1 - 0.9 * 0.15, abs=1e-3))


def test_bounds_that_were_given_are_kept_and_refused(model):
    with pytest.raises(InputError, match=r"TUBE do not fit together; give narrower bounds"):
        model(TUBE, ["PBARL 1 DIM2 [0.5, 3]"])
    assert parse_parameter("PBARL 1 DIM2 [0.5, 3]").upper == 3.0
