"""What is told of an effect depends on how surely the test lies on the model."""

from types import SimpleNamespace

import numpy as np
import pytest

from trueup.core.data.geometry import Geometry
from trueup.core.discovery.narrative.build_findings import frame_needed
from trueup.core.discovery.narrative.sentences import spot_of
from trueup.core.registration.alignment import Alignment


def placed(decided):
    return Alignment(np.eye(3), np.zeros(3), 1.0, ambiguity="a turn about z", decided=decided)


def test_a_round_test_in_a_frame_of_its_own_leaves_the_place_open():
    (said,) = frame_needed(placed(decided=False))
    assert "a turn about z" in said


def test_a_test_that_lies_on_the_model_needs_nothing():
    assert frame_needed(placed(decided=True)) == ()


@pytest.mark.parametrize(
    ("grids", "shared", "said"),
    [
        ([1], True, "near grid 1 (x = 0, y = 0, z = 0)"),
        ([1, 2], False, "near grid 1 (x = 0, y = 0, z = 0)"),
        ([1, 2], True, "at grids 1 and 2 together"),
        ([1, 2, 3, 4, 5], True, "over 5 grids together near grid 1 (x = 0, y = 0, z = 0)"),
    ],
)
def test_supports_that_give_together_are_told_by_their_grids(grids, shared, said):
    xyz = np.array([[1e-18, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 2.0, 0.0]])
    place = SimpleNamespace(where=({"grids": grids},), xyz=xyz, law=SimpleNamespace(shared=shared))
    assert spot_of(Geometry(np.arange(1, 4), xyz), place, 0) == said
