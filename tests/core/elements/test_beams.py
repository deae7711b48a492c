"""Tapered beams and bushings against closed forms."""

import numpy as np
import pytest

from trueup.core.elements.connectors.lumped import bush_stiffness
from trueup.core.elements.lines.bar import bar_mass, bar_stiffness
from trueup.core.elements.lines.beam import BeamSections, beam_mass, beam_stiffness

E, G, L = 2.0e5, 8.0e4, 30.0
XA, XB, V = np.zeros((1, 3)), np.array([[L, 0.0, 0.0]]), np.array([[0.0, 1.0, 0.0]])
FREE, CENTRED, ONE = np.zeros((1, 6), dtype=bool), np.zeros((1, 2)), np.ones(1)


def sections(station=(0.0, 1.0), A=(60.0, 60.0), I1=(400.0, 400.0), I2=(90.0, 90.0), I12=None):
    zero = [0.0] * len(station)
    J = [120.0] * len(station)
    rows = (np.array([row]) for row in (station, A, I1, I2, I12 or zero, J))
    return BeamSections(*rows)


def beam(section, k1=0.0, k2=0.0, na=CENTRED, nb=CENTRED, pins_b=FREE, v=V, xb=XB):
    return beam_stiffness(
        XA, xb, v, E * ONE, G * ONE, section, k1 * ONE, k2 * ONE, na, nb, FREE, pins_b
    )[0]


def tip(K, direction):
    return np.linalg.solve(K[6:, 6:], np.eye(6)[direction])[direction]


@pytest.mark.parametrize(("k1", "k2", "I12"), [(0.0, 0.0, 0.0), (0.8, 0.6, 0.0), (0.0, 0.0, 50.0)])
def test_prismatic_beam_is_a_bar(k1, k2, I12):
    values = (E, G, 60.0, 400.0, 90.0, I12, 120.0, k1, k2)
    bar = bar_stiffness(XA, XB, V, *(v * ONE for v in values), FREE, FREE)[0]
    K = beam(sections(I12=[I12, I12]), k1, k2)
    assert np.abs(K - bar).max() < 1e-10 * bar.max()


def three_points(f):
    """Mean of f over 0..1 by three Gauss points, as MSC integrates a tapered beam."""
    s = 0.5 * np.sqrt(0.6)
    return (5.0 * f(0.5 - s) + 8.0 * f(0.5) + 5.0 * f(0.5 + s)) / 18.0


def test_tapered_cantilever():
    """I falls linearly to a fifth: tip deflection by M**2 / E I, which is exact to 0.2 %."""
    found = tip(beam(sections(I1=(500.0, 100.0))), 1)
    assert found == pytest.approx(
        three_points(lambda x: L**3 * (1 - x) ** 2 / (E * (500.0 - 400.0 * x)))
    )
    x = (np.arange(200000) + 0.5) / 200000
    exact = (L**3 * (1 - x) ** 2 / (E * (500.0 - 400.0 * x))).mean()
    assert found == pytest.approx(exact, rel=2e-3)


def test_tapered_area_and_shear():
    K = beam(sections(A=(80.0, 20.0)), k1=0.5)
    flexibility = three_points(lambda x: L / (80.0 - 60.0 * x))
    assert tip(K, 0) == pytest.approx(flexibility / E)
    bending = L**3 / (3 * E * 400.0)
    assert tip(K, 1) == pytest.approx(bending + flexibility / (0.5 * G))


def test_stepped_beam_and_repeated_stations():
    step = sections((0.0, 0.5, 0.5, 1.0), *[[60.0] * 4], (400.0, 400.0, 100.0, 100.0), [90.0] * 4)
    bending = (L**3 / 3) * ((1 - 1 / 8) / (E * 400.0) + (1 / 8) / (E * 100.0))
    assert tip(beam(step), 1) == pytest.approx(bending)
    padded = sections((0.0, 1.0, 1.0, 1.0), [60.0] * 4, [400.0] * 4, [90.0] * 4)
    assert beam(padded) == pytest.approx(beam(sections()), rel=1e-12, abs=1e-6)


def test_neutral_axis_offset_is_a_rigid_arm_of_the_axial_force():
    na = np.array([[2.0, -3.0]])
    K = beam(sections(), na=na, nb=na)
    assert K[0, 0] == pytest.approx(E * 60.0 / L)
    assert K[0, 4] == pytest.approx(E * 60.0 / L * -3.0)
    assert K[0, 5] == pytest.approx(-E * 60.0 / L * 2.0)
    assert K[4, 4] == pytest.approx(4 * E * 90.0 / L + E * 60.0 / L * 9.0)


def test_rigid_motions(structure):
    rng = np.random.default_rng(0)
    xb, v = rng.standard_normal((2, 1, 3)) * 20
    na, nb = rng.standard_normal((2, 1, 2))
    K = beam(sections(I1=(500.0, 200.0)), 0.8, 0.7, na, nb, v=v, xb=xb)
    R = structure.rigid_motions(np.concatenate([XA, xb]), rotations=True)
    values = np.linalg.eigvalsh(K)
    # different offsets at the ends tilt the neutral axis, which axial motion alone cannot follow
    same = beam(sections(I1=(500.0, 200.0)), 0.8, 0.7, na, na, v=v, xb=xb)
    assert np.abs(same @ R).max() < 1e-11 * same.max()
    assert values[5] < 1e-10 * values[-1] < values[6]


def test_pin():
    pins = FREE.copy()
    pins[0, 5] = True
    assert beam(sections(), pins_b=pins)[7, 7] == pytest.approx(3 * E * 400.0 / L**3)


@pytest.mark.parametrize("coupled", [False, True])
def test_mass_of_a_tapered_beam(structure, coupled):
    section = sections(A=(80.0, 20.0))
    nsm = np.array([[1.0, 3.0]])
    M = beam_mass(XA, XB, V, 0.01 * ONE, section, coupled, CENTRED, CENTRED, nsm)[0]
    R = structure.rigid_motions(np.concatenate([XA, XB]), rotations=True)
    total = 0.01 * 50.0 * L + 2.0 * L
    assert R[:, :3].T @ M @ R[:, :3] == pytest.approx(total * np.eye(3), abs=1e-9)
    first_moment = L**2 * (0.01 * (80 / 6 + 20 / 3) + (1 / 6 + 1.0))
    assert R[:, 1] @ M @ R[:, 5] == pytest.approx(first_moment)
    spin = 0.01 * L * (400.0 + 90.0)
    assert R[:, 3] @ M @ R[:, 3] == pytest.approx(spin)
    bar = bar_mass(XA, XB, V, 0.6 * ONE, coupled, 0.01 * (400.0 + 90.0) * ONE)
    prismatic = beam_mass(XA, XB, V, 0.01 * ONE, sections(), coupled, CENTRED, CENTRED)
    assert np.abs(prismatic - bar).max() < 1e-9 * bar.max()


def test_mass_beside_the_axis(structure):
    at = np.array([[2.0, -1.0]])
    nsm = np.array([[1.0, 1.0]])
    M = beam_mass(XA, XB, V, 0 * ONE, sections(), False, CENTRED, CENTRED, nsm, at, at)[0]
    R = structure.rigid_motions(np.concatenate([XA, XB]), rotations=True)
    assert R[:, 3] @ M @ R[:, 3] == pytest.approx(L * 5.0)
    assert R[:, 1] @ M @ R[:, 3] == pytest.approx(L * 1.0)


def test_lumped_beam_is_nx(nx):
    rows = ((0.0, 1.0), (0.25, 0.25), *[(0.0052083, 0.005208)] * 2, (0.0, 0.0), (0.0087949,) * 2)
    section = BeamSections(*(np.array([row]) for row in rows))
    xa, xb = nx.xyz[12][:, None]
    k = 0.8501160144805908 * ONE
    modulus = (2.9e7 * ONE, 1.1e7 * ONE)
    K = beam_stiffness(xa, xb, V, *modulus, section, k, k, CENTRED, CENTRED, FREE, FREE)[0]
    assert np.abs(K - nx.K[12]).max() < 1e-8 * nx.K[12].max()
    M = beam_mass(xa, xb, V, 0.283 * ONE, section, False, CENTRED, CENTRED, rotary=True)[0]
    assert np.abs(M - nx.M[12]).max() < 1e-8 * nx.M[12].max()


def test_beam_makes_msc_grid_point_forces(msc):
    rows = ((0.0, 1.0), (0.25, 0.25), *[(0.0052083, 0.005208)] * 2, (0.0, 0.0), (0.0087949,) * 2)
    section = BeamSections(*(np.array([row]) for row in rows))
    xa, xb = msc[12].xyz[:, None]
    k = 0.850116 * ONE
    modulus = (2.9e7 * ONE, 1.1e7 * ONE)
    K = beam_stiffness(xa, xb, V, *modulus, section, k, k, CENTRED, CENTRED, FREE, FREE)[0]
    f, u = msc[12].f.reshape(12, -1), msc[12].u.reshape(12, -1)
    assert np.linalg.norm(K @ u + f) < 2e-6 * np.linalg.norm(f)


def test_bush():
    axes = np.array([[[0.0, 1.0, 0.0], [0.0, 0.0, 1.0], [1.0, 0.0, 0.0]]])
    k = np.array([[1.0, 2.0, 3.0, 4.0, 5.0, 6.0]])
    zero = np.zeros((1, 3))
    K = bush_stiffness(axes, k, zero, zero)[0]
    assert np.diag(K)[:6] == pytest.approx([3, 1, 2, 6, 4, 5])
    assert K[:6, 6:] == pytest.approx(-K[:6, :6])


def test_bush_away_from_its_grids(structure):
    rng = np.random.default_rng(1)
    a, b, place = rng.standard_normal((3, 1, 3))
    axes = np.linalg.qr(rng.standard_normal((3, 3)))[0][None]
    K = bush_stiffness(axes, np.full((1, 6), 2.0), place - a, place - b)[0]
    R = structure.rigid_motions(np.concatenate([a, b]), rotations=True)
    assert np.abs(K @ R).max() < 1e-12
    assert np.linalg.matrix_rank(K) == 6
