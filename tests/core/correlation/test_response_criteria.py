import numpy as np
import pytest

from trueup.core.correlation.response_criteria import frac
from trueup.core.errors import InputError

OMEGA = np.linspace(0.5, 1.5, 400)


def response(omega, zeta=0.01):
    return 1.0 / (omega**2 - OMEGA**2 + 2j * zeta * omega * OMEGA)


def test_a_factor_does_not_count_and_a_shift_does():
    h = response(1.0)
    found = frac(np.array([h, h, h]), np.array([(2.0 - 3.0j) * h, response(1.002), response(1.1)]))
    assert found[0] == pytest.approx(1.0)
    assert 1.0 > found[1] > 0.9 > 0.05 > found[2]


def test_shift_of_a_resonance_by_its_half_width_in_closed_form():
    # The integral of h1* h2 over all frequencies, for 1/(x + i g): |2g/(d + 2ig)|^2.
    x, g, d = np.linspace(-400.0, 400.0, 400_001), 1.0, 1.0
    found = frac(1.0 / (x + 1j * g), 1.0 / (x - d + 1j * g))
    assert found == pytest.approx(4.0 * g**2 / (d**2 + 4.0 * g**2), rel=1e-2)


def test_a_function_of_zeros_agrees_with_nothing():
    assert frac(np.zeros((1, 3)), np.ones((1, 3)))[0] == 0.0


def test_other_lines_are_refused():
    with pytest.raises(InputError, match="different lines"):
        frac(np.ones((1, 3)), np.ones((1, 4)))
