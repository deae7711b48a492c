"""Where to put sensors and exciters."""

from __future__ import annotations

import numpy as np
import pytest

import trueup
from trueup.core.errors import InputError


def test_a_plan_is_told_and_written_for_the_test_system(call, duct, tmp_path):
    nodes = tmp_path / "sensors.unv"
    words = ("plan", duct / "duct.bdf", "--modes", "7:10", "-n", 8, "--directions", "XY",
             "--wanted", "40:X", "--out", nodes)  # fmt: skip
    said = call(*words)
    assert said.status == 0
    assert "8 sensors" in said.out
    found = trueup.plan(duct / "duct.bdf", 8, modes="7:10", directions="XY", wanted="40:X")
    assert ("40", "X") in {(str(s.node), s.direction) for s in found.sensors}
    assert {s.direction for s in found.sensors} <= {"X", "Y"}
    assert len(found.sensors) == 8
    assert [m.mode for m in found.modes] == [7, 8, 9, 10]
    assert found.largest_off_diagonal == pytest.approx(max(m.worst_mac for m in found.modes))
    np.testing.assert_allclose(np.diag(found.auto_mac), 1.0)
    written = trueup.read(nodes).geometry
    assert set(written.ids.tolist()) == {s.node for s in found.sensors}


def test_what_a_deck_has_not_cannot_be_planned(duct):
    deck = trueup.read_deck(duct / "duct.bdf")
    for given, said in (
        ({"modes": "3:8"}, "elastic modes 7 to"),
        ({"modes": "7:8", "wanted": "999999"}, "no sensor can be at 999999"),
        ({"modes": "7:9", "sensors": 2}, "fewer than 3 modes"),
        ({"modes": "7:8", "grids": "1", "sensors": 8}, "3 places can carry"),
        ({"method": "luck"}, "give one of independence, mac"),
    ):
        with pytest.raises(InputError, match=said):
            trueup.plan(deck, **given)
