"""Bars and rods against closed forms."""

import numpy as np
import pytest

from trueup.core.elements.lines.bar import (
    bar_axes,
    bar_mass,
    bar_stiffness,
    offset_transform,
    rod_mass,
    rod_stiffness,
)

E, G, A, I1, I2, J, L = 2.1e5, 8.0e4, 50.0, 300.0, 120.0, 90.0, 40.0
XA, XB, V = np.zeros((1, 3)), np.array([[L, 0.0, 0.0]]), np.array([[0.0, 1.0, 0.0]])
FREE = np.zeros((1, 6), dtype=bool)


def bar(I12=0.0, k1=0.0, k2=0.0, pins_a=FREE, pins_b=FREE, xa=XA, xb=XB, v=V):
    n = len(xa)
    values = (np.full(n, x) for x in (E, G, A, I1, I2, I12, J, k1, k2))
    return bar_stiffness(xa, xb, v, *values, np.repeat(pins_a, n, 0), np.repeat(pins_b, n, 0))


def pin(*components):
    pins = np.zeros((1, 6), dtype=bool)
    pins[0, np.array(components) - 1] = True
    return pins


def tip(K, force):
    return np.linalg.solve(K[0, 6:, 6:], force)


def test_cantilever():
    load = np.eye(6)
    K = bar()
    assert tip(K, load[0])[0] == pytest.approx(L / (E * A))
    assert tip(K, load[1])[1] == pytest.approx(L**3 / (3 * E * I1))
    assert tip(K, load[2])[2] == pytest.approx(L**3 / (3 * E * I2))
    assert tip(K, load[3])[3] == pytest.approx(L / (G * J))
    assert tip(K, load[1])[5] == pytest.approx(L**2 / (2 * E * I1))
    assert tip(K, load[2])[4] == pytest.approx(-(L**2) / (2 * E * I2))


def test_shear_flexibility():
    K = bar(k1=0.8, k2=0.5)
    load = np.eye(6)
    assert tip(K, load[1])[1] == pytest.approx(L**3 / (3 * E * I1) + L / (0.8 * A * G))
    assert tip(K, load[2])[2] == pytest.approx(L**3 / (3 * E * I2) + L / (0.5 * A * G))


@pytest.mark.parametrize("k", [0.0, 0.7])
def test_product_of_inertia_is_a_turned_section(k):
    """The same bar described in axes turned by an angle about its own."""
    angle = 0.35
    c, s = np.cos(angle), np.sin(angle)
    T = np.array([[c, s], [-s, c]])
    section = T @ np.diag([I1, I2]) @ T.T
    turned = np.array([[0.0, c, s]])
    values = (E, G, A, section[0, 0], section[1, 1], section[0, 1], J, k, k)
    arrays = (np.array([x]) for x in values)
    K = bar_stiffness(XA, XB, turned, *arrays, FREE, FREE)
    straight = bar(k1=k, k2=k)
    assert np.abs(K - straight).max() < 1e-12 * K.max()


def test_released_rotation_makes_a_propped_beam():
    K = bar(pins_b=pin(6))[0]
    assert K[7, 7] == pytest.approx(3 * E * I1 / L**3)
    assert K[5, 5] == pytest.approx(3 * E * I1 / L)
    assert np.abs(K[11]).max() == 0.0
    assert K[8, 8] == pytest.approx(12 * E * I2 / L**3)


def test_released_axial_motion_and_both_torsions_leave_nothing():
    K = bar(pins_a=pin(4), pins_b=pin(1, 4))[0]
    assert np.abs(K[[0, 3, 6, 9]]).max() == 0.0
    truss = bar(pins_a=pin(5, 6), pins_b=pin(5, 6))[0]
    assert np.linalg.matrix_rank(truss, tol=1e-6) == 2


def test_releases_stand_in_the_axes_of_the_bar():
    rng = np.random.default_rng(0)
    R = np.linalg.qr(rng.standard_normal((3, 3)))[0]
    R *= np.linalg.det(R)
    T = np.kron(np.eye(4), R)
    plain = bar(pins_b=pin(2, 6))[0]
    turned = bar(pins_b=pin(2, 6), xb=XB @ R.T, v=V @ R.T)[0]
    assert turned == pytest.approx(T @ plain @ T.T, abs=1e-9 * plain.max())


def test_bars_of_a_batch_do_not_see_each_other():
    rng = np.random.default_rng(2)
    xa, xb, v = rng.standard_normal((3, 5, 3))
    together = bar(0.1, 0.8, 0.6, pin(5), pin(6), xa, xb, v)
    for i in range(5):
        at = slice(i, i + 1)
        alone = bar(0.1, 0.8, 0.6, pin(5), pin(6), xa[at], xb[at], v[at])
        assert together[i] == pytest.approx(alone[0])


def test_offsets_keep_rigid_motions(structure):
    rng = np.random.default_rng(4)
    grids, w, v = rng.standard_normal((3, 2, 3))
    xa, xb = (grids + w)[:, None]
    T = offset_transform(w[:1], w[1:])
    K = T.swapaxes(1, 2) @ bar(xa=xa, xb=xb, v=v[:1]) @ T
    R = structure.rigid_motions(grids, rotations=True)
    assert np.abs(K[0] @ R).max() < 1e-12 * np.abs(K).max()
    assert np.linalg.matrix_rank(K[0], tol=1e-9 * K.max()) == 6


def test_axes():
    axes = bar_axes(XA, XB, np.array([[5.0, 1.0, 1.0]]))[0]
    assert axes[0] == pytest.approx([1, 0, 0])
    assert axes[1] == pytest.approx(np.array([0, 1, 1]) / np.sqrt(2))
    assert np.cross(axes[0], axes[1]) == pytest.approx(axes[2])


@pytest.mark.parametrize("coupled", [False, True])
def test_mass_of_lines(structure, coupled):
    rng = np.random.default_rng(5)
    xa, xb, v = rng.standard_normal((3, 4, 3))
    length = np.linalg.norm(xb - xa, axis=1)
    line = np.full(4, 0.7)
    for M in (
        bar_mass(xa, xb, v, line, coupled),
        rod_mass(np.stack([xa, xb], axis=1), line, coupled),
    ):
        for i in range(4):
            R = structure.rigid_motions(np.array([xa[i], xb[i]]), rotations=True)[:, :3]
            assert R.T @ M[i] @ R == pytest.approx(0.7 * length[i] * np.eye(3), abs=1e-12)


def test_coupled_mass_of_a_cantilever(structure):
    """First frequency of a clamped-free beam, ten elements: closed form to 1e-4."""
    n = 10
    x = np.linspace(0, L, n + 1)
    at = np.column_stack([x, 0 * x, 0 * x])
    v = np.repeat(V, n, 0)
    K = bar(xa=at[:-1], xb=at[1:], v=v)
    M = bar_mass(at[:-1], at[1:], v, np.full(n, 0.4), coupled=True)
    conn = np.stack([np.arange(n), np.arange(1, n + 1)], axis=1)
    bend = [6 * i + d for i in range(1, n + 1) for d in (1, 5)]
    K, M = (structure.assemble(n + 1, conn, m).toarray()[np.ix_(bend, bend)] for m in (K, M))
    omega2 = np.linalg.eigvals(np.linalg.solve(M, K)).real.min()
    assert omega2 == pytest.approx(1.8751040687**4 * E * I1 / (0.4 * L**4), rel=1e-4)


def test_coupled_rod_mass_is_the_mean_of_lumped_and_consistent():
    M = rod_mass(np.stack([XA, XB], axis=1), np.array([3.0]), coupled=True)[0] / (3.0 * L)
    assert M[0, 0] == pytest.approx(5 / 12)
    assert M[0, 6] == pytest.approx(1 / 12)
    assert M[1, 1] == pytest.approx(1 / 2)
    assert M[1, 7] == 0.0


def test_rod_carries_axial_force_and_torsion_only():
    x = np.array([[3.0, 4.0, 0.0]])
    one = np.ones(1)
    K = rod_stiffness(np.stack([XA, x], axis=1), 10 * one, 2 * one, 5 * one, one)[0]
    t = x[0] / 5
    assert K[:3, :3] == pytest.approx(4.0 * np.outer(t, t))
    assert K[3:6, 9:] == pytest.approx(-1.0 * np.outer(t, t))
    assert np.linalg.matrix_rank(K) == 2
