"""Several configurations with one parameter set, on chains whose answer is known."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
import scipy.sparse as sp
from tests.core.updating.spring_chain import HALVES, N, chain, measured

from trueup.core.data.parametric_model import Term
from trueup.core.errors import InputError
from trueup.core.updating.determined import update_determined
from trueup.core.updating.posterior import profile_intervals
from trueup.core.updating.problem import Configuration, Problem
from trueup.core.updating.residuals import Weights
from trueup.core.updating.residuals.known_residuals import residuals_named
from trueup.core.updating.update import Stage, update_configurations


def with_store(model, at=N - 1, mass=3.0):
    """The chain with a mass more, which no parameter moves."""
    more = sp.csr_matrix(([mass], ([at], [at])), (model.n_free,) * 2)
    return replace(model, mass=(*model.mass, Term(more)))


def state(name, model, truth, **given) -> Configuration:
    return Configuration(model, measured(model, truth, **given), n_modes=8, name=name)


def test_two_states_determine_what_one_leaves_open():
    """Of stiffness and mass one test knows the ratio; a known mass beside tells both."""
    clean = chain([range(N), range(N)], ["k", "m"])
    one = state("clean", clean, [1.2, 0.9])
    assert len(update_determined([one], [Stage((0, 1))]).undetermined) == 2
    two = state("store", with_store(clean), [1.2, 0.9])
    done = update_determined([one, two], [Stage((0, 1))])
    assert done.undetermined == ()
    np.testing.assert_allclose(done.factors, [1.2, 0.9], rtol=1e-3)
    assert len(done.after.states) == 2
    assert done.eigensolutions % 2 == 0
    assert done.history[0].deviations_percent.shape == (12,)


def test_a_parameter_of_one_configuration_moves_by_its_test_alone():
    clean = chain(HALVES)
    loaded = chain([range(4, 8), [7], range(4)], ["k", "m", "k"])
    names = ("k1", "store", "k0")
    own = tuple(replace(q, name=n) for q, n in zip(loaded.parameters, names, strict=True))
    loaded = replace(loaded, parameters=own)
    every = [state("clean", clean, [1.3, 0.8]), state("store", loaded, [0.8, 1.5, 1.3])]
    problem = Problem.of(every)
    assert [q.name for q in problem.parameters] == ["k0", "k1", "store"]
    assert [p.own.tolist() for p in problem.parts] == [[0, 1], [1, 2, 0]]
    done = update_configurations(every, [Stage((0, 1, 2))])
    np.testing.assert_allclose(done.factors, [1.3, 0.8, 1.5], rtol=1e-3)
    np.testing.assert_allclose(done.after.states[1].factors, [0.8, 1.5, 1.3], rtol=1e-3)
    only = update_configurations(every, [Stage((2,), "frequencies", 3)])
    np.testing.assert_array_equal(only.after.states[0].factors, [1.0, 1.0])


def test_derivatives_stand_below_each_other_in_the_columns_of_their_parameters():
    clean, loaded = chain(HALVES), with_store(chain([range(4, 8)]))
    loaded = replace(loaded, parameters=(replace(loaded.parameters[0], name="k1"),))
    every = [state("clean", clean, [1.1, 0.9]), state("store", loaded, [0.9])]
    problem, residuals = Problem.of(every), residuals_named("both")
    point = problem.at(problem.full, np.ones(2), residuals)
    for one in residuals:
        lin = problem.linearise(problem.full, point, [0, 1], (one,))
        first, second = (
            part.objective.linearise(part.full, s, range(len(part.own)), (one,))
            for part, s in zip(problem.parts, point.states, strict=True)
        )
        n = len(first.values)
        np.testing.assert_allclose(lin.values, np.concatenate([first.values, second.values]))
        np.testing.assert_allclose(lin.gradient[:n], first.gradient, rtol=1e-9)
        np.testing.assert_array_equal(lin.gradient[n:, 0], 0.0)
        np.testing.assert_allclose(lin.gradient[n:, 1:], second.gradient, rtol=1e-9)
    step = 1e-5
    there = problem.at(problem.full, np.array([1.0, 1.0 + step]), residuals[:1])
    ahead = problem.linearise(problem.full, there, [1], residuals[:1])
    here = problem.linearise(problem.full, point, [1], residuals[:1])
    np.testing.assert_allclose(
        (ahead.values - here.values) / step, here.gradient[:, 0], rtol=1e-3, atol=1e-3
    )


def test_the_prior_of_a_shared_parameter_counts_once():
    """Each test is r = (p/1.2 − 1)/2 whatever the mass; the deck's value is known once."""
    light = chain([range(1)], n=1)
    weights = Weights({"frequency_sigma": 0.02, "prior_sigma": 0.05}, 0.0)
    every = [
        Configuration(m, measured(m, [1.2], slice(0, 1)), weights=weights, n_modes=1)
        for m in (light, with_store(light, 0))
    ]
    stage = Stage((0,), "frequencies, prior", 30)
    done = update_configurations(every, [stage], tolerance=1e-9)
    by_test, by_prior = 2.0 / (2.0 * 0.02 * 1.2) ** 2, 1.0 / 0.05**2
    mean = (1.2 * by_test + by_prior) / (by_test + by_prior)
    assert done.factors[0] == pytest.approx(mean, rel=1e-9)
    deviation = (by_test + by_prior) ** -0.5
    assert done.standard_error[0] == pytest.approx(deviation, rel=1e-9)
    ends = mean + np.sqrt(3.84) * deviation * np.array([-1.0, 1.0])
    np.testing.assert_allclose(profile_intervals(every, stage, done)[0], ends, rtol=1e-4)


def test_one_name_for_two_values_is_refused():
    clean = chain(HALVES)
    other = replace(
        clean, parameters=(replace(clean.parameters[0], deck_values=(1.1,)), clean.parameters[1])
    )
    every = [state("clean", clean, [1.0, 1.0]), state("store", other, [1.0, 1.0])]
    with pytest.raises(InputError, match=r"'k0': k is 1 in configuration 'clean' and 1.1 in 'sto"):
        Problem.of(every)


def test_a_configuration_that_pairs_with_nothing_is_named():
    clean = chain(HALVES)
    far = state("store", with_store(clean), [1.0, 1.0])
    far = replace(far, target=replace(far.target, frequencies_hz=50.0 * far.target.frequencies_hz))
    with pytest.raises(InputError, match="configuration 'store': no test mode pairs"):
        update_configurations([state("clean", clean, [1.1, 0.9]), far], [Stage((0, 1))])
