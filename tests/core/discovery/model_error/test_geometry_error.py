"""What another shape than drawn does to modes, beside closed forms and models that have it."""

from types import SimpleNamespace

import numpy as np
import pytest
import scipy.linalg as la

from trueup.adapters.nastran import read_deck
from trueup.adapters.nastran.discovery.build_structure import build_structure
from trueup.core.discovery.model_error.geometry_error import Movable
from trueup.core.discovery.model_error.geometry_shapes import shapes_of
from trueup.core.discovery.reduction.residual_flexibility import Compliance
from trueup.core.eigen.normal_modes import solve

E, RHO = 70000.0, 2.7e-9
AREA, INERTIA = 60.0, 45.0
LONG = 400.0
ARCH = (
    "SOL 103\nCEND\nSPC = 1\nBEGIN BULK\n"
    + "".join(f"GRID,{k + 1},,{LONG * k / 40},0.,0.\n" for k in range(41))
    + "".join(f"CBAR,{k},1,{k},{k + 1},0.,1.,0.\n" for k in range(1, 41))
    + f"PBAR,1,1,{AREA},{INERTIA},{INERTIA},1.+3\nMAT1,1,{E},,.3,{RHO}\n"
    + "SPC1,1,1234,1,41\nSPC1,1,246,2,THRU,40\nENDDATA\n"
)


DRAWN = np.eye(3)


def plate(turn=DRAWN, ends=True):
    """A strip of shells, held at both ends, or free; in any frame."""
    out = "SOL 103\nCEND\nSPC = 1\nBEGIN BULK\n"
    for i in range(13):
        for j in range(5):
            x, y, z = turn @ (25.0 * i, 25.0 * j, 0.0)
            held = ",,123" if ends and i in (0, 12) else ""
            out += f"GRID,{1 + j + 5 * i},,{x:.8f},{y:.8f},{z:.8f}{held}\n"
    for i in range(12):
        for j in range(4):
            a = 1 + j + 5 * i
            out += f"CQUAD4,{1 + j + 4 * i},1,{a},{a + 5},{a + 6},{a + 1}\n"
    return out + f"PSHELL,1,1,1.5,1,,1\nMAT1,1,{E},,.3,{RHO}\nENDDATA\n"


@pytest.fixture
def movable(tmp_path):
    """Return a structure, its modes, and what moves its nodes, for a deck."""

    def of(text, n=16):
        path = tmp_path / f"{abs(hash(text))}.bdf"
        path.write_text(text)
        s = build_structure(read_deck(path))
        solution = solve(s.model, n_modes=n)
        V = np.asarray(solution.vectors)
        return s, V, Movable(s, V, Compliance(s.model, solution))

    return of


def of_modes(s, V, d, a, n=6):
    """Return frequencies by the modes of the structure as drawn, an amplitude of a."""
    x = a / d.unit
    K, M = (
        V.T @ (A @ V) + x * first + x**2 * second
        for A, (first, second) in ((s.model.K(), d.stiffness), (s.model.M(), d.mass))
    )
    return np.sqrt(np.abs(la.eigh(K, M, eigvals_only=True)[:n])) / (2.0 * np.pi)


def of_moved(s, shape, a, n=6):
    """Return those of the structure, held, that has the shape."""
    K, M = (A.toarray() for A in s.moved(a * shape.by))
    return 1.0 / np.sqrt(la.eigh(M, K, eigvals_only=True)[: -n - 1 : -1]) / (2.0 * np.pi)


def shape_of(s, name, out=2):
    """Return the shape of a name with a displacement along an axis."""
    return next(k for k in shapes_of(s.model.geometry.xyz) if k.name == name and k.by[:, out].any())


def test_a_shallow_arch_is_stiffer_by_the_square_of_its_height(movable):
    """N = 16 EAhq / (πL²) of a parabola between fixed ends, by q of the first sine."""
    s, _, m = movable(ARCH)
    d = m.deviation(shape_of(s, "bowed along x"))
    stiffer = d.stiffness[1, 0, 0] / d.unit**2
    assert stiffer == pytest.approx(512.0 * E / (np.pi**2 * RHO * LONG**4), rel=0.01)


def test_a_longer_beam_swings_slower_by_the_square_of_its_length(movable):
    s, V, m = movable(ARCH)
    d = m.deviation(shape_of(s, "longer along x", 0))
    a = 0.01 * LONG
    here, drawn = of_modes(s, V, d, a, 3), of_modes(s, V, d, 0.0, 3)
    np.testing.assert_allclose(here / drawn, 1.01**-2, rtol=2e-4)


@pytest.mark.parametrize("name", ["bowed along x", "dished", "twisted"])
@pytest.mark.parametrize("height", [0.8, 3.0])
def test_a_flat_plate_becomes_a_shallow_shell(movable, name, height):
    s, V, m = movable(plate(), 24)
    shape = shape_of(s, name)
    exact = of_moved(s, shape, height)
    d = m.deviation(shape)
    np.testing.assert_allclose(of_modes(s, V, d, height), exact, rtol=5e-3)
    nothing = SimpleNamespace(on=lambda V: np.zeros((V.shape[1],) * 2), responses=np.zeros_like)
    locked = of_modes(s, V, Movable(s, V, nothing).deviation(shape), height)
    assert np.abs(locked / exact - 1.0).max() > 0.05


def test_a_free_plate_that_is_bowed_still_moves_as_a_whole(movable):
    s, V, m = movable(plate(ends=False), 24)
    d = m.deviation(shape_of(s, "bowed along x"))
    found = of_modes(s, V, d, 3.0, 8)
    assert found[:6].max() < 0.01 * found[6]


def test_the_frame_of_the_deck_does_not_matter(movable):
    turn = np.linalg.qr(np.random.default_rng(3).standard_normal((3, 3)))[0]
    told = []
    for frame in (DRAWN, turn):
        s, V, m = movable(plate(frame), 24)
        told.append([of_modes(s, V, m.deviation(k), 2.0) for k in shapes_of(s.model.geometry.xyz)])
    np.testing.assert_allclose(told[1], told[0], rtol=3e-4)
