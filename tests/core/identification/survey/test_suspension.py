"""Motions on the suspension are told from modes of the structure."""

import numpy as np
import pytest

from trueup.core.data.dofs import Dofs
from trueup.core.data.frfs import Frfs
from trueup.core.data.geometry import Geometry
from trueup.core.identification.identify import identify
from trueup.core.identification.survey.modal_synthesis import modal_response, poles_from
from trueup.core.identification.survey.suspension import rigid_share

NODES = np.arange(1, 13)
XYZ = np.random.default_rng(4).uniform(-1.0, 1.0, (12, 3))
DOFS = Dofs(np.repeat(NODES, 3), np.tile([1, 2, 3], 12))
GEOMETRY = Geometry(NODES, XYZ, "m")


def rigid_motions(centre=(0.0, 0.0, 0.0)):
    arm = np.repeat(XYZ - centre, 3, axis=0)
    return np.hstack([DOFS.axis, np.cross(arm, DOFS.axis)])


def test_any_motion_of_a_rigid_body_is_one_and_bending_is_none():
    rng = np.random.default_rng(0)
    moves = rigid_motions(centre=(3.0, -2.0, 5.0)) @ rng.standard_normal((6, 4))
    assert rigid_share(moves, DOFS, GEOMETRY) == pytest.approx(np.ones(4))
    q, _ = np.linalg.qr(rigid_motions())
    bends = rng.standard_normal((36, 3))
    bends -= q @ (q.T @ bends)
    assert rigid_share(bends, DOFS, GEOMETRY) == pytest.approx(np.zeros(3), abs=1e-12)
    half = bends[:, 0] / np.linalg.norm(bends[:, 0]) + q[:, 0]
    assert rigid_share(half[:, None], DOFS, GEOMETRY) == pytest.approx([0.5])


def test_too_few_sensors_and_no_geometry_say_nothing():
    assert np.isnan(rigid_share(np.ones((36, 2)), DOFS, None)).all()
    few = DOFS.take(np.arange(9))
    assert np.isnan(rigid_share(np.ones((9, 2)), few, GEOMETRY)).all()


def test_a_survey_on_bungees():
    """Six motions on the suspension between 2 and 5 Hz, three modes of the structure above."""
    rng = np.random.default_rng(1)
    q, _ = np.linalg.qr(rigid_motions())
    bends = rng.standard_normal((36, 3))
    bends -= q @ (q.T @ bends)
    shapes = np.hstack([q, bends / np.linalg.norm(bends, axis=0)])
    hz = np.array([2.0, 2.5, 3.1, 3.6, 4.2, 5.0, 20.0, 31.0, 45.0])
    poles = poles_from(hz, np.full(9, 0.02))
    f = np.arange(1.0, 55.0, 0.02)
    values = modal_response(f, poles, shapes + 0j, shapes[:3] / (2j * poles.imag))
    e = rng.standard_normal(values.shape) + 1j * rng.standard_normal(values.shape)
    values += 0.005 * np.sqrt(np.mean(np.abs(values) ** 2)) * e
    found = identify(Frfs(f, DOFS, DOFS.take(np.arange(3)), values), geometry=GEOMETRY)
    assert found.modes.frequencies_hz == pytest.approx(hz, rel=2e-3)
    assert list(found.suspension) == [True] * 6 + [False] * 3
    without = identify(Frfs(f, DOFS, DOFS.take(np.arange(3)), values))
    assert np.isnan(without.rigid_share).all()
    assert not without.suspension.any()
