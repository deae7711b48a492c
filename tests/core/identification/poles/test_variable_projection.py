"""Variable projection against numerical derivatives and against exact answers."""

import numpy as np
import pytest

from trueup.core.identification.poles.moments import band_data, basis, reduced_normal
from trueup.core.identification.poles.variable_projection import (
    fit_shapes,
    free_columns,
    refine,
    solve_shapes,
    system_at,
)
from trueup.core.identification.survey.modal_synthesis import poles_from


@pytest.fixture
def problem(survey):
    frfs, truth = survey(
        3,
        frequencies=[30, 31, 34, 50],
        noise=0.0,
        n_response=9,
        n_line=300,
        n_reference=3,
        outside=False,
        complexity=0.1,
    )
    measured = np.random.default_rng(0).uniform(size=(9, 3)) < 0.7
    measured[:, 0] = True
    data = band_data(frfs.frequencies_hz, np.array(frfs.values), measured)
    return data, poles_from(truth.frequencies_hz, truth.damping), truth.shapes[[0, 4, 8]]


def moved(fit, step):
    m = len(fit.poles)
    pole = step[: 2 * m].reshape(m, 2)
    part = step[2 * m :].reshape(m, 2, -1)
    return fit.poles + pole @ [1, 1j], fit.participation + (part[:, 0] + 1j * part[:, 1]).T


def test_reduced_normal_matrix_is_the_schur_complement(problem):
    """Assembled from second moments of the shapes, it equals the one assembled output by output."""
    data, poles, part = problem
    fit = fit_shapes(data, poles * 1.001, part + 0.1)
    full, F, G = system_at(data, fit)
    size = full.common_common.shape[0]
    T = solve_shapes(full.shape_shape, full.shape_common).reshape(-1, size)
    schur = full.common_common - full.shape_common.reshape(-1, size).T @ T
    S = reduced_normal(G, fit.participation, fit.shapes, data.patterns, solve_shapes)
    assert np.abs(S - schur).max() < 1e-10 * np.abs(schur).max()
    assert F.shape == basis(data, fit.poles).shape


def test_normal_matrix_is_the_curvature_at_the_solution(problem):
    """With no residual, the second derivative of the misfit is twice the reduced normal matrix."""
    data, poles, part = problem
    fit = fit_shapes(data, poles, part)
    full, _, G = system_at(data, fit)
    S = reduced_normal(G, fit.participation, fit.shapes, data.patterns, solve_shapes)
    size = len(S)
    assert full.common_common.shape == S.shape
    scale = 1.0 / np.sqrt(np.maximum(np.diag(S), 1e-30))
    rng = np.random.default_rng(1)
    columns = free_columns(fit.participation)
    for _ in range(5):
        step = np.zeros(size)
        step[columns] = 1e-2 * rng.standard_normal(len(columns)) * scale[columns]
        plus = fit_shapes(data, *moved(fit, step)).misfit
        minus = fit_shapes(data, *moved(fit, -step)).misfit
        assert 0.5 * (plus + minus) == pytest.approx(step @ S @ step, rel=1e-3)


def test_clean_data_give_exact_poles_from_a_poor_start(problem):
    data, poles, part = problem
    rng = np.random.default_rng(2)
    start = poles * (1 + 3e-4 * rng.standard_normal(len(poles)))
    fit = refine(data, start, part + 0.1 * rng.standard_normal(part.shape))
    assert fit.converged
    assert np.abs(fit.poles - poles).max() < 1e-9 * np.abs(poles).max()
    assert fit.misfit < 1e-12 * data.power


def test_refinement_takes_the_bias_out_of_the_linear_estimate(survey):
    """30 % noise: the linear estimate's damping is off, the refined one is not."""
    from trueup.core.identification.poles.plscf import poles_by_order

    frfs, truth = survey(
        5, frequencies=[50.0], damping=(0.01, 0.01), noise=0.3, band=(40, 60), outside=False
    )
    data = band_data(frfs.frequencies_hz, np.array(frfs.values), np.ones((40, 2), bool))
    exact = poles_from(truth.frequencies_hz, truth.damping)[0]
    (linear,) = poles_by_order(frfs.frequencies_hz, frfs.values, [4])
    best = int(np.argmin(np.abs(linear.values - exact)))
    fit = refine(data, linear.values[[best]], linear.participation[[best]].T)

    def damping_error(pole):
        return abs(pole.real / exact.real - 1.0)

    assert damping_error(linear.values[best]) > 0.03
    assert damping_error(fit.poles[0]) < 0.01
