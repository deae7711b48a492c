"""Frequency responses as evidence, on the string of beads and by closed form."""

from __future__ import annotations

from dataclasses import replace
from types import SimpleNamespace as Some

import numpy as np
import pytest
import scipy.linalg as la
import scipy.sparse as sp
from tests.core.discovery.strings import SEEN, K, M, N, hidden, searcher

from trueup.core.data.dofs import Dofs
from trueup.core.data.frfs import Frfs
from trueup.core.discovery.effects.candidates import Suspect
from trueup.core.discovery.likelihood.frf_evidence import misfit_of_responses, turned_state
from trueup.core.discovery.likelihood.frf_likelihood import (
    Responses,
    State,
    frac,
    heard,
    independent_lines,
    lacking,
    log_ratios,
    ratios_of,
    synthesised,
)
from trueup.core.discovery.likelihood.map_fit import fit
from trueup.core.discovery.reduction.residual_flexibility import Compliance
from trueup.core.discovery.search.found import Found
from trueup.core.discovery.search.model_selection import chosen, scored

DRIVEN = np.array([4, 17])
ZETA = 0.006


def exact(truth, lines, quantity="displacement"):
    """Responses by inverting the dynamic stiffness, all modes damped alike."""
    k, m = truth
    values, phi = la.eigh(k, m)
    C = m @ phi @ np.diag(2.0 * ZETA * np.sqrt(values)) @ phi.T @ m
    out = np.empty((len(SEEN), len(DRIVEN), len(lines)), complex)
    power = ("displacement", "velocity", "acceleration").index(quantity)
    for i, w in enumerate(2.0 * np.pi * lines):
        H = np.linalg.inv(k - w**2 * m + 1j * w * C) * (1j * w) ** power
        out[:, :, i] = H[np.ix_(SEEN, DRIVEN)]
    return out


def responses(truth, lines, quantity="displacement", noise=0.0):
    values = exact(truth, lines, quantity)
    rng = np.random.default_rng(2)
    scatter = rng.standard_normal((2, *values.shape)) @ np.eye(len(lines))
    values = values * (1.0 + noise * (scatter[0] + 1j * scatter[1]))
    every = sp.identity(N, format="csr")
    frfs = Frfs(
        lines,
        Dofs(SEEN + 1, np.ones(len(SEEN), int)),
        Dofs(DRIVEN + 1, np.ones(len(DRIVEN), int)),
        values,
        quantity,
    )
    return Responses(frfs, every[SEEN], every[DRIVEN])


def state(truth):
    values, phi = la.eigh(*truth)
    return State(np.sqrt(values), np.full(N, ZETA), phi)


LINES = np.linspace(0.2, 6.2, 300)


@pytest.mark.parametrize("quantity", ["displacement", "velocity", "acceleration"])
def test_synthesis_is_the_inverse_of_the_dynamic_stiffness(quantity):
    r = responses(hidden(), LINES, quantity)
    none = np.zeros((len(SEEN), len(DRIVEN)))
    made = synthesised(r, state(hidden()), none)
    np.testing.assert_allclose(made, r.frfs.values, rtol=1e-9)
    some = synthesised(r, state(hidden()), none, np.array([3, 70]), np.array([1, 5]))
    np.testing.assert_allclose(some, r.frfs.values[[1, 5]][:, :, [3, 70]], rtol=1e-9)


def test_what_a_short_basis_lacks_is_put_back():
    r = responses(hidden(), LINES)
    values, phi = la.eigh(K, M)
    short = phi[:, :14]
    deck = Some(K=lambda: sp.csr_matrix(K), M=lambda: sp.csr_matrix(M))
    compliance = Compliance(deck, Some(sigma=0.0, factor=None))
    rest = lacking(r.observed, r.driven, compliance, short)
    s = State(np.sqrt(values[:14]), np.full(14, ZETA), short)
    static = replace(r, frfs=replace(r.frfs, frequencies_hz=np.full(300, 1e-6)))
    np.testing.assert_allclose(
        synthesised(static, s, rest)[:, :, 0],
        np.linalg.inv(K)[np.ix_(SEEN, DRIVEN)],
        rtol=1e-6,
    )
    with_rest, without = (
        np.mean(frac(r.frfs.values, synthesised(r, s, x))) for x in (rest, 0.0 * rest)
    )
    assert with_rest > without


def test_assurance_is_one_for_a_multiple_and_nothing_across():
    h = exact(hidden(), LINES)
    np.testing.assert_allclose(frac(h, (2.0 - 1.0j) * h), 1.0)
    a = np.array([1.0, 1.0j, 0.0])
    b = np.array([1.0, -1.0j, 0.0])
    assert frac(a, b) == pytest.approx(0.0)
    gap = np.array([1.0, np.nan, 2.0])
    assert frac(gap, np.array([1.0, 7.0, 2.0])) == pytest.approx(1.0)


def test_one_common_factor_says_nothing():
    h = exact(hidden(), LINES)
    np.testing.assert_allclose(log_ratios(h, 1000.0 * h), 0.0, atol=1e-9)


def test_correlated_lines_count_once():
    """Of an autoregressive error of coefficient a, (1 - a)/(1 + a) of the lines count."""
    rng = np.random.default_rng(0)
    white = rng.standard_normal((40, 2000))
    assert independent_lines(white) == pytest.approx(2000, rel=0.1)
    a, e = 0.9, np.zeros((40, 2000))
    e[:, 0] = white[:, 0]
    for i in range(1, 2000):
        e[:, i] = a * e[:, i - 1] + np.sqrt(1 - a**2) * white[:, i]
    assert independent_lines(e) == pytest.approx(2000 * (1 - a) / (1 + a), rel=0.15)


def test_modes_that_nobody_measured_are_damped_as_the_others_are():
    out = ratios_of(np.array([0.01, np.nan, 0.04]), np.array([2, 0, 1]), 4)
    np.testing.assert_allclose(out, [0.02, 0.04, 0.01, 0.02])


def listening(truth, noise=0.05):
    """A search on the string that hears responses, and the fit of its tension alone."""
    s = searcher(truth, modes_out=(4, 10))
    null = s.null()
    r = responses(truth, LINES, noise=noise)
    z = np.full(12, ZETA)
    reference = turned_state(s.problem, null, z)
    h = heard(r, s.problem.whole.frequencies_hz, z, np.zeros((len(SEEN), len(DRIVEN))), reference)
    return replace(s, problem=replace(s.problem, heard=h)), null


def test_the_right_place_is_heard_and_a_wrong_one_is_not():
    s, null = listening(hidden(masses=[(7, 2.0)]))
    right, wrong = (
        fit(s.problem, null.nuisance, (Suspect(0, bead, (0.7,)),), (0,), 20) for bead in (7, 19)
    )
    heard_right, heard_wrong, heard_null = (
        misfit_of_responses(s.problem, f) for f in (right, wrong, null)
    )
    assert heard_right < min(heard_wrong, heard_null) - 10.0
    deaf = replace(s, problem=replace(s.problem, heard=None))
    assert misfit_of_responses(deaf.problem, right) == 0.0
    alike = {"judged": lambda *_: Some(evidence=0.0)}
    by_modes = [scored(replace(deaf, **alike), f).score for f in (right, wrong)]
    by_both = [scored(replace(s, **alike), f).score for f in (right, wrong)]
    assert by_modes[0] == pytest.approx(by_modes[1])
    assert by_both[0] > by_both[1] + 5.0


def test_responses_of_a_string_that_lacks_nothing_name_nothing():
    s, null = listening(hidden())
    light = fit(s.problem, null.nuisance, (Suspect(0, 7, (-3.0,)),), (0,), 20)
    assert chosen(s, Found((null, light), ((), ()))) == 0
    gained = misfit_of_responses(s.problem, null) - misfit_of_responses(s.problem, light)
    assert abs(gained) < 10.0
