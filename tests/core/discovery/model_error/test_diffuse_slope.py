"""The slope of the likelihood is that of central differences; its top that of a fine grid."""

from dataclasses import replace
from itertools import product

import numpy as np
import pytest
from scipy.linalg import eigh
from tests.core.discovery.model_error.test_diffuse_error import made

from trueup.core.discovery.model_error.diffuse_error import at
from trueup.core.discovery.model_error.diffuse_slope import diffuse, slope
from trueup.core.discovery.model_error.model_error_numbers import MODEL_ERROR


@pytest.mark.parametrize("close", [False, True])
def test_slopes_by_the_model_are_those_of_central_differences(close):
    seen, rng, h = made(0.01, close=close), np.random.default_rng(5), 1e-7
    n = len(seen.eigenvalues)
    root = np.sqrt(seen.eigenvalues)
    A, B = (A + A.T for A in rng.normal(size=(2, n, n)) / n)
    changes = (root[:, None] * A * root, 0.0 * B), (0.0 * A, B)
    d = at(seen, 0.02, 0.03)
    found = slope(seen, d)
    for K, M in changes:

        def log(step, K=K, M=M):
            values, V = eigh(np.diag(seen.eigenvalues) + step * K, np.eye(n) + step * M)
            moved = replace(seen, eigenvalues=values, modes=seen.modes @ V)
            return at(moved, d.error, d.noise).log

        central = (log(h) - log(-h)) / (2.0 * h)
        assert -np.sum(found.stiffness * K) - np.sum(found.mass * M) == pytest.approx(
            central, rel=1e-4, abs=1e-3
        )


def test_slopes_by_error_and_noise_are_those_of_central_differences():
    seen, h = made(0.01), 1e-5
    found = slope(seen, at(seen, 0.02, 0.03))
    by_error = at(seen, 0.02 * np.exp(h), 0.03).log - at(seen, 0.02 * np.exp(-h), 0.03).log
    by_noise = at(seen, 0.02, 0.03 * np.exp(h)).log - at(seen, 0.02, 0.03 * np.exp(-h)).log
    assert -found.errors == pytest.approx(np.array([by_error, by_noise]) / (2.0 * h), rel=1e-5)


def test_where_a_model_is_wrong_as_supposed_its_slopes_scatter_by_their_information():
    found = [slope(s, at(s, 0.02, 0.02)) for s in (made(0.02, seed=k) for k in range(40))]
    scatter = np.mean([f.errors**2 for f in found], axis=0)
    told = np.mean([np.diag(f.information) for f in found], axis=0)
    assert np.all(scatter / told < 4.0)
    assert np.all(scatter / told > 0.25)


def test_of_errors_and_noises_the_likeliest_of_all_is_found():
    for k, (error, noise) in enumerate(product((0.0, 0.003, 0.03), (0.01, 0.1, 0.5))):
        seen = made(error, noise, seed=k)
        grid = product(np.geomspace(*MODEL_ERROR.errors, 19), np.geomspace(*MODEL_ERROR.noises, 15))
        assert diffuse(seen).log > max(at(seen, *place).log for place in grid) - 0.1


def test_a_test_of_another_structure_tells_no_error_and_no_noise():
    seen = made(0.01)
    found = diffuse(replace(seen, hz=1e3 * seen.hz))
    assert np.all(found.stray > 0.99)
