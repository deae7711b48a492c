"""What of a pole stays from one model order to the next."""

from __future__ import annotations

import numpy as np

from trueup.core.identification.poles.plscf import PoleSet
from trueup.core.identification.poles.pole_stabilisation import stabilise


def test_a_pole_is_marked_by_what_of_it_stayed() -> None:
    omega, one = 2.0 * np.pi * 50.0, np.array([1.0, 0.0], complex)
    turned = np.array([np.cos(0.3), np.sin(0.3)], complex)  # MAC 0.91 with the other
    poles = (
        (0.010, one),  # the first of all
        (0.0102, one),
        (0.012, one),  # 18 % more damping
        (0.0121, turned),
        (0.0121, turned),
    )
    sets = [
        PoleSet(n, np.array([omega * (-zeta + 1j)]), part[None, :])
        for n, (zeta, part) in enumerate(poles, 1)
    ]
    (_, chart) = stabilise(sets, 10.0, 90.0)
    assert chart.level.tolist() == [0, 3, 1, 2, 3]
    assert chart.stable.tolist() == [False, True, True, True, True]
