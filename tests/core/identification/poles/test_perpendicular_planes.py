"""Sensors along several axes, references across: each mode lies in a plane that one sees."""

import numpy as np
import pytest

from trueup.core.data.dofs import Dofs
from trueup.core.data.frfs import Frfs
from trueup.core.identification.identify import identify
from trueup.core.identification.survey.modal_synthesis import modal_response, poles_from
from trueup.core.identification.survey.survey_data import prepare

MODES = [48.5, 71.6, 104.44, 104.56, 139.1, 155.5, 184.9]  # odd ones along z, even ones along y


def frame(axes, scatter):
    """28 points along `axes` (1 x, 2 y, 3 z), impacts 1:Z and 14:Y; x moves with y."""
    rng = np.random.default_rng(3)
    plane = np.where(np.arange(len(MODES)) % 2, 2, 3)
    along = np.tile(axes, 28)
    seen = np.where(np.where(along == 1, 2, along)[:, None] == plane, 1.0, 2e-4)
    shapes = rng.standard_normal((len(along), len(MODES))) * seen
    drive = np.where(np.array([[3], [2]]) == plane, [[1.0], [0.1]], 1e-4)
    f = np.arange(0.25, 300.0, 0.25)
    values = []
    for point in np.split(shapes, 28):
        hz = np.array(MODES) * (1.0 + scatter * rng.standard_normal())
        poles = poles_from(hz, np.full(len(hz), 2e-3))
        values.append(modal_response(f, poles, point, drive / (2j * poles.imag), "acceleration"))
    values = np.concatenate(values)
    rms = np.sqrt(np.mean(np.abs(values) ** 2, axis=2, keepdims=True))
    of_value, e = (
        rng.standard_normal(values.shape) + 1j * rng.standard_normal(values.shape) for _ in range(2)
    )
    values = values * (1.0 + 2e-3 * of_value) + 1e-4 * np.median(rms.max(axis=1)) * e
    nodes = np.repeat(np.arange(1, 29), len(axes))
    return Frfs(f, Dofs(nodes, along), Dofs(np.array([1, 14]), np.array([3, 2])), values)


@pytest.mark.parametrize("axes", [(1, 2, 3), (2, 3)])
@pytest.mark.parametrize("scatter", [0.0, 8e-4])
def test_functions_across_the_planes_hide_no_mode(axes, scatter):
    """They are nearly noise, and say nothing of how large the others are to one another."""
    found = identify(frame(axes, scatter), fmin=40.0, fmax=200.0).modes.frequencies_hz
    assert found == pytest.approx(MODES, rel=1e-3)


def test_the_planes_weigh_alike():
    """However much more the structure answers to one reference than to the other."""
    survey = prepare(frame((1, 2, 3), 0.0), ((0.0, np.inf),))
    rms = np.sqrt(np.mean(np.abs(survey.values) ** 2, axis=2))
    y_and_z = np.median(rms[1::3, 1]), np.median(rms[2::3, 0])
    assert max(y_and_z) < 2.0 * min(y_and_z)
