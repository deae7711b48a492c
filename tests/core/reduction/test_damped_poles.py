"""Poles of damped models: closed forms, finite differences, full and reduced alike."""

from dataclasses import replace

import numpy as np
import pytest
import scipy.sparse as sp
from tests.core.chains import proportional
from tests.core.updating.spring_chain import HALVES, chain

from trueup.core.data.parametric_model import Term
from trueup.core.reduction.damped_poles import Damped, ratio_slopes, ratios
from trueup.core.reduction.full_or_reduced import FullOrder, reduce_around


def full(model):
    return FullOrder(model, sp.identity(model.n_free, format="csr"), model.n_free)


def at(order, p):
    p = np.array(p, float)
    return Damped(order, p, order.solve(p))


def damped(model, c=(), h=()):
    """A dashpot of damping c from mass i to ground, each of a parameter behind the others'."""
    n, count = model.n_free, len(model.parameters)

    def at_mass(i, value):
        return sp.csr_matrix(([value], ([i], [i])), (n, n))

    D = tuple(Term(at_mass(i, v), (proportional(count + k, 0.1, 10),))
              for k, (i, v) in enumerate(c))  # fmt: skip
    H = tuple(Term(t.matrix * v, (*t.factors, proportional(count + len(c) + k, 0.1, 10)))
              for k, (t, v) in enumerate(zip(model.stiffness, h, strict=False)))  # fmt: skip
    own = [replace(model.parameters[0], name=f"d{k}") for k in range(len(c) + len(h))]
    return replace(model, damping=D, loss=H, parameters=(*model.parameters, *own))


def test_one_mass_on_a_dashpot():
    """s² m + s c + k = 0 with m = 2, k = 1e4."""
    model = damped(chain([range(1)], n=1), [(0, 30.0)])
    (s,) = at(full(model), [1.0, 2.0]).poles(np.eye(1))
    w, zeta = np.sqrt(5e3), 60.0 / (2.0 * np.sqrt(2e4))
    assert s == pytest.approx(w * (-zeta + 1j * np.sqrt(1.0 - zeta**2)))
    assert ratios(np.array([s]))[0] == pytest.approx(zeta)


@pytest.mark.parametrize("g", [0.02, 0.6])
def test_one_mass_on_a_spring_with_loss(g):
    """s² = −ω² (1 + ig)."""
    model = damped(chain([range(1)], n=1), h=[g])
    found = ratios(at(full(model), [1.3, 1.0]).poles(np.eye(1)))
    assert found[0] == pytest.approx(np.sin(np.arctan(g) / 2.0))


def test_more_than_critical_is_one():
    model = damped(chain([range(1)], n=1), [(0, 1e3)])
    found = at(full(model), [1.0, 1.0])
    assert ratios(found.poles(np.eye(1))) == pytest.approx([1.0])
    assert not found.slopes(np.eye(1), (1,)).any()


def some(n=8):
    return damped(chain(HALVES), [(7, 40.0), (2, 90.0)], h=[0.05, 0.02])


def test_poles_of_many_are_those_of_the_matrices():
    model, p = some(), np.array([1.1, 0.8, 1.5, 0.7, 1.2, 0.9])
    K, M, D, H = (getattr(model, x)(p).toarray() for x in "KMDH")
    n, inverse = len(K), np.linalg.inv(M)
    A = np.block([[np.zeros((n, n)), np.eye(n)], [-inverse @ (K + 1j * H), -inverse @ D]])
    known = np.linalg.eigvals(A)
    known = known[known.imag > 0.0]
    found = at(full(model), p).poles(np.eye(n))
    np.testing.assert_allclose(found, known[np.argsort(known.imag)], rtol=1e-9)


@pytest.mark.parametrize("reduced", [False, True])
def test_slopes_are_those_of_the_poles(reduced):
    model, p, step = some(), np.array([1.1, 0.8, 1.5, 0.7, 1.2, 0.9]), 1e-5
    order = full(model)
    if reduced:
        order = reduce_around(order, p, order.solve(p), range(6))
    T = np.eye(8)[:, [3, 0, 5]]
    here = at(order, p)
    slopes = here.slopes(T, range(6))
    zetas = ratio_slopes(here.poles(T), slopes)
    for k, e in enumerate(np.eye(6) * step):
        ahead, behind = (at(order, q).poles(T) for q in (p + e, p - e))
        np.testing.assert_allclose(slopes[:, k], (ahead - behind) / (2 * step), atol=1e-5)
        change = (ratios(ahead) - ratios(behind)) / (2 * step)
        np.testing.assert_allclose(zetas[:, k], change, atol=1e-8)
    np.testing.assert_allclose(here.poles(T), at(full(model), p).poles(T), rtol=1e-9)
