"""Modes that cannot be used as they are."""

import numpy as np
import pytest

from trueup.core.correlation.odd_modes import said_of_odd
from trueup.core.data.dofs import Dofs
from trueup.core.data.modes import Modes
from trueup.core.errors import InputError

RNG = np.random.default_rng(5)
SHAPES = RNG.standard_normal((6, 4))


def modes(hz, shapes):
    return Modes(np.array(hz), shapes, Dofs(np.arange(6), np.full(6, 3)))


def test_sound_modes_need_no_word():
    assert said_of_odd(modes([10.0, 20.0, 20.0, 30.0], SHAPES)) == ()


def test_a_shape_of_zeros_is_named():
    (said,) = said_of_odd(modes([10.0, 20.0, 30.0, 30.0], SHAPES * [1.0, 1.0, 0.0, 0.0]))
    assert said == "test modes 3, 4: the shape is zero at every sensor, so nothing can pair"


def test_modes_at_rest_are_named_and_negative_frequencies_refused():
    (said,) = said_of_odd(modes([0.0, 1.0, 2.0, 3.0], SHAPES))
    assert said.startswith("test mode 1: the frequency is 0 Hz")
    with pytest.raises(InputError, match=r"mode 2 .* -5 Hz"):
        said_of_odd(modes([1.0, -5.0, 2.0, 3.0], SHAPES))
