"""What a suspension, the mass of sensors and a mesh do to a structure."""

from types import SimpleNamespace

import numpy as np
import pytest
import scipy.sparse as sp

from trueup.core.discovery.model_error.set_up_fields import (
    SUSPENSION,
    mesh_errors,
    sensor_mass,
    suspension,
)
from trueup.core.discovery.model_error.smooth_fields import Fields
from trueup.core.discovery.reduction.elements_and_supports import Structure


def smooth(r):
    """Two fields of stiffness and one of mass, on a basis of r vectors."""
    none = np.zeros((1, r, r))
    A = np.diag(np.linspace(-1.0, 1.0, r))[None]
    stiffness, mass = np.concatenate([A, A, none]), np.concatenate([none, none, A])
    return Fields(("k", "k", "m"), stiffness, mass, np.ones(3), -np.ones(3))


def test_a_suspension_lifts_every_eigenvalue_by_that_of_its_swinging():
    values = np.array([0.0, 0.0, 100.0, 900.0, 2500.0])
    fields = suspension(np.eye(5), smooth(5), 100.0)
    share = 0.2
    lifted = np.linalg.eigvalsh(np.diag(values) + share**2 * fields.stiffness[0])
    assert np.sqrt(lifted[0]) == pytest.approx(share * np.sqrt(100.0))
    assert lifted - values == pytest.approx(lifted[0])
    assert not fields.mass.any()


def test_a_suspension_holds_but_may_be_softer_somewhere():
    fields = suspension(np.eye(5), smooth(5), 100.0)
    assert fields.names == (SUSPENSION,) * 2
    assert fields.least[0] == pytest.approx(0.0)
    assert fields.least[1] < 0.0


def test_sensors_are_as_heavy_as_is_said_whatever_way_they_move():
    nodes, r = 4, 6
    root = np.sqrt(8.0 / nodes) * np.tile(np.eye(3, r), (nodes, 1))
    (M,) = sensor_mass(root).mass
    assert np.diag(M)[:3] == pytest.approx(8.0)


def test_a_test_by_lumped_bars_is_what_the_deck_has():
    consistent, lumped = np.array([[2.0, 1.0], [1.0, 2.0]]) / 6.0, np.eye(2) / 2.0
    geometry = SimpleNamespace(xyz=np.array([[0.0, 0.0, 0.0], [1.0, 0.0, 0.0]]))
    model = SimpleNamespace(
        parameters=(), geometry=geometry, expansion=sp.identity(2, format="csr")
    )
    bars = (consistent - lumped)[None]
    fields = mesh_errors(Structure(model, (), sp.csr_matrix((0, 0))), np.eye(2), bars)
    assert len(fields.names) == 1
    assert consistent + fields.mass[0] == pytest.approx(lumped)
    assert not fields.stiffness.any()
