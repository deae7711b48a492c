"""The mesh error as a parameter: lumped minus consistent mass of shells."""

from types import SimpleNamespace

import numpy as np
import pytest
import scipy.sparse as sp

from trueup.core.discovery.mesh_error import lumping


def membrane(n, lumped=True):
    """A strip of n square shells of unit mass each; the basis is its motion across, (z)."""
    corners = np.stack([np.arange(n), np.arange(1, n + 1)], 1)
    corners = np.column_stack([corners, corners[:, ::-1] + n + 1])
    M = np.zeros((n, 24, 24))
    for c in (0, 1, 2):
        for a in range(4):
            M[:, 6 * a + c, 6 * a + c] = 0.25
    if not lumped:
        M[:, 0, 6] = M[:, 6, 0] = 0.1
    member = SimpleNamespace(
        shape="quad",
        ids=np.arange(n),
        corners=corners,
        block=SimpleNamespace(width=6),
        matrices=lambda rows, p: (None, M[rows]),
        coordinates=lambda rows: (6 * corners[rows][:, :, None] + np.arange(6)).reshape(n, 24),
    )
    points = 2 * (n + 1)
    across = sp.csr_matrix(
        (np.ones(points), (6 * np.arange(points) + 2, np.arange(points))), (6 * points, points)
    )
    return SimpleNamespace(
        members=(member,), displacement=across, model=SimpleNamespace(parameters=())
    )


def test_rigid_motion_has_no_mesh_error():
    assert lumping(membrane(6), np.ones((14, 1))) == pytest.approx(0.0, abs=1e-12)


def test_it_falls_with_the_square_of_the_elements_in_a_wave():
    def share(n):
        wave = np.tile(np.cos(np.pi * np.arange(n + 1) / n), 2)[:, None]
        return float(lumping(membrane(n), wave)[0, 0]) / (n * 0.5)

    assert share(10) / share(20) == pytest.approx(4.0, rel=0.05)
    assert share(20) == pytest.approx((np.pi / 20) ** 2 / 6.0, rel=0.05)


def test_a_mass_that_is_not_lumped_has_none():
    wave = np.tile(np.cos(np.pi * np.arange(7) / 6), 2)[:, None]
    assert lumping(membrane(6, lumped=False), wave) == pytest.approx(0.0)
