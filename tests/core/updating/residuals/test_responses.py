"""Frequency responses and antiresonances: closed forms, finite differences, updates by them."""

from dataclasses import replace

import numpy as np
import pytest
import scipy.sparse as sp
from tests.core.reduction.test_damped_poles import damped
from tests.core.updating.spring_chain import HALVES, chain, measured

from trueup.core.eigen.normal_modes import solve
from trueup.core.errors import InputError
from trueup.core.reduction.damped_poles import Damped
from trueup.core.reduction.full_or_reduced import FullOrder, reduce_around
from trueup.core.reduction.responses import Responding
from trueup.core.updating.residuals import Responses
from trueup.core.updating.residuals.antiresonances import antiresonances
from trueup.core.updating.update import Stage, update

N = 8
DRIVE = sp.identity(N, format="csr")[[7]]
SENSORS = sp.identity(N, format="csr")
OMEGA = np.linspace(3.0, 120.0, 25)
P = np.array([1.1, 0.8, 1.5, 0.7, 1.2])


def some():
    return damped(chain(HALVES), [(7, 4.0)], h=[0.05, 0.02])


def direct(model, p, omega, ratio=0.01):
    """Receptances by the matrices themselves, (n_line, n, n)."""
    K, M, D, H = (getattr(model, x)(p).toarray() for x in "KMDH")
    H = H if model.damping or model.loss else 2.0 * ratio * K
    return np.array([np.linalg.inv(K + 1j * (H + w * D) - w**2 * M) for w in omega])


def at(model, p, reduced, n_modes=N, around=None):
    order = FullOrder(model, SENSORS, n_modes, DRIVE)
    if reduced:
        q = p if around is None else around
        order = reduce_around(order, q, order.solve(q), range(len(p)))
    return Responding(Damped(order, p, order.solve(p)), 0.01)


@pytest.mark.parametrize("model", [some(), chain(HALVES)], ids=["damped", "one ratio"])
@pytest.mark.parametrize("reduced", [False, True])
def test_responses_and_their_slopes_are_those_of_the_matrices(model, reduced):
    p = P[: len(model.parameters)]
    here = at(model, p, reduced)
    C, B = here.rows(SENSORS), here.rows(DRIVE)
    H = here.responses(C, B, OMEGA)
    np.testing.assert_allclose(H, direct(model, p, OMEGA)[:, :, [7]], rtol=1e-6)
    slopes, step = here.slopes(C, B, OMEGA, range(len(p))), 1e-6
    for k, e in enumerate(np.eye(len(p)) * step):
        ahead, behind = (direct(model, q, OMEGA)[:, :, [7]] for q in (p + e, p - e))
        change = (ahead - behind) / (2.0 * step)
        np.testing.assert_allclose(slopes[..., k], change, atol=1e-4 * np.abs(change).max())


def test_what_a_few_modes_lack_is_static_and_in_the_basis():
    """Three of 8 modes and the answer to the force: right below the second, not without."""
    model, p = chain(HALVES), P[:2]
    omega = np.linspace(2.0, 12.0, 10)
    exact = direct(model, p, omega)[:, :, [7]]
    errors = []
    for forces in (DRIVE, None):
        order = FullOrder(model, SENSORS, 3, forces)
        here = Responding(Damped(order, p, order.solve(p)), 0.01)
        H = here.responses(here.rows(SENSORS), here.rows(DRIVE), omega)
        errors.append(np.abs(H[:, 7] - exact[:, 7]).max() / np.abs(exact[:, 7]).max())
    assert errors[0] < 1e-3
    assert errors[0] < 0.2 * errors[1]


@pytest.mark.parametrize("reduced", [False, True])
def test_antiresonances_are_frequencies_of_the_structure_held_there(reduced):
    model, p = chain(HALVES), P[:2]
    K, M = model.K(p).toarray()[:7, :7], model.M(p).toarray()[:7, :7]
    here = at(model, p, reduced)
    zeros, motions = here.antiresonances(here.rows(DRIVE)[0])
    np.testing.assert_allclose(zeros, np.linalg.eigvals(np.linalg.inv(M) @ K)[
        np.argsort(np.linalg.eigvals(np.linalg.inv(M) @ K).real)].real, rtol=1e-9)  # fmt: skip
    slopes, step = here.antiresonance_slopes(zeros, motions, (0, 1)), 1e-6
    for k, e in enumerate(np.eye(2) * step):
        ahead, behind = (
            at(model, q, False).antiresonances(at(model, q, False).rows(DRIVE)[0])[0]
            for q in (p + e, p - e)
        )
        np.testing.assert_allclose(slopes[:, k], (ahead - behind) / (2 * step), rtol=1e-5)


def test_dips_are_found_between_the_lines():
    """Zeros of ((19.7 Hz)² − f²)((41.2 Hz)² − f²) over three poles, at lines of 0.5 Hz."""
    f = np.arange(2.0, 60.0, 0.5)
    poles = [(p**2 - f**2 + 2j * 0.005 * p * f) for p in (10.0, 30.0, 50.0)]
    H = np.prod([z**2 - f**2 + 2j * 0.005 * z * f for z in (19.7, 41.2)], axis=0)
    H = H / np.prod(poles, axis=0)
    np.testing.assert_allclose(antiresonances(f, H), [19.7, 41.2], atol=0.005)
    H[5] = np.nan
    np.testing.assert_allclose(antiresonances(f, H), [19.7, 41.2], atol=0.005)


def heard(model, truth, rows=range(N), gain=1.0):
    """A test with accelerances of some masses under a force at the last."""
    target = measured(model, truth)
    top = 2.0 * np.pi * 1.1 * target.frequencies_hz.max()
    omega = np.linspace(0.05 * top, top, 800)
    H = gain * direct(model, np.array(truth), omega)[:, list(rows), 7] * (1j * omega[:, None]) ** 2
    points = tuple((k, 0) for k, row in enumerate(rows) if row == 7)
    responses = Responses(
        omega / (2 * np.pi), H.T[:, None, :], 2, SENSORS[list(rows)], DRIVE, points
    )
    return replace(target, responses=responses)


def test_stiffness_and_damping_are_found_by_responses():
    model, truth = some(), np.array([1.2, 0.9, 1.6, 0.5, 1.4])
    target = heard(model, truth, gain=1e3)
    stages = [Stage((0, 1), "frequencies", 20), Stage((0, 1, 2, 3, 4), "frequencies, frfs", 30)]
    done = update(model, target, stages, n_modes=N, tolerance=1e-7)
    np.testing.assert_allclose(done.factors, truth, rtol=1e-5)


def test_antiresonances_alone_find_three_springs():
    model = chain(([0], [1], [2, 3, 4, 5, 6, 7]))
    truth = [1.3, 0.8, 1.1]
    target = heard(model, truth, rows=[7])
    only = update(model, target, [Stage((0, 1, 2), "antiresonances", 30)], n_modes=N,
                  tolerance=1e-7)  # fmt: skip
    np.testing.assert_allclose(only.factors, truth, rtol=1e-3)


@pytest.mark.parametrize(
    ("residual", "change", "says"),
    [
        ("frfs", {"responses": None}, "'frfs' needs frequency responses"),
        ("antiresonances", {"responses": None}, "'antiresonances' needs frequency responses"),
    ],
)
def test_what_was_not_measured_is_asked_for(residual, change, says):
    model = chain(HALVES)
    target = replace(heard(model, [1.0, 1.0]), **change)
    with pytest.raises(InputError, match=says):
        update(model, target, [Stage((0,), residual)], n_modes=N)


def test_a_driving_point_is_needed_and_lines_near_the_pairs():
    model = chain(HALVES)
    target = heard(model, [1.1, 0.9], rows=[0, 3])
    with pytest.raises(InputError, match="needs a driving point"):
        update(model, target, [Stage((0,), "antiresonances")], n_modes=N)
    far = replace(target.responses, frequencies_hz=target.responses.frequencies_hz + 1e3)
    with pytest.raises(InputError, match="no line of the responses"):
        update(model, replace(target, responses=far), [Stage((0,), "frfs")], n_modes=N)


def test_the_poles_are_left_alone_by_the_basis():
    """The static answers to forces are no modes of the model."""
    model, p = chain(HALVES), P[:2]
    order = FullOrder(model, SENSORS, 5, DRIVE)
    near = reduce_around(order, p, order.solve(p), (0, 1))
    own = solve(model, n_modes=5, p=p).eigenvalues
    np.testing.assert_allclose(near.solve(p).eigenvalues, own, rtol=1e-9)
