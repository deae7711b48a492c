"""The mesh error: lumped minus consistent mass, a parameter for shells, known for bars."""

from types import SimpleNamespace

import numpy as np
import pytest
import scipy.linalg as la
import scipy.sparse as sp

from trueup.core.discovery.reduction.discretisation_error import (
    consistent_bars,
    lowered,
    lumping,
    lumping_along,
)
from trueup.core.discovery.reduction.elements_and_supports import Structure
from trueup.core.elements.lines.bar import BAR, bar_mass, bar_stiffness
from trueup.core.elements.surfaces.curved_shell import QUAD8
from trueup.core.elements.surfaces.quad4 import QUAD4
from trueup.core.reduction.reduced_sum import reduced_sum


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
        element=QUAD4,
        ids=np.arange(n),
        corners=corners,
        block=SimpleNamespace(width=6),
        stiffness=lambda rows, p: np.zeros((len(rows), 24, 24)),
        mass=lambda rows, p: M[rows],
        coordinates=lambda rows: (6 * corners[rows][:, :, None] + np.arange(6)).reshape(n, 24),
    )
    points = 2 * (n + 1)
    across = sp.csr_matrix(
        (np.ones(points), (6 * np.arange(points) + 2, np.arange(points))), (6 * points, points)
    )
    x, y = np.tile(np.arange(n + 1.0), 2), np.repeat([0.0, 1.0], n + 1)
    geometry = SimpleNamespace(xyz=np.column_stack([x, y, 0.0 * x]))
    model = SimpleNamespace(deck_point=np.ones(0), expansion=across, geometry=geometry)
    return Structure(model, (member,), sp.csr_matrix((0, 0)))


def on(terms, *vectors):
    """What the terms add up to on vectors."""
    return reduced_sum(terms, np.column_stack(vectors)).at(np.ones(0))


def test_rigid_motion_has_no_mesh_error():
    assert on((lumping(membrane(6)),), np.ones(14)) == pytest.approx(0.0, abs=1e-12)


def test_it_falls_with_the_square_of_the_elements_in_a_wave():
    def share(n):
        wave = np.tile(np.cos(np.pi * np.arange(n + 1) / n), 2)
        return float(on((lumping(membrane(n)),), wave)[0, 0]) / (n * 0.5)

    assert share(10) / share(20) == pytest.approx(4.0, rel=0.05)
    assert share(20) == pytest.approx((np.pi / 20) ** 2 / 6.0, rel=0.05)


def test_by_how_much_frequencies_are_too_low_is_known_of_each_mode():
    """By half of the share of its mass by which lumping makes a wave's too large."""
    wave = np.tile(np.cos(np.pi * np.arange(21) / 20), 2)[:, None]
    mass = 20 * 0.5
    off = lowered(membrane(20), np.hstack([wave, np.ones_like(wave)]) / np.sqrt(mass))
    assert off == pytest.approx([0.5 * (np.pi / 20) ** 2 / 6.0, 0.0], rel=0.1, abs=1e-12)


def test_along_a_wave_it_is_all_there_is_and_across_it_none():
    wave = np.tile(np.cos(np.pi * np.arange(7) / 6), 2)
    whole = on((lumping(membrane(6)),), wave)
    along = {
        tuple(np.abs(axis)): float(wave @ (A @ wave)) for axis, A in lumping_along(membrane(6))
    }
    assert sum(along.values()) == pytest.approx(whole.item())
    assert along[0.0, 0.0, 1.0] == pytest.approx(0.0)
    assert along[1.0, 0.0, 0.0] > 2.0 * along[0.0, 1.0, 0.0]


def test_a_mass_that_is_not_lumped_has_none():
    wave = np.tile(np.cos(np.pi * np.arange(7) / 6), 2)
    assert on((lumping(membrane(6, lumped=False)),), wave) == pytest.approx(0.0)


def cantilever(n, pins=False):
    """A clamped beam of unit length, stiffness and mass in n lumped bars, askew in space."""
    axis = np.array([2.0, -1.0, 2.0]) / 3.0
    xyz = np.linspace(0.0, 1.0, n + 1)[:, None] * axis
    corners = np.stack([np.arange(n), np.arange(1, n + 1)], 1)
    one = np.ones(n)
    across = np.tile([0.0, 0.0, 1.0], (n, 1))
    released = np.zeros((n, 6), bool)
    released[:, 4:] = pins
    ends = xyz[corners[:, 0]], xyz[corners[:, 1]], across
    none = np.zeros((n, 6), bool)
    area = 1e6
    K = bar_stiffness(*ends, one, one, area * one, one, one, 0.0 * one, one, 0 * one, 0 * one,
                      released, none)  # fmt: skip
    M = bar_mass(*ends, one, False)
    at = (6 * corners[:, :, None] + np.arange(6)).reshape(n, 12)
    member = SimpleNamespace(
        element=BAR,
        ids=np.arange(n),
        corners=corners,
        block=SimpleNamespace(width=6),
        stiffness=lambda rows, p: K[rows],
        mass=lambda rows, p: M[rows],
        coordinates=lambda rows: at[rows],
    )
    free = sp.eye(6 * (n + 1), format="csr")[:, 6:]
    model = SimpleNamespace(
        deck_point=np.ones(0), expansion=free, geometry=SimpleNamespace(xyz=xyz)
    )
    structure = Structure(model, (member,), sp.csr_matrix((0, 0)))
    whole = [np.zeros((6 * (n + 1),) * 2) for _ in range(2)]
    for A, parts in zip(whole, (K, M), strict=True):
        for rows, part in zip(at, parts, strict=True):
            A[np.ix_(rows, rows)] += part
    stiffness, mass = (A[6:, 6:] for A in whole)
    return structure, mass, stiffness


def frequencies(K, M):
    """Frequencies of bending (each twice), as roots βL of the beam."""
    mu = la.eigh(M, K, eigvals_only=True)[::-1]
    return mu[:6:2] ** -0.25


CLAMPED_FREE = np.array([1.875104, 4.694091, 7.854757])


def test_lumping_makes_a_cantilever_too_slow():
    _, M, K = cantilever(4)
    first = frequencies(K, M)[0] ** 2 / CLAMPED_FREE[0] ** 2
    assert first == pytest.approx(1.0 - 0.028, abs=0.001)


def test_bars_with_their_consistent_mass_follow_the_beam():
    structure, lumped, K = cantilever(4)
    M = lumped + on(consistent_bars(structure), np.eye(24))
    assert frequencies(K, M) ** 2 == pytest.approx(CLAMPED_FREE**2, rel=0.01)
    assert frequencies(K, M)[0] ** 2 == pytest.approx(CLAMPED_FREE[0] ** 2, rel=1e-4)


def test_the_whole_mass_stays():
    structure, _, _ = cantilever(5)
    structure.model.expansion = sp.eye(36, format="csr")
    rigid = np.tile(np.r_[0.6, 0.0, 0.8, 0.0, 0.0, 0.0], 6)
    assert on(consistent_bars(structure), rigid) == pytest.approx(0.0, abs=1e-12)


def test_a_pinned_bar_stays_lumped():
    assert consistent_bars(cantilever(4, pins=True)[0]) == ()


def test_an_element_that_declares_no_linear_mass_has_none():
    """Second-order shells: their mesh error follows another law."""
    structure = membrane(6)
    structure.members[0].element = QUAD8
    assert on((lumping(structure),), np.ones(14)) == pytest.approx(0.0)
