"""Scatter of residuals kind by kind, beside errors that are known."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import pytest
from scipy.stats import t as student

from trueup.core.updating.scatter import Kind, Scatter, scatter_of
from trueup.core.updating.updating_numbers import UPDATING

TRUTH = np.array([1.0, -2.0])


def draw(
    rng: np.random.Generator, designs: Sequence[np.ndarray], sigmas: Sequence[float]
) -> tuple[np.ndarray, Scatter]:
    """Least squares with all standard deviations taken for 1: the estimate, and what is said."""
    G = np.vstack(designs)
    y = G @ TRUTH + np.concatenate(
        [s * rng.standard_normal(len(d)) for d, s in zip(designs, sigmas, strict=True)]
    )
    x = np.linalg.lstsq(G, y, rcond=None)[0]
    left = np.split(G @ x - y, np.cumsum([len(d) for d in designs])[:-1])
    kinds = [Kind(r, d, len(d), False) for r, d in zip(left, designs, strict=True)]
    return x, scatter_of(kinds)


def covariance(said: Scatter) -> np.ndarray:
    return said.variance * np.linalg.inv(said.gradient.T @ said.gradient)


@pytest.mark.parametrize("data", [3, 4, 6, 12])
def test_few_data_of_one_kind_have_intervals_that_hold_what_they_say(data: int) -> None:
    """95 of 100 whatever the number of data; by 1.96 standard errors 70 of 100 of three."""
    rng = np.random.default_rng(data)
    G = rng.standard_normal((data, 2))
    hits = normal = 0.0
    squares, n = np.zeros(2), 1500
    for _ in range(n):
        x, said = draw(rng, [G], [0.7])
        error = np.sqrt(np.diag(covariance(said)))
        np.testing.assert_allclose(said.freedom, data - 2)
        widths = np.sqrt(said.rises * np.diag(np.linalg.inv(G.T @ G)))
        np.testing.assert_allclose(widths, student.ppf(0.975, data - 2) * error, rtol=1e-9)
        hits += np.mean(np.abs(x - TRUTH) < widths) / n
        normal += np.mean(np.abs(x - TRUTH) < 1.96 * error) / n
        squares += error**2 / n
    assert hits == pytest.approx(0.95, abs=0.015)
    assert normal < 0.93
    np.testing.assert_allclose(squares, 0.49 * np.diag(np.linalg.inv(G.T @ G)), rtol=0.15)


@pytest.mark.parametrize("sigmas", [(1.0, 1.0), (3.0, 0.1)])
def test_kinds_that_scatter_apart_have_the_errors_of_repeated_tests(
    sigmas: tuple[float, float],
) -> None:
    """Standard deviations were taken for 1; with 3 and 0.1 one scatter of both misses either."""
    rng = np.random.default_rng(5)
    # the first factor is known by one kind, the second by the other
    designs = [rng.standard_normal((n, 2)) * scale for n, scale in ((9, [1, 0.1]), (11, [0.05, 1]))]
    inverse = np.diag(np.linalg.inv(sum(d.T @ d for d in designs)))
    n = 1500
    found, said, hits = np.zeros((n, 2)), np.zeros(2), np.zeros(2)
    for k in range(n):
        found[k], scatter = draw(rng, designs, sigmas)
        said += np.diag(covariance(scatter)) / n
        hits += (np.abs(found[k] - TRUTH) < np.sqrt(scatter.rises * inverse)) / n
    known = found.var(axis=0)
    np.testing.assert_allclose(said, known, rtol=0.15)
    assert (hits > 0.935).all()
    if sigmas[0] == sigmas[1]:
        np.testing.assert_allclose(hits, 0.95, atol=0.015)
    else:
        one = np.average(np.square(sigmas), weights=[9, 11]) * inverse
        assert one[1] > 4.0 * known[1]
        assert one[0] < 0.7 * known[0]


def test_a_kind_of_few_data_shares_and_a_stated_one_is_believed() -> None:
    rng = np.random.default_rng(1)
    wide, few = rng.standard_normal((12, 2)), rng.standard_normal((2, 2))
    values = 0.2 * rng.standard_normal(12)
    values -= wide @ np.linalg.lstsq(wide, values, rcond=None)[0]  # least: none along the columns
    alone = scatter_of([Kind(values, wide, 12, False)])
    both = scatter_of([Kind(values, wide, 12, False), Kind(np.zeros(2), few, 2, True)])
    assert alone.variance == pytest.approx(values @ values / 10.0)
    A = wide.T @ wide + few.T @ few
    s = h = 1.0
    for _ in range(60):
        s = values @ values / (12.0 - h)
        h = np.trace(np.linalg.solve(wide.T @ wide / s + few.T @ few, wide.T @ wide / s))
    B = s * wide.T @ wide + few.T @ few
    np.testing.assert_allclose(
        covariance(both), np.linalg.solve(A, np.linalg.solve(A, B).T), rtol=1e-3
    )
    assert (both.freedom > 12.0 - h - 1e-3).all()
    pooled = scatter_of([Kind(values[:3], wide[:3], 3, False), Kind(values[3:5], few, 2, False)])
    assert pooled.variance == pytest.approx(values[:5] @ values[:5] / 3.0)


def test_as_many_parameters_as_data_are_believed() -> None:
    said = scatter_of([Kind(np.zeros(2), np.eye(2), 2, False)])
    assert said.variance == 1.0
    np.testing.assert_allclose(said.rises, 3.841459, rtol=1e-6)
    assert scatter_of([Kind(np.ones(9), np.ones((9, 1)), 9, False)], believed=True).variance == 1.0


def test_a_combination_that_nothing_sees_takes_no_degree_of_freedom() -> None:
    G = np.outer(np.arange(1.0, 7.0), [1.0, 1.0])
    values = np.array([1.0, -0.5, 0, 0, 0, 0])
    said = scatter_of([Kind(values, G, 6, False)])
    assert said.variance == pytest.approx(1.25 / 5.0)
    assert UPDATING.enough < 5.0
