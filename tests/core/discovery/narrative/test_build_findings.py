"""What is told of an effect depends on how surely the test lies on the model."""

import numpy as np

from trueup.core.discovery.narrative.build_findings import frame_needed
from trueup.core.registration.alignment import Alignment


def placed(decided):
    return Alignment(np.eye(3), np.zeros(3), 1.0, ambiguity="a turn about z", decided=decided)


def test_a_round_test_in_a_frame_of_its_own_leaves_the_place_open():
    (said,) = frame_needed(placed(decided=False))
    assert "a turn about z" in said


def test_a_test_that_lies_on_the_model_needs_nothing():
    assert frame_needed(placed(decided=True)) == ()
