"""Where a place may be besides if the test may lie on the model in several ways."""

import numpy as np
import pytest

from trueup.core.data.geometry import Geometry
from trueup.core.discovery.narrative.open_frame import frame_needed, images
from trueup.core.registration.alignment import Alignment, Candidate
from trueup.core.sensors.rigid_transform import Transform

PLACE = np.array([3.0, 1.0, 0.0])
OTHER = np.array([0.4, 0.1, 0.0])
PANEL = Geometry(np.array([7, 8, 9]), np.array([[1.0, 1.0, 0.0], [3.5, 2.0, 0.0], [0.0, 2.0, 0.0]]))
HALF = np.diag([-1.0, -1.0, 1.0])


def lies(decided, score=0.9, other=0.9):
    """Return a test that lies on a panel from 0 to 4 by 0 to 2 this way or turned by half."""
    here, turned = Transform(np.eye(3), np.zeros(3)), Transform(HALF, np.array([4.0, 2.0, 0.0]))
    both = Candidate(here, 0.0, score), Candidate(turned, 0.0, other)
    return Alignment(
        np.eye(3), np.zeros(3), ambiguity="2 positions", decided=decided, candidates=both
    )


def test_a_place_moves_with_the_test():
    assert images(lies(False), PLACE) == pytest.approx(np.array([[1.0, 1.0, 0.0]]))
    turned = Alignment(
        HALF, np.array([4.0, 2.0, 0.0]), decided=False, candidates=lies(False).candidates[::-1]
    )
    assert images(turned, np.array([1.0, 1.0, 0.0])) == pytest.approx(PLACE[None])


def test_both_places_are_told():
    (said,) = frame_needed(lies(False), PANEL, [PLACE])
    one = "near grid 7 (x = 1, y = 1, z = 0)"
    assert said.endswith(f"now it may as well be {one}")
    (said,) = frame_needed(lies(False), PANEL, [PLACE, OTHER])
    assert said.endswith(f"{one}, and near grid 8 (x = 3.5, y = 2, z = 0)")


@pytest.mark.parametrize("alignment", [lies(True), lies(False, other=0.5)])
def test_a_position_that_is_worse_is_none(alignment):
    assert images(alignment, PLACE).shape == (0, 3)


def test_a_round_test_in_a_frame_of_its_own_leaves_the_place_open():
    open_turn = Alignment(np.eye(3), np.zeros(3), ambiguity="a turn about z", decided=False)
    (said,) = frame_needed(open_turn, PANEL, [PLACE])
    assert "a turn about z" in said
    assert "known but for such a turn" in said


def test_a_test_that_lies_on_the_model_needs_nothing():
    assert frame_needed(lies(True), PANEL, [PLACE]) == ()
