"""The exponential window of a hammer test: records that were windowed, not poles moved."""

import numpy as np
import pytest

from trueup.core.data.dofs import Dofs
from trueup.core.data.frfs import Frfs
from trueup.core.errors import InputError
from trueup.core.identification.identify import identify
from trueup.core.identification.survey.exponential_window import decay_rate

HZ, ZETA = np.array([21.0, 34.0, 55.0]), np.array([0.002, 0.004, 0.003])
RECORD, RATE, TAU = 4.0, 512.0, 4.0 / np.log(100.0)


@pytest.fixture(scope="module")
def windowed():
    """Records of accelerations after a blow, cut when 1 % of the window is left, transformed."""
    rng = np.random.default_rng(3)
    shapes = rng.standard_normal((12, len(HZ)))
    t = np.arange(int(RECORD * RATE)) / RATE
    omega = 2.0 * np.pi * HZ
    damped = omega * np.sqrt(1.0 - ZETA**2)
    poles = -ZETA * omega + 1j * damped
    decays = (poles**2 * np.exp(np.outer(t, poles)) / damped).imag
    residues = shapes[:, None, :] * shapes[None, :2, :]
    values = np.fft.rfft((residues @ decays.T) * np.exp(-t / TAU)) / RATE
    f = np.fft.rfftfreq(len(t), 1.0 / RATE)
    use = (f > 15.0) & (f < 65.0)
    values = values[..., use]
    level = 1e-3 * np.abs(values).mean()
    values = values + level * (
        rng.standard_normal(values.shape) + 1j * rng.standard_normal(values.shape)
    )
    dofs = Dofs(np.arange(1, 13), np.full(12, 3))
    return Frfs(f[use], dofs, dofs.take(np.arange(2)), values, "acceleration", "hammer")


@pytest.mark.parametrize("window", [TAU, f"{TAU:.6f}", "1%"])
def test_the_damping_of_the_window_is_taken_out(windowed, window):
    found = identify(windowed, exponential_window=window)
    assert found.modes.frequencies_hz == pytest.approx(HZ, rel=1e-4)
    assert found.modes.damping == pytest.approx(ZETA, rel=0.05)
    assert any("exponential window" in w for w in found.warnings)


def test_without_it_the_window_damps_and_the_functions_are_the_same(windowed):
    plain, found = identify(windowed), identify(windowed, exponential_window=TAU)
    added = 1.0 / (TAU * 2.0 * np.pi * HZ)
    assert plain.modes.damping - found.modes.damping == pytest.approx(added, rel=1e-3)
    assert plain.modes.damping[0] > 4.0 * ZETA[0]
    assert found.synthesised().values == pytest.approx(plain.synthesised().values, rel=1e-6)


@pytest.mark.parametrize("window", [0.0, -1.0, np.inf, "nan", "0%", "100%", "one", "", "5 %%"])
def test_what_is_no_window_is_refused(windowed, window):
    with pytest.raises(InputError, match="time constant in s, above 0"):
        identify(windowed, exponential_window=window)


def test_a_window_that_damps_more_than_was_measured_is_refused(windowed):
    with pytest.raises(InputError, match="not the window of these functions"):
        identify(windowed, exponential_window=0.5 * TAU)


def test_uneven_lines_do_not_tell_an_end_value(windowed):
    f = windowed.frequencies_hz.copy()
    f[5] += 0.1 * (f[1] - f[0])
    assert decay_rate("2.0", f) == 0.5
    with pytest.raises(InputError, match="not evenly spaced"):
        decay_rate("1%", f)
