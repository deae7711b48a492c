"""Derivatives against central differences: separate, repeated and nearly repeated modes."""

from dataclasses import replace

import numpy as np
import pytest
import scipy.sparse as sp
from scipy.linalg import polar

from trueup.core.data.parametric_model import Factor, Model
from trueup.core.eigen.normal_modes import solve
from trueup.core.errors import InputError
from trueup.core.reduction import eigenvector_derivatives
from trueup.core.reduction.derivative_numbers import DERIVATIVES
from trueup.core.reduction.eigenpair_derivatives import clusters, sensitivities

STEP = 1e-3


@pytest.fixture
def tower(frame):
    """A bent, unsymmetric frame on a fixed foot; three parameters, one of them cubic."""
    rng = np.random.default_rng(5)
    n = 25
    xyz = np.column_stack([np.linspace(0, 1, n), 0.2 * np.linspace(0, 1, n) ** 2, np.zeros(n)])
    xyz += 0.01 * rng.standard_normal((n, 3))
    bars = [(i, i + 1) for i in range(n - 1)] + [(3, 20)]
    parameters = [("E", range(8)), ("rho", range(5, 15)), ("E", range(15, 25))]
    model = frame(xyz, bars, fixed=[(0, c) for c in range(1, 7)], parameters=parameters)
    return cubic(model, 2)


def cubic(model: Model, parameter: int) -> Model:
    """Let one parameter act by its third power, as a thickness does in bending."""
    lower, upper = 0.5, 2.0
    x = np.polynomial.Chebyshev.interpolate(lambda t: t**3, 3, [lower, upper])
    factor = Factor(parameter, tuple(x.coef), lower, upper)
    terms = tuple(
        replace(t, factors=(factor,)) if t.factors and t.factors[0].parameter == parameter else t
        for t in model.stiffness
    )
    return replace(model, stiffness=terms)


@pytest.fixture
def sectored_ring(ring):
    """Sectors of a ring as parameters: every one splits every pair."""

    def build(n=24, **options):
        here, there = [*range(n // 5 + 1), n // 2], range(n // 3, n // 2 - 1)
        parts = [("E", here), ("rho", there), ("rho", [])]
        return ring(n, parameters=parts, **options)

    return build


def precise(model, n, p):
    return solve(model, n, p=p, tolerance=1e-11)


def moved(model, p, k, h):
    q = np.array(p, float)
    q[k] += h
    return q


def aligned(model, reference, solution, cluster):
    """The cluster's basis turned, without stretching, onto the reference."""
    X0, X = reference.vectors[:, cluster], solution.vectors[:, cluster]
    M = model.M(np.ones(len(model.parameters)))
    return X @ polar(X.T @ (M @ X0))[0]


def neighbours(model, p, k, n, h=STEP):
    """Solutions at p + h, p - h, p + 2h and p - 2h of one parameter, and h."""
    return [precise(model, n, moved(model, p, k, s * h)) for s in (1, -1, 2, -2)], h


def difference(model, solution, cluster, around):
    """Central differences of fourth order: shapes of the cluster, and all eigenvalues."""
    solutions, h = around

    def fourth(a, b, c, d):
        return (8.0 * (a - b) - (c - d)) / (12.0 * h)

    return (
        fourth(*(aligned(model, solution, s, cluster) for s in solutions)),
        fourth(*(s.eigenvalues for s in solutions)),
    )


def close(found, expected, tolerance=1e-5):
    np.testing.assert_allclose(found, expected, rtol=0, atol=tolerance * abs(expected).max())


@pytest.mark.parametrize("kind", ["E", "rho"])
def test_one_material_for_all_leaves_nothing_outside_the_known_modes(ring, kind):
    """K' = K: shapes stay. M' = M: they scale by (1 + p)^(-1/2). What is left is rounding."""
    n = 40
    model = ring(n, parameters=[(kind, range(n))])
    solution = solve(model, 16)
    found = sensitivities(model, np.ones(1), solution, range(6, 12), [0], sp.identity(model.n_free))
    rate, slope = (-0.5, -1.0) if kind == "rho" else (0.0, 1.0)
    X, lam = solution.vectors[:, 6:12], solution.eigenvalues[6:12]
    np.testing.assert_allclose(found.slopes[:, 0], slope * lam, rtol=1e-7)
    np.testing.assert_allclose(found.shapes[:, :, 0], rate * X, atol=1e-6 * abs(X).max())


def test_separate_modes_agree_with_central_differences(tower):
    p = np.array([1.1, 0.9, 1.2])
    solution = precise(tower, 12, p)
    found = sensitivities(tower, p, solution, range(6), [0, 1, 2], sp.identity(tower.n_free))
    np.testing.assert_allclose(found.values, solution.eigenvalues[:6])
    for k in range(3):
        around = neighbours(tower, p, k, 12)
        for mode in range(6):
            shape, slope = difference(tower, solution, [mode], around)
            np.testing.assert_allclose(found.slopes[mode, k], slope[mode], rtol=1e-5)
            close(found.shapes[:, mode, k], shape[:, 0])


def test_sensors_see_the_same_as_all_degrees_of_freedom(tower):
    p = tower.deck_point
    solution = precise(tower, 12, p)
    C = np.random.default_rng(0).standard_normal((7, tower.n_free))
    everywhere = sensitivities(tower, p, solution, [2, 0], [1], np.eye(tower.n_free)).shapes
    at_sensors = sensitivities(tower, p, solution, [2, 0], [1], C).shapes
    close(at_sensors[:, :, 0], C @ everywhere[:, :, 0], 1e-12)
    assert sensitivities(tower, p, solution, [2, 0], [1]).shapes is None


@pytest.mark.parametrize("parameter", [0, 1])
def test_repeated_eigenvalues_of_a_ring_leave_on_two_branches(sectored_ring, parameter):
    """Where the pair splits the sorted values swap sides: upper after, lower before the point."""
    model = sectored_ring()
    p = model.deck_point
    solution = precise(model, 20, p)
    pairs = [tuple(c) for c in clusters(np.eye(20), solution) if len(c) == 2]
    assert len(pairs) >= 3
    found = sensitivities(model, p, solution, range(20), [parameter])
    (up, down, up2, down2), h = neighbours(model, p, parameter, 20)
    for low, high in pairs[:4]:
        branches = [
            8.0 * (up.eigenvalues[a] - down.eigenvalues[b]) / (12.0 * h)
            - (up2.eigenvalues[a] - down2.eigenvalues[b]) / (12.0 * h)
            for a, b in ((low, high), (high, low))
        ]
        np.testing.assert_allclose(found.slopes[[low, high], 0], sorted(branches), rtol=1e-5)
        assert abs(branches[1] - branches[0]) > 1e-3 * abs(branches[0])


def test_cluster_matrix_holds_the_branches_and_the_rotated_slopes(sectored_ring):
    model = sectored_ring()
    p = model.deck_point
    solution = precise(model, 20, p)
    pair = next(c for c in clusters(np.eye(20), solution) if len(c) == 2)
    X, lam = solution.vectors[:, pair], solution.eigenvalues[pair]
    g = [X.T @ model.dK(k, p) @ X - (X.T @ model.dM(k, p) @ X) * lam for k in (0, 1)]
    G = np.array([(m + m.T) / 2.0 for m in g])
    by_position = sensitivities(model, p, solution, pair, [0, 1]).slopes
    np.testing.assert_allclose(np.linalg.eigvalsh(G).T, by_position, rtol=1e-9)
    a = 0.6
    R = np.array([[np.cos(a), -np.sin(a)], [np.sin(a), np.cos(a)]])
    T = np.zeros((20, 2))
    T[pair] = R
    rotated = sensitivities(model, p, solution, T, [0, 1]).slopes
    np.testing.assert_allclose(rotated.T, np.einsum("ak,iab,bk->ik", R, G, R), rtol=1e-9)


@pytest.mark.parametrize("parameter", [0, 1])
def test_subspace_of_a_repeated_pair_agrees_with_central_differences(sectored_ring, parameter):
    model = sectored_ring()
    p = model.deck_point
    solution = precise(model, 24, p)
    pairs = [c for c in clusters(np.eye(24), solution) if len(c) == 2][:3]
    around = neighbours(model, p, parameter, 24)
    for pair in pairs:
        found = sensitivities(
            model, p, solution, pair, [parameter], sp.identity(model.n_free)
        ).shapes[:, :, 0]
        expected, _ = difference(model, solution, pair, around)
        close(found, expected)


def test_rotated_cluster_of_a_nearly_repeated_pair(sectored_ring):
    """0.5 % apart: each mode alone turns fast, the combination of both does not."""
    model = sectored_ring(masses=[(3, 0.002)])
    p = np.array([1.02, 1.0, 1.0])
    solution = precise(model, 24, p)
    lam = solution.eigenvalues
    low = 6 + int(np.argmin(np.diff(lam[6:16]) / lam[6:15]))
    pair = [low, low + 1]
    assert 1e-5 < lam[low + 1] / lam[low] - 1.0 < 2e-2
    T = np.zeros((24, 2))
    T[pair] = [[0.8, -0.6], [0.6, 0.8]]
    found = sensitivities(model, p, solution, T, [0, 1], sp.identity(model.n_free))
    for k in (0, 1):
        expected, _ = difference(model, solution, pair, neighbours(model, p, k, 24))
        close(found.shapes[:, :, k], expected @ T[pair])
        quotient = []
        for h in (STEP, -STEP):
            q = moved(model, p, k, h)
            Y = aligned(model, solution, precise(model, 24, q), pair) @ T[pair]
            quotient.append(np.einsum("ij,ij->j", Y, model.K(q) @ Y))
        slope = (quotient[0] - quotient[1]) / (2.0 * STEP)
        np.testing.assert_allclose(found.slopes[:, k], slope, rtol=1e-5)
    apart = sensitivities(model, p, solution, pair, [0], sp.identity(model.n_free))
    assert abs(apart.shapes).max() > 3.0 * abs(found.shapes[:, :, 0]).max()


def test_close_modes_one_by_one_agree_with_central_differences(sectored_ring):
    model = sectored_ring(masses=[(3, 0.002)])
    p = np.array([1.02, 1.0, 1.0])
    solution = precise(model, 24, p)
    around = neighbours(model, p, 1, 24, h=1e-5)
    for mode in (6, 7):
        found = sensitivities(model, p, solution, [mode], [1], sp.identity(model.n_free))
        expected, slope = difference(model, solution, [mode], around)
        close(found.shapes[:, 0, 0], expected[:, 0], 1e-5)
        np.testing.assert_allclose(found.slopes[0, 0], slope[mode], rtol=1e-5)


def test_threefold_eigenvalue(frame):
    """A cube of bars about one mass: three translations of the mass in one cluster."""
    xyz = np.vstack([np.zeros(3), np.eye(3), -np.eye(3)])
    bars = [(0, i) for i in range(1, 7)]
    fixed = [(i, c) for i in range(1, 7) for c in range(1, 7)]
    parameters = [("E", [0]), ("E", [1, 4]), ("rho", [2])]
    model = frame(xyz, bars, fixed=fixed, masses=[(0, 5.0)], parameters=parameters)
    solution = precise(model, 6, None)
    triple = next(c for c in clusters(np.eye(6), solution) if 0 in c)
    assert len(triple) == 3
    found = sensitivities(model, model.deck_point, solution, triple, [0, 1, 2])
    p = model.deck_point
    for k in range(3):
        up = precise(model, 6, moved(model, p, k, 1e-5)).eigenvalues[:3]
        down = precise(model, 6, moved(model, p, k, -1e-5)).eigenvalues[:3]
        expected = np.sort((up - down[::-1]) / 2e-5)
        np.testing.assert_allclose(
            found.slopes[:, k], expected, rtol=1e-5, atol=1e-5 * abs(expected).max()
        )


@pytest.mark.parametrize("route", [1, 10_000])
def test_large_model_by_both_factors(sectored_ring, backend, monkeypatch, route):
    """The factor of the solution, or one next to each cluster: the same derivatives."""
    changed = replace(DERIVATIVES, own_factor=route)
    monkeypatch.setattr(eigenvector_derivatives, "DERIVATIVES", changed)
    model = sectored_ring(120, fixed=[(0, c) for c in range(1, 7)])
    p = model.deck_point
    solution = solve(model, 16, p=p, backend=backend, tolerance=1e-11, keep_factor=True)
    C = sp.identity(model.n_free, format="csr")[::7]
    found = sensitivities(model, p, solution, range(8), [0, 1], C)
    for k in (0, 1):
        around = neighbours(model, p, k, 16)
        for mode in (0, 3, 7):
            expected, slope = difference(model, solution, [mode], around)
            close(found.shapes[:, mode, k], C @ expected[:, 0])
            np.testing.assert_allclose(found.slopes[mode, k], slope[mode], rtol=1e-5)


def test_rigid_body_modes_stay_at_zero(sectored_ring):
    model = sectored_ring(120)
    solution = precise(model, 14, None)
    found = sensitivities(model, model.deck_point, solution, range(6), [0, 1])
    assert abs(found.slopes).max() < 1e-6 * solution.eigenvalues[6]


def test_a_parameter_without_effect_has_no_derivative(sectored_ring):
    model = sectored_ring()
    solution = precise(model, 14, None)
    found = sensitivities(
        model, model.deck_point, solution, [6, 7, 10], [2], sp.identity(model.n_free)
    )
    assert not found.slopes.any()
    assert not found.shapes.any()


def test_half_a_cluster_at_the_end_is_refused(sectored_ring):
    model = sectored_ring(120)
    solution = precise(model, 7, None)
    with pytest.raises(InputError, match="solve for more modes"):
        sensitivities(model, model.deck_point, solution, [6], [0], sp.identity(model.n_free))


def test_bad_input_is_refused_in_words(tower):
    solution = solve(tower, 4)
    p = tower.deck_point
    for modes, parameters, sensors, words in (
        ([4], [0], None, "mode 5 was asked for"),
        ([0], [3], None, "parameter 3 does not exist"),
        ([0], [0], np.ones((1, 3)), "sensors look at 3"),
        (np.ones((3, 1)), [0], None, "coefficients for 3 modes"),
        (np.zeros((4, 1)), [0], None, "empty"),
    ):
        with pytest.raises(InputError, match=words):
            sensitivities(tower, p, solution, modes, parameters, sensors)
