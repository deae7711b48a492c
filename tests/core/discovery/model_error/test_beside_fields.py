"""Fields beside a hypothesis are of the likeliest size, and told where they are likelier."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.linalg import eigh
from tests.core.discovery.strings import K, M, N, X, hidden, searcher

from trueup.core.discovery.likelihood.map_fit import evaluate
from trueup.core.discovery.model_error import beside_fields
from trueup.core.discovery.model_error.beside_fields import with_drift
from trueup.core.discovery.model_error.diffuse_fit import everything, judged
from trueup.core.discovery.model_error.smooth_fields import Fields


def test_fields_that_could_not_make_the_error_that_is_left_are_not_tried(monkeypatch):
    problem = searcher(hidden(masses=[(7, 3.0)])).problem.entire()
    start = evaluate(problem, np.zeros(len(problem.prior.spread)), ())
    error = judged(problem, start, everything(problem)).diffuse.error
    tried, honest = [], beside_fields._promised

    def sized(plain, *sizes):
        tried.extend(s.spread for s in sizes)
        return honest(plain, *sizes)

    monkeypatch.setattr(beside_fields, "_promised", sized)
    with_drift(problem, start, NONE, drifting(np.zeros(N)))
    assert 0.02 < error < 0.06
    assert min(np.concatenate(tried)) == pytest.approx(0.01)


def test_fields_that_are_likely_only_if_large_are_found():
    q = np.sqrt(2.0) * np.cos(np.pi * X)
    problem = searcher((K, np.diag(1.0 + 0.06 * q))).problem.entire()
    start = evaluate(problem, np.zeros(len(problem.prior.spread)), ())
    many = drifting(q, *(np.sqrt(2.0) * np.cos(k * np.pi * X) for k in range(13, 23)))
    found = with_drift(problem, start, NONE, many)
    assert found.evidence > found.plain + 10.0
    assert found.drifts[0].name == "mass 0"
    assert found.drifts[0].amplitude == pytest.approx(0.06, abs=0.01)


def test_what_the_set_up_does_is_told_and_no_smooth_field():
    M = np.diag(np.where(X < 0.3, 1.0, 0.0))
    problem = searcher((K, np.eye(N) + 0.05 * M)).problem.entire()
    start = evaluate(problem, np.zeros(len(problem.prior.spread)), ())
    known = replace(drifting(np.diag(M)).of(0.03), names=("sensors",), least=np.zeros(1))
    other = drifting(np.sqrt(2.0) * np.cos(19.0 * np.pi * X))
    found = with_drift(problem, start, known, other)
    assert [d.name for d in found.drifts] == ["sensors"]
    assert found.drifts[0].amplitude == pytest.approx(0.05, abs=0.01)
    assert found.plain > found.bare + 10.0
    assert found.fit.nuisance.shape == start.nuisance.shape


def drifting(*shares):
    """Fields of mass that drift by shares (N,) of the beads' own."""
    own = eigh(K, M)[1]
    mass = np.array([own.T @ np.diag(q) @ own for q in shares]).reshape(-1, N, N)
    n = np.ones(len(shares))
    names = tuple(f"mass {k}" for k in range(len(shares)))
    return Fields(names, np.zeros_like(mass), mass, n, -0.4 * n)


NONE = drifting()
