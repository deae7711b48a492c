"""What a run holds."""

import numpy as np

from trueup.core.data.dofs import Dofs
from trueup.core.data.modes import Modes
from trueup.verbs.runs.run import _as_seen


def test_a_test_is_held_as_measured_at_the_sensors_that_are_still_seen():
    def modes(rows, scale):
        dofs = Dofs(np.array([5, 5, 9])[rows], np.array([1, 3, 3])[rows], np.eye(3)[rows])
        return Modes(np.array([2.0, 3.0]), scale * np.arange(6.0).reshape(3, 2)[rows], dofs)

    every, all_of_them = modes([0, 1, 2], 1.0), modes([0, 1, 2], -1.0)
    assert _as_seen(every, all_of_them) is every
    fewer = _as_seen(every, modes([0, 2], -1.0))
    assert list(fewer.dofs.node) == [5, 9]
    np.testing.assert_array_equal(fewer.shapes, [[0.0, 1.0], [4.0, 5.0]])
