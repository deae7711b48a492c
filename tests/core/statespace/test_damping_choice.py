"""Damping as it is asked for: what is no choice is refused, what is far off said."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from trueup.core.errors import InputError
from trueup.core.statespace.damping_choice import choose_damping, read_damping

HZ = np.array([0.0, 10.0, 20.0])


@pytest.mark.parametrize(
    ("asked", "says"),
    [
        ("0.01,0.02", "two ratios for all"),
        ("1:0.01,1:0.02", "gives mode 1 two ratios"),
        ({"a": 0.02}, "'a' is no number of a mode"),
        (True, "a damping of 'True' is no damping ratio"),
    ],
)
def test_what_is_no_choice_is_refused(asked: Any, says: str) -> None:
    with pytest.raises(InputError, match=says):
        read_damping(asked)


def test_more_than_critical_is_said() -> None:
    ratios, notes = choose_damping(read_damping("5"), {}, HZ)
    assert ratios.tolist() == [0.0, 5.0, 5.0]
    assert notes == ["the damping of mode 2 is 5 times critical; 5 % is written 0.05"]
    assert choose_damping(read_damping("0.05"), {}, HZ)[1] == []


@pytest.mark.parametrize("asked", ["1:0.0, 2:0.03", {2: 0.03}, [0.0, 0.03]])
def test_modes_that_are_not_named_have_what_is_known(asked: Any) -> None:
    ratios, notes = choose_damping(read_damping(asked), {"deck": np.array([np.nan, 0.2, 0.2])}, HZ)
    assert ratios.tolist() == [0.0, 0.03, 0.2]
    assert notes == []
