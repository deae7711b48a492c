"""Rigid-body modes are recognised by rank, mechanisms are held or named."""

import re

import numpy as np
import pytest
import scipy.sparse as sp
from tests.core.chains import chain, chain_exact, scalar_model

from trueup.core.data.dofs import Dofs
from trueup.core.data.geometry import Geometry
from trueup.core.data.parametric_model import Model, Term
from trueup.core.eigen.normal_modes import solve
from trueup.core.errors import InputError

# rigid-body modes by rank


def test_soft_suspension_is_not_rigid(ring):
    springs = [(i, c, 0.05) for i in (0, 30, 60, 90) for c in (1, 2, 3)]
    found = solve(ring(120, springs=springs), 10)
    assert found.rigid_body_modes == 0
    assert 0.01 < found.frequencies_hz[0] < 0.5
    assert found.frequencies_hz[5] < 1.0 < found.frequencies_hz[6]


@pytest.mark.parametrize(
    ("held", "rigid"), [((1, 2, 3), 3), ((1, 2, 3, 4, 5), 1), ((3,), 5), ((1, 2, 3, 4, 5, 6), 0)]
)
def test_partly_supported(ring, held, rigid):
    model = ring(24, fixed=[(0, c) for c in held])
    assert solve(model, 8).rigid_body_modes == rigid


def test_rigid_body_modes_of_far_away_and_of_tiny_structures(frame, section):
    xyz = np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0.2]], float)
    bars = [(0, 1), (1, 2), (2, 3), (3, 0), (0, 2)]
    for scale, shift in ((1.0, 1e3), (1e-3, 0.0), (1e3, 0.0)):
        found = solve(frame(scale * xyz + shift, bars), 10)
        assert found.rigid_body_modes == 6


def test_two_free_bodies_are_allowed_and_told(frame):
    square = np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]], float)
    xyz = np.vstack([square, square + 5.0])
    bars = [(0, 1), (1, 2), (2, 3), (3, 0), (4, 5), (5, 6), (6, 7), (7, 4)]
    found = solve(frame(xyz, bars), 14)
    assert found.rigid_body_modes == 12
    assert "2 separate free pieces with 12 rigid-body modes" in found.warnings[0]
    np.testing.assert_allclose(found.eigenvalues[12], found.eigenvalues[13], rtol=1e-9)


def test_truss_of_translations_only():
    """A planar square with one diagonal: three motions of its plane, nothing else is free."""
    xyz = np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]], float)
    K = np.zeros((8, 8))
    for i, j in ((0, 1), (1, 2), (2, 3), (3, 0), (0, 2)):
        d = (xyz[j] - xyz[i])[:2]
        g = np.concatenate([-d, d]) / np.linalg.norm(d) ** 1.5
        rows = [2 * i, 2 * i + 1, 2 * j, 2 * j + 1]
        K[np.ix_(rows, rows)] += np.outer(g, g)
    dofs = Dofs(np.repeat(np.arange(1, 5), 6), np.tile(np.arange(1, 7), 4))
    T = sp.csr_matrix((np.ones(8), ([0, 1, 6, 7, 12, 13, 18, 19], range(8))), (24, 8))
    model = Model(
        Geometry(np.arange(1, 5), xyz), dofs, T,
        (Term(sp.csr_matrix(K)),), (Term(sp.identity(8, format="csr")),),
    )  # fmt: skip
    found = solve(model, 8)
    assert found.rigid_body_modes == 3
    assert found.eigenvalues[3] > 0.1


def test_scalar_points(backend):
    K, M = chain(700)
    found = solve(scalar_model(K, M), 5, backend=backend)
    assert found.rigid_body_modes == 1
    np.testing.assert_allclose(found.eigenvalues[1:], chain_exact(700)[1:5], rtol=1e-9)
    assert solve(scalar_model(*chain(20, ground=1e-9)), 3).rigid_body_modes == 0


@pytest.mark.parametrize("bars", [24, 120])
def test_scalar_point_hung_on_a_free_structure_follows_it(ring, bars):
    """An absorber as a deck has it: a spring from a grid to a scalar point with a mass."""
    model = ring(bars)
    n = model.n_free
    spring = sp.csr_matrix((400.0 * np.array([1, -1, -1, 1]), ([8, 8, n, n], [8, n, 8, n])))
    K = sp.block_diag([model.K(), [[0.0]]]) + spring
    M = sp.block_diag([model.M(), [[0.01]]])
    hung = Model(
        model.geometry,
        Dofs(np.append(model.dofs.node, 9999), np.append(model.dofs.component, 1)),
        sp.identity(n + 1, format="csr"),
        (Term(K.tocsr()),), (Term(M.tocsr()),), (), (*model.free_labels, "9999"),
    )  # fmt: skip
    found = solve(hung, 10)
    assert found.rigid_body_modes == 6
    assert found.warnings == ()
    assert 20.0 < found.frequencies_hz[6] < 40.0


@pytest.mark.parametrize("digits", [10, None])
def test_matrices_of_limited_precision_keep_their_rigid_body_modes(ring, digits):
    """As read from a punch file with ten digits, or from single precision."""
    model = ring(40)
    K = model.K()
    if digits:
        K.data = np.array([float(f"{v:.{digits - 1}e}") for v in K.data])
    else:
        K.data = K.data.astype(np.float32).astype(float)
    rounded = Model(
        model.geometry, model.dofs, model.expansion, (Term(K),), model.mass,
    )  # fmt: skip
    assert solve(rounded, 10).rigid_body_modes == 6


def test_springs_between_grids_that_are_not_in_one_place(frame):
    """Two frames, one above the other, joined by springs: nearly rigid rotations, with a word."""
    square = np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]], float)
    xyz = np.vstack([square, square + np.array([0, 0, 0.02])])
    bars = [(0, 1), (1, 2), (2, 3), (3, 0), (4, 5), (5, 6), (6, 7), (7, 4)]
    model = frame(xyz, bars)
    joint = np.zeros((48, 48))
    for i in range(4):
        for c in range(6):
            rows = [6 * i + c, 6 * (i + 4) + c]
            joint[np.ix_(rows, rows)] += 1e9 * np.array([[1, -1], [-1, 1]])
    joined = Model(
        model.geometry, model.dofs, model.expansion,
        (Term((model.K() + sp.csr_matrix(joint)).tocsr()),), model.mass, (), model.free_labels,
    )  # fmt: skip
    found = solve(joined, 12)
    assert found.rigid_body_modes == 6
    assert found.eigenvalues[6] > 1e4 * abs(found.eigenvalues[5])
    assert "2 of the rigid-body modes are not quite" in found.warnings[0]


# mechanisms


@pytest.mark.parametrize("bars", [8, 150])
def test_hinge_between_two_parts_is_a_mechanism(line, bars, backend):
    """A beam cut in the middle by a ball joint: besides six there are three free motions."""
    middle = bars // 2
    pins = [(middle, c) for c in (4, 5, 6)]
    with pytest.raises(InputError, match=r"mechanism: .*besides the rigid-body modes") as caught:
        solve(line(bars, pins=pins), 12, backend=backend)
    assert "\n" not in str(caught.value)
    assert "3 motions" in str(caught.value)


def test_a_hinge_is_named_by_the_smaller_part_that_turns(line):
    """Free structure: what moves is told relative to the larger part, at rest."""
    with pytest.raises(InputError) as caught:
        solve(line(10, pins=[(8, 6)]), 12)
    named = str(caught.value).split(" at ")[1].split(";")[0]
    grids = {int(label.split(":")[0]) for label in named.replace(" and", ",").split(", ")}
    assert grids == {10, 11, 12}


@pytest.mark.parametrize("bars", [8, 130])
def test_free_turning_bar_is_held_and_named(line, frame, bars, backend):
    """Lumped mass has no rotary inertia: the bar that turns has neither stiffness nor mass."""
    xyz = np.outer(np.linspace(0.0, 1.0, bars + 1), [1.0, 0.0, 0.0])
    members = [(i, i + 1) for i in range(bars)]
    fixed = [(0, c) for c in (1, 2, 3, 5, 6)] + [(bars, c) for c in (2, 3)]
    found = solve(frame(xyz, members, lumped=True, fixed=fixed), 4, backend=backend)
    assert any(
        re.search(r"neither stiffness nor mass, at .*:4.* held at \d+:4", w) for w in found.warnings
    )
    still = solve(frame(xyz, members, lumped=True, fixed=[*fixed, (0, 4)]), 4, backend=backend)
    np.testing.assert_allclose(found.frequencies_hz, still.frequencies_hz, rtol=1e-7)


@pytest.mark.parametrize("bars", [8, 130])
def test_free_straight_bar_has_five_rigid_body_modes(frame, bars, backend):
    """It turns about its axis without any mass; the bending modes come in pairs."""
    xyz = np.outer(np.linspace(0.0, 1.0, bars + 1), [0.6, 0.0, 0.8])
    members = [(i, i + 1) for i in range(bars)]
    found = solve(frame(xyz, members, lumped=True), 9, backend=backend)
    assert found.rigid_body_modes == 5
    assert any("neither stiffness nor mass" in w for w in found.warnings)
    assert (found.frequencies_hz[5:] > 1.0).all()


def test_hinged_flap_on_a_fixed_structure_names_the_flap(frame):
    xyz = np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [2, 0, 0], [2, 1, 0]], float)
    bars = [(0, 1), (0, 2), (1, 2), (1, 3), (2, 4), (3, 4)]
    pins = [(3, 4), (3, 5), (3, 6), (4, 4), (4, 5), (4, 6)]
    fixed = [(0, c) for c in range(1, 7)]
    with pytest.raises(InputError, match="mechanism") as caught:
        solve(frame(xyz, bars, pins=pins, fixed=fixed), 4)
    named = str(caught.value).split(" at ")[1].split(";")[0]
    assert "4:3" in named
    assert "5:3" in named
    assert not any(label in named for label in ("1:3", "2:3", "3:3"))


def test_tripod_of_soft_and_stiff_parts_is_no_mechanism(frame):
    """Eight decades between the stiffest and the softest bar."""
    xyz = np.array([[0, 0, 1], [1, 0, 0], [-1, 1, 0], [-1, -1, 0], [0, 0, 2]], float)
    springs = [(i, c, k) for i, k in ((1, 1e12), (2, 1e4), (3, 1e4)) for c in (1, 2, 3)]
    found = solve(frame(xyz, [(0, 1), (0, 2), (0, 3), (0, 4)], springs=springs), 6)
    assert found.rigid_body_modes == 0
