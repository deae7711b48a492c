"""Functions whose poles move from output to output are brought to one set of poles."""

import numpy as np
import pytest

from trueup.core.data.dofs import Dofs
from trueup.core.data.frfs import Frfs
from trueup.core.identification.identify import identify
from trueup.core.identification.poles.aligned_functions import aligned, distinct
from trueup.core.identification.survey.modal_synthesis import modal_response, poles_from

_F = np.arange(40.0, 140.0, 0.125)
_HZ = np.array([60.0, 88.0, 88.7, 115.0])
_ZETA = np.array([0.003, 0.004, 0.003, 0.002])


def _moved(rng, points, by):
    """Functions of which every point has frequencies of its own; shapes, participation."""
    shapes = rng.standard_normal((points, len(_HZ)))
    own = _HZ * (1.0 - by * np.abs(shapes) * rng.uniform(0.0, 1.0, shapes.shape))
    part = shapes[:3] / (2j * poles_from(_HZ, _ZETA).imag)
    values = [
        modal_response(_F, poles_from(own[o], _ZETA), shapes[[o]], part)[0] for o in range(points)
    ]
    return np.array(values), shapes.astype(complex), part


def test_what_is_left_follows_one_set_of_poles():
    rng = np.random.default_rng(3)
    values, shapes, part = _moved(rng, 24, 0.002)
    start = poles_from(_HZ * 0.999, _ZETA * 1.3)
    brought = aligned(_F, values, np.ones((24, 3), bool), start, part, shapes)
    lines = slice(None, None, 8)
    first = np.linalg.svd(values.reshape(24, -1)[:, lines], compute_uv=False)
    then = np.linalg.svd(brought.reshape(24, -1)[:, lines], compute_uv=False)
    # four modes and their smooth conjugates span what one set of poles makes
    assert first[8] > 1e-2 * first[0]
    assert then[8] < 1e-3 * then[0]


def test_functions_not_measured_stay_nil():
    rng = np.random.default_rng(4)
    values, shapes, part = _moved(rng, 12, 0.002)
    measured = np.ones((12, 3), bool)
    measured[2, 1] = False
    values[2, 1] = 0.0
    brought = aligned(_F, values, measured, poles_from(_HZ, _ZETA), part, shapes)
    assert not brought[2, 1].any()
    assert np.isfinite(brought).all()


def test_a_root_that_repeats_a_participation_close_by_is_none_of_its_own():
    part = np.array([[1.0, 1.0, 0.2, 1.0], [0.5, 0.51, 1.0, 0.5]], complex)
    poles = poles_from(np.array([50.0, 50.1, 50.1, 80.0]), np.full(4, 0.003))
    assert distinct(poles, part, np.array([1.0, 3.0, 1.0, 1.0])).tolist() == [
        False, True, True, True,
    ]  # fmt: skip


@pytest.mark.parametrize("seed", range(3))
def test_modes_are_found_whose_frequencies_fall_with_force(seed):
    rng = np.random.default_rng(seed)
    values, _, _ = _moved(rng, 30, 0.004)
    values = values + 0.003 * np.abs(values).mean() * (
        rng.standard_normal((*values.shape, 2)) @ [1.0, 1.0j]
    )
    dofs = Dofs(np.arange(1, 31), np.full(30, 3))
    found = identify(Frfs(_F, dofs, dofs.take(np.arange(3)), values, "acceleration"))
    assert found.modes.frequencies_hz == pytest.approx(_HZ, rel=0.005)
    assert any("differ from response to response" in w for w in found.warnings)
