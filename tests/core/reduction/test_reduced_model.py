"""The reduced model against the full one."""

from dataclasses import replace

import numpy as np
import pytest
import scipy.sparse as sp

from trueup.core.eigen.normal_modes import solve
from trueup.core.eigen.warm_modes import Near
from trueup.core.errors import InputError
from trueup.core.reduction.eigenpair_derivatives import sensitivities
from trueup.core.reduction.reduced_model import build_reduced


@pytest.fixture
def grid(frame):
    """A free, slightly warped grid of bars; moduli and densities of four regions."""

    def build(n=7, **options):
        x, y = np.meshgrid(np.linspace(0, 1, n), np.linspace(0, 0.8, n))
        xyz = np.column_stack([x.ravel(), y.ravel(), 0.05 * (x * y).ravel()])
        at = np.arange(n * n).reshape(n, n)
        bars = [*zip(at[:, :-1].ravel(), at[:, 1:].ravel(), strict=True)]
        bars += zip(at[:-1].ravel(), at[1:].ravel(), strict=True)
        count = len(bars)
        regions = [range(count // 5), range(count // 5, count // 2), range(count // 2, count)]
        parameters = [("E", r) for r in regions] + [("rho", regions[1])]
        return frame(xyz, bars, parameters=parameters, **options)

    return build


def shifted(p, *factors):
    q = np.array(p)
    q[: len(factors)] = factors
    return q


def mac(a, b):
    return (np.sum(a * b, axis=0) ** 2) / (np.sum(a * a, axis=0) * np.sum(b * b, axis=0))


TARGETS = range(6, 14)
PARAMETERS = range(4)


def test_at_its_own_point_it_is_the_full_model(grid):
    model = grid()
    p = model.deck_point
    reduced = build_reduced(model, p, TARGETS, PARAMETERS)
    full = solve(model, 20)
    found = reduced.solve(p, 20)
    np.testing.assert_allclose(found.eigenvalues[6:], full.eigenvalues[6:], rtol=1e-9)
    assert found.rigid_body_modes == 6
    X = reduced.vectors(found)
    np.testing.assert_allclose(X.T @ (model.M() @ X), np.eye(20), atol=1e-9)


@pytest.mark.parametrize("factors", [(1.3, 0.7, 1.0, 1.2), (0.7, 1.3, 0.8, 0.75)])
def test_thirty_percent_away_it_is_close_and_modes_alone_are_not(grid, factors):
    model = grid()
    p = np.array(factors)
    full = solve(model, 20, p=p)
    errors = []
    for parameters in (PARAMETERS, []):
        reduced = build_reduced(model, model.deck_point, TARGETS, parameters)
        found = reduced.solve(p, 14)
        deviation = np.sqrt(found.eigenvalues[6:] / full.eigenvalues[6:14]) - 1.0
        assert (deviation > -1e-9).all()
        errors.append(deviation.max())
    assert errors[0] < 7e-4
    assert errors[1] > 10.0 * errors[0]


def test_shapes_thirty_percent_away(grid):
    model = grid()
    p = np.array([1.3, 0.7, 1.0, 1.2])
    reduced = build_reduced(model, model.deck_point, TARGETS, PARAMETERS)
    full = solve(model, 16, p=p)
    X = reduced.vectors(reduced.solve(p, 14))
    assert mac(X[:, 6:12], full.vectors[:, 6:12]).min() > 0.9997


def test_a_basis_of_all_modes_is_exact_anywhere(grid):
    model = grid(3, fixed=[(0, c) for c in range(1, 7)])
    p = np.array([2.0, 0.4, 3.0, 0.5])
    everything = solve(model, model.n_free, keep_factor=True)
    reduced = build_reduced(model, model.deck_point, [0], [], solution=everything)
    assert reduced.size == model.n_free
    np.testing.assert_allclose(
        reduced.solve(p, 10).eigenvalues, solve(model, 10, p=p).eigenvalues, rtol=1e-8
    )


def test_factors_that_make_no_structure_are_refused(grid):
    model = grid()
    reduced = build_reduced(model, model.deck_point, TARGETS, PARAMETERS)
    with pytest.raises(InputError, match="positive definite"):
        reduced.solve(-np.ones(4), 10)


def test_derivatives_within_the_basis_agree_with_central_differences(grid):
    model = grid()
    p = np.array([1.1, 0.9, 1.2, 1.0])
    reduced = build_reduced(model, model.deck_point, TARGETS, PARAMETERS)
    C = sp.identity(model.n_free, format="csr")[::11]
    CQ = reduced.project(C.T).T
    found = reduced.sensitivities(p, TARGETS, PARAMETERS, CQ)
    base = reduced.solve(p, 20)
    np.testing.assert_allclose(found.values, base.eigenvalues[list(TARGETS)], rtol=1e-9)
    h = 1e-4
    for k in PARAMETERS:
        sides = []
        for s in (h, -h):
            q = p.copy()
            q[k] += s
            side = reduced.solve(q, 20)
            shape = CQ @ side.vectors
            sign = np.sign(np.sum(shape * (CQ @ base.vectors), axis=0))
            sides.append((side.eigenvalues, shape * sign))
        slope = (sides[0][0] - sides[1][0])[6:14] / (2.0 * h)
        np.testing.assert_allclose(found.slopes[:, k], slope, rtol=1e-5)
        expected = (sides[0][1] - sides[1][1])[:, 6:14] / (2.0 * h)
        expected = expected * np.sign(np.sum((CQ @ base.vectors)[:, 6:14] ** 2, axis=0))
        np.testing.assert_allclose(
            abs(found.shapes[:, :, k]), abs(expected), atol=1e-5 * abs(expected).max()
        )


def test_derivatives_are_those_of_the_full_model(grid):
    model = grid()
    p = model.deck_point
    start = solve(model, 30, keep_factor=True)
    reduced = build_reduced(model, p, TARGETS, PARAMETERS, solution=start)
    C = sp.identity(model.n_free, format="csr")[::11]
    full = sensitivities(model, p, start, TARGETS, PARAMETERS, C)
    found = reduced.sensitivities(p, TARGETS, PARAMETERS, reduced.project(C.T).T)
    np.testing.assert_allclose(found.slopes, full.slopes, rtol=1e-6)
    np.testing.assert_allclose(
        abs(found.shapes), abs(full.shapes), atol=2e-3 * abs(full.shapes).max()
    )
    T = np.zeros((14, 2))
    T[7:9] = [[0.8, -0.6], [0.6, 0.8]]
    both = reduced.sensitivities(p, T, [0, 1])
    assert both.slopes.shape == (2, 2)


def test_at_most_so_many_static_vectors(grid):
    model = grid()
    reduced = build_reduced(model, model.deck_point, TARGETS, PARAMETERS, max_static=7)
    assert reduced.size == len(reduced.solution.eigenvalues) + 7


def test_rotations_without_mass(grid):
    model = grid(lumped=True)
    p = np.array([1.2, 0.8, 1.1, 0.9])
    reduced = build_reduced(model, model.deck_point, TARGETS, PARAMETERS)
    full = solve(model, 14, p=p)
    found = reduced.solve(p, 14)
    np.testing.assert_allclose(found.eigenvalues[6:12], full.eigenvalues[6:12], rtol=2e-3)
    slopes = reduced.sensitivities(p, TARGETS, PARAMETERS).slopes
    assert np.isfinite(slopes).all()


def test_bad_input_is_refused_in_words(grid):
    model = grid(3)
    with pytest.raises(InputError, match="is a target"):
        build_reduced(model, model.deck_point, [10], [0], solution=solve(model, 8))


def test_modes_of_another_point_make_it_exact_there(grid):
    model = grid()
    reduced = build_reduced(model, model.deck_point, TARGETS, PARAMETERS, max_static=7)
    far = shifted(model.deck_point, 1.9, 0.6)
    full = solve(model, len(reduced.solution.eigenvalues), p=far)
    elastic = slice(full.rigid_body_modes, None)

    def off(by, p, truth):
        return np.abs(by.solve(p).eigenvalues[elastic] / truth.eigenvalues[elastic] - 1.0).max()

    wide = reduced.with_modes(full)
    assert off(reduced, far, full) > 1e-4
    assert off(wide, far, full) < 1e-8
    assert off(wide, model.deck_point, reduced.solution) < 1e-8
    near = shifted(far, 2.0, 0.57)
    there = solve(model, len(reduced.solution.eigenvalues), p=near)
    assert off(wide, near, there) < 0.1 * off(reduced, near, there)
    assert wide.with_modes(full).size == wide.size


def test_a_correction_brings_it_close_where_it_is_used(grid):
    model = grid()
    reduced = build_reduced(model, model.deck_point, TARGETS, PARAMETERS, max_static=7)
    far = shifted(model.deck_point, 1.4, 0.7)
    elastic = slice(6, len(TARGETS) + 6)
    full = solve(model, elastic.stop, p=far)
    errors = []
    for _ in range(3):
        found = reduced.solve(far, elastic.stop)
        errors.append(np.abs(found.eigenvalues / full.eigenvalues - 1.0)[elastic].max())
        reduced = reduced.corrected(far, found)
    assert errors[1] < 0.2 * errors[0]
    assert errors[2] < 0.2 * errors[1]
    A = model.K() - reduced.solution.sigma * model.M()
    Q = np.hstack(reduced.parts)
    np.testing.assert_allclose(Q.T @ (A @ Q), np.eye(reduced.size), atol=1e-6)


def test_a_sketch_of_static_answers_is_better_than_modes_and_all_of_them_at_its_widest(grid):
    model = grid()
    p = np.array([1.3, 0.7, 1.0, 1.2])
    full = solve(model, 14, p=p)
    start = solve(model, 26, keep_factor=True)

    def off(**options):
        by = build_reduced(model, model.deck_point, TARGETS, PARAMETERS, solution=start, **options)
        return by.size, np.abs(by.solve(p, 14).eigenvalues / full.eigenvalues - 1.0)[6:].max()

    (whole, best), (some, sketched), (none, worst) = off(), off(sketch=12), off(max_static=0)
    assert none < some == none + 12 < whole
    assert best < sketched < 0.5 * worst
    assert off(sketch=len(TARGETS) * len(PARAMETERS))[1] <= best


def test_derivatives_come_right_with_answers_by_the_factor_that_counted_the_modes(grid):
    model = grid(n=11)
    p = np.array([1.3, 0.7, 1.0, 1.2])
    known = solve(model, 34, p=p)
    near = Near(known.eigenvalues[6:], known.vectors[:, 6:])
    found = solve(model, 30, p=p, near=near)
    start = solve(model, 30, keep_factor=True)
    sketched = build_reduced(
        model, model.deck_point, TARGETS, PARAMETERS, solution=start, sketch=12
    )
    sketched = sketched.with_modes(found)
    C = sp.identity(model.n_free, format="csr")[::11]
    full = sensitivities(model, p, found, TARGETS, PARAMETERS, C).shapes

    def off(reduced):
        at = reduced.project(C.T).T
        slopes = reduced.sensitivities(p, TARGETS, PARAMETERS, at).shapes
        return np.linalg.norm(abs(slopes) - abs(full)) / np.linalg.norm(full)

    elastic = np.arange(found.rigid_body_modes, len(found.eigenvalues))
    widened = sketched.differentiable(p, found, PARAMETERS, 64, elastic)
    assert widened.size == sketched.size + 64
    assert off(widened) < 0.2 * off(sketched)
    anew = sketched.differentiable(p, replace(found, count_factor=None), PARAMETERS, 64, elastic)
    assert off(anew) < 0.2 * off(sketched)
    A = model.K() - start.sigma * model.M()
    Q = np.hstack(widened.parts)
    np.testing.assert_allclose(Q.T @ (A @ Q), np.eye(widened.size), atol=1e-6)
