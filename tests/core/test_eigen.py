"""Normal modes: closed forms, rigid-body modes by rank, mechanisms, checks that bite."""

import re

import numpy as np
import pytest
import scipy.sparse as sp

from trueup.core import eigen, sparse_modes
from trueup.core.dofs import Dofs
from trueup.core.eigen import modes_of, solve
from trueup.core.errors import CheckError, InputError
from trueup.core.geometry import Geometry
from trueup.core.model import Model, Term


def chain(n, k=1.0, m=1.0, ground=0.0):
    """Springs in a row, free ends, each mass on a soft spring to ground."""
    K = k * sp.diags([-np.ones(n - 1), 2.0 * np.ones(n), -np.ones(n - 1)], [-1, 0, 1]).tolil()
    K[0, 0] = K[-1, -1] = k
    return (K + ground * sp.identity(n)).tocsr(), m * sp.identity(n, format="csr")


def chain_exact(n, k=1.0, m=1.0):
    return 4.0 * k / m * np.sin(np.pi * np.arange(n) / (2.0 * n)) ** 2


def scalar_model(K, M):
    """The same matrices as a model of scalar points, without any geometry."""
    n = K.shape[0]
    dofs = Dofs(np.arange(1, n + 1), np.ones(n, int))
    none = Geometry(np.zeros(0, int), np.zeros((0, 3)))
    return Model(none, dofs, sp.identity(n, format="csr"), (Term(K),), (Term(M),))


# closed forms


@pytest.mark.parametrize("scale", [1e-12, 1.0, 1e12])
@pytest.mark.parametrize("n", [5, 300, 2000])
def test_free_chain(n, scale, backend):
    found = solve(chain(n, k=scale), min(n, 12), backend=backend)
    exact = chain_exact(n, k=scale)[: min(n, 12)]
    np.testing.assert_allclose(found.eigenvalues[1:], exact[1:], rtol=1e-9)
    assert abs(found.eigenvalues[0]) < 1e-10 * exact[1]
    assert found.rigid_body_modes == 1
    assert found.checks["missed"] == 0
    assert found.checks["orthonormality"] < 1e-10


@pytest.mark.parametrize("n", [20, 40])
def test_square_membrane_has_every_repeated_mode(membrane, backend, n):
    K, M, exact = membrane(n, tension=3.0, mass=0.1)
    for wanted in (1, 2, 3, 10, 37):
        found = solve((K, M), wanted, backend=backend)
        np.testing.assert_allclose(found.eigenvalues, exact[:wanted], rtol=1e-10)
        assert found.rigid_body_modes == 0


@pytest.mark.parametrize("copies", [12, 40])
def test_more_equal_modes_than_the_block_is_wide(backend, copies):
    """Identical oscillators side by side; the end of the list may cut their cluster."""
    K, M = chain(60, ground=1e-3)
    exact = np.repeat(1e-3 + chain_exact(60), copies)
    many = sp.block_diag([K] * copies).tocsr(), sp.block_diag([M] * copies).tocsr()
    for wanted in (copies - 3, 2 * copies):
        found = solve(many, wanted, backend=backend)
        np.testing.assert_allclose(found.eigenvalues, exact[:wanted], rtol=1e-9)


def test_all_modes_of_a_small_model(membrane):
    K, M, exact = membrane(12)
    found = solve((K, M), 144)
    np.testing.assert_allclose(found.eigenvalues, exact, rtol=1e-12)
    assert found.backend == "lapack"


def test_cantilever_in_two_planes(line, section):
    s, L = section, 1.0
    model = line(40, L, fixed=[(0, c) for c in range(1, 7)])
    roots = np.repeat([1.8751040687, 4.6940911330, 7.8547574382, 10.995540735], 2)
    exact = roots**2 * np.sqrt(s.E * s.I2 / (s.rho * s.A * L**4)) / (2.0 * np.pi)
    found = solve(model, 8)
    np.testing.assert_allclose(found.frequencies_hz, exact, rtol=1e-5)
    assert found.rigid_body_modes == 0


@pytest.mark.parametrize("bars", [20, 150])
def test_free_beam_has_six_rigid_body_modes_then_pairs(line, section, bars, backend):
    s, L = section, 1.0
    found = solve(line(bars, L), 12, backend=backend)
    roots = np.repeat([4.7300407449, 7.8532046241, 10.995607838], 2)
    exact = roots**2 * np.sqrt(s.E * s.I2 / (s.rho * s.A * L**4)) / (2.0 * np.pi)
    assert found.rigid_body_modes == 6
    np.testing.assert_allclose(found.frequencies_hz[6:], exact, rtol=2e-4)
    assert found.frequencies_hz[5] < 1e-3 * found.frequencies_hz[6]


def test_ring_pairs(ring, section, backend):
    """In-plane bending of a thin ring, Hoppe 1871: n^2 (n^2 - 1)^2 / (n^2 + 1)."""
    s, R = section, 0.5
    found = solve(ring(180, R), 24, backend=backend)
    n = np.array([2.0, 3.0, 4.0])
    exact = np.sqrt(s.E * s.I2 / (s.rho * s.A * R**4) * n**2 * (n**2 - 1) ** 2 / (n**2 + 1))
    exact = exact / (2.0 * np.pi)
    assert found.rigid_body_modes == 6
    for f in exact:
        assert np.count_nonzero(abs(found.frequencies_hz / f - 1.0) < 5e-3) == 2


# how many, up to where


def test_up_to_a_frequency(membrane, backend):
    K, M, exact = membrane(30)
    fmax = np.sqrt(0.5 * (exact[20] + exact[21 + int(np.argmax(exact[21:] > exact[20] + 1e-9))]))
    fmax /= 2.0 * np.pi
    inside = np.count_nonzero(exact <= (2.0 * np.pi * fmax) ** 2)
    assert len(solve((K, M), fmax=fmax, backend=backend).eigenvalues) == inside
    assert len(solve((K, M), 5, fmax=fmax, backend=backend).eigenvalues) == 5
    assert len(solve((K, M), fmax=1e-3 * fmax, backend=backend).eigenvalues) == 0


def test_default_is_ten(membrane):
    K, M, _ = membrane(10)
    assert len(solve((K, M)).eigenvalues) == 10


@pytest.mark.parametrize("n", [100, 900])
def test_fewer_masses_than_modes_asked_for(n, backend):
    K, _ = chain(n, ground=1e-4)
    M = sp.csr_matrix((np.ones(4), ([3, 20, 50, 90],) * 2), (n, n))
    found = solve(scalar_model(K, M), 10, backend=backend)
    d = np.linalg.inv(K.toarray())[np.ix_([3, 20, 50, 90], [3, 20, 50, 90])]
    np.testing.assert_allclose(found.eigenvalues, 1.0 / np.linalg.eigvalsh(d)[::-1], rtol=1e-8)
    assert "allows only 4" in found.warnings[0]


@pytest.mark.parametrize("bars", [30, 130])
def test_rotations_without_mass(line, backend, bars):
    fixed = [(0, c) for c in range(1, 7)]
    model = line(bars, lumped=True, fixed=fixed)
    found = solve(model, 6, backend=backend)
    K, M = model.K().toarray(), model.M().toarray()
    massed = np.flatnonzero(M.diagonal())
    compliance = np.linalg.inv(K)[np.ix_(massed, massed)] * M.diagonal()[massed]
    exact = np.sort(1.0 / np.linalg.eigvals(compliance).real)[:6]
    np.testing.assert_allclose(found.eigenvalues, exact, rtol=1e-6)


def test_both_ends_of_a_wide_spectrum_are_accurate():
    """Springs over twelve decades: LAPACK's one-sided error would spoil one end."""
    k = 10.0 ** np.linspace(-4, 8, 13)
    K, M = sp.diags(k).tocsr(), sp.identity(13, format="csr")
    Q = np.linalg.qr(np.random.default_rng(0).standard_normal((13, 13)))[0]
    found = solve((K, M), 13)
    np.testing.assert_allclose(found.eigenvalues, k, rtol=1e-9)
    assert Q.shape == (13, 13)


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


# bad input, and checks that bite


def test_bad_input_is_refused_in_words(membrane):
    K, M, _ = membrane(5)
    for bad, words in (
        ((K, sp.csr_matrix(M.shape)), "no mass"),
        ((K, -M), "negative"),
        ((K * np.nan, M), "not finite"),
        ((-K, M), "not positive semi-definite|negative"),
        ((sp.csr_matrix(np.triu(K.toarray())), M), "not symmetric"),
        ((K[:20], M), "shape"),
    ):
        with pytest.raises(InputError, match=words):
            solve(bad)
    with pytest.raises(InputError, match="at least one"):
        solve((K, M), 0)
    with pytest.raises(InputError, match="above 0"):
        solve((K, M), fmax=-1.0)
    with pytest.raises(InputError, match="nothing can move"):
        solve((sp.csr_matrix((0, 0)), sp.csr_matrix((0, 0))))


def test_degree_of_freedom_with_nothing_is_named(ring):
    model = ring(12)
    out = sp.identity(72).tolil()
    out[14, 14] = 0.0
    bare = Model(
        model.geometry, model.dofs, model.expansion,
        (Term((out @ model.K() @ out).tocsr()),), (Term((out @ model.M() @ out).tocsr()),),
        (), model.free_labels,
    )  # fmt: skip
    with pytest.raises(InputError, match="3:3 has neither stiffness nor mass"):
        solve(bare)


@pytest.mark.parametrize("n", [50, 900])
def test_negative_spring(n, backend):
    K, M = chain(n, ground=1e-3)
    K = K + sp.csr_matrix(([-50.0], ([17], [17])), K.shape)
    with pytest.raises(InputError, match="negative"):
        solve(scalar_model(K, M), 4, backend=backend)


@pytest.mark.parametrize("n", [50, 900])
def test_mass_that_is_indefinite_off_the_diagonal(n, backend):
    K, M = chain(n, ground=1e-3)
    M = M + sp.csr_matrix(([3.0, 3.0], ([4, 5], [5, 4])), M.shape)
    with pytest.raises(InputError, match="mass matrix is not positive semi-definite"):
        solve(scalar_model(K, M), 4, backend=backend)


def test_a_missed_mode_is_found_again(membrane, monkeypatch):
    """An iteration that hides one mode: the count notices and a second search brings it."""
    K, M, exact = membrane(30)
    honest = sparse_modes._converged
    calls = []

    def forgetful(*args):
        found = honest(*args)
        calls.append(1)
        if len(calls) > 1:
            return found
        keep = np.arange(len(found.values)) != 4
        return sparse_modes.replace(
            found,
            values=found.values[keep],
            vectors=found.vectors[:, keep],
            residual=found.residual[keep],
        )

    monkeypatch.setattr(sparse_modes, "_converged", forgetful)
    found = solve((K, M), 12)
    np.testing.assert_allclose(found.eigenvalues, exact[:12], rtol=1e-9)
    assert found.checks["missed"] == 0
    assert len(calls) == 2


def test_a_mode_that_stays_missing_is_an_error(membrane, monkeypatch):
    K, M, _ = membrane(30)
    honest = sparse_modes._inertia
    monkeypatch.setattr(sparse_modes, "_inertia", lambda *a: honest(*a) + 1)
    with pytest.raises(CheckError, match="inertia count"):
        solve((K, M), 12)


def test_checks_that_are_not_met_raise():
    for bad in (
        {"residual": 1e-3, "orthonormality": 0.0, "missed": 0},
        {"residual": 0.0, "orthonormality": 1e-3, "missed": 0},
        {"residual": 0.0, "orthonormality": 0.0, "missed": 1},
        {"residual": np.nan, "orthonormality": 0.0, "missed": 0},
    ):
        with pytest.raises(CheckError):
            eigen._verify(bad)


@pytest.mark.parametrize("hertz", [1e-9, 1e-3, 1.0, 1e4, 1e9])
def test_any_first_shift_leads_to_the_modes(ring, monkeypatch, hertz):
    monkeypatch.setattr(sparse_modes, "_FIRST_SHIFT_HZ", hertz)
    model = ring(150)
    expected = solve(ring(150), 16).eigenvalues[6:]
    np.testing.assert_allclose(solve(model, 16).eigenvalues[6:], expected, rtol=1e-7)


def test_units_do_not_matter(frame, section):
    """Metres and kilograms, or millimetres and tonnes: the same hertz."""
    from dataclasses import replace

    a = 2.0 * np.pi * np.arange(120) / 120
    xyz = np.column_stack([np.cos(a), np.sin(a), 0.1 * np.sin(3 * a)])
    bars = [(i, (i + 1) % 120) for i in range(120)]
    s = section
    mm = replace(s, E=s.E * 1e-6, rho=s.rho * 1e-12, A=s.A * 1e6, I2=s.I2 * 1e12, J=s.J * 1e12)
    metres = solve(frame(xyz, bars, s), 20)
    millimetres = solve(frame(1e3 * xyz, bars, mm), 20)
    np.testing.assert_allclose(metres.frequencies_hz[6:], millimetres.frequencies_hz[6:], rtol=1e-8)
    assert metres.rigid_body_modes == millimetres.rigid_body_modes == 6


def test_modes_are_expanded_with_unit_modal_mass(ring):
    model = ring(24, fixed=[(0, c) for c in range(1, 7)])
    found = solve(model, 5)
    modes = modes_of(model, found)
    assert modes.shapes.shape == (144, 5)
    assert (modes.shapes[:6] == 0.0).all()
    assert (modes.generalized_mass == 1.0).all()
    np.testing.assert_allclose(modes.frequencies_hz, found.frequencies_hz)


def test_solution_is_read_only_and_repeatable(ring):
    model = ring(150)
    one, two = solve(model, 12), solve(model, 12)
    assert (one.vectors == two.vectors).all()
    with pytest.raises(ValueError, match="read-only"):
        one.vectors[0, 0] = 1.0


def test_the_factor_is_kept_on_request(ring, backend):
    model = ring(150)
    found = solve(model, 8, backend=backend, keep_factor=True)
    A = model.K() - found.sigma * model.M()
    b = np.ones(model.n_free)
    np.testing.assert_allclose(A @ found.factor.solve(b), b, atol=1e-5)
    assert solve(model, 8, backend=backend).factor is None
