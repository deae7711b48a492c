"""Updating: known changes are recovered, and everything the update says of itself is true."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
import scipy.sparse as sp
from tests.core.chains import proportional
from tests.core.updating.spring_chain import HALVES, N, chain, measured

from trueup.core.correlation.criteria import Criteria
from trueup.core.data.parametric_model import Term
from trueup.core.eigen.normal_modes import solve
from trueup.core.errors import InputError
from trueup.core.reduction import full_or_reduced
from trueup.core.updating import objective
from trueup.core.updating.posterior import profile_intervals
from trueup.core.updating.problem import Problem
from trueup.core.updating.residuals import Beside, Relation, Weights
from trueup.core.updating.residuals.shapes import SHAPES
from trueup.core.updating.update import Configuration, Reason, Stage, update
from trueup.core.updating.updating_numbers import UPDATING


@pytest.mark.parametrize("residuals", ["frequencies", "shapes", "both"])
def test_changed_springs_are_found_again(residuals):
    model, truth = chain(HALVES), [1.3, 0.8]
    if residuals == "shapes":  # shapes say nothing of the common scale
        model, truth = chain(HALVES[:1]), [1.3]
    stage = Stage(tuple(range(len(truth))), residuals, 12)
    done = update(model, measured(model, truth), [stage], n_modes=8, tolerance=1e-6)
    np.testing.assert_allclose(done.factors, truth, rtol=1e-5)
    assert done.after.objective < 1e-6
    assert done.warnings == ()


def test_about_five_iterations_are_enough():
    model, truth = chain(HALVES), [1.4, 0.75]
    done = update(model, measured(model, truth), [Stage((0, 1))], n_modes=8)
    assert len(done.history) - 1 <= 5
    np.testing.assert_allclose(done.factors, truth, rtol=1e-3)
    assert done.stopped.reason is Reason.SETTLED
    assert str(done.stopped) == "factors moved less than 0.001"


def test_a_ring_of_repeated_modes_is_updated_through_its_clusters(ring):
    """All pairs of the deck are repeated; in the test sectors differ, which splits and turns
    them."""
    n = 20
    model = ring(n, parameters=[("E", [0, 1, 2, 9, 10]), ("rho", [4, 5, 6])])
    truth = [1.25, 1.3]
    target = measured(model, truth, slice(6, 18))
    start = solve(model, n_modes=20)
    elastic = start.eigenvalues[6:18].reshape(-1, 2)
    assert (elastic[:, 1] / elastic[:, 0] - 1.0 < 1e-8).all()
    done = update(model, target, [Stage((0, 1))], Criteria(cluster_width=0.02), n_modes=24,
                  tolerance=1e-5)  # fmt: skip
    np.testing.assert_allclose(done.factors, truth, rtol=1e-3)
    assert len(done.after.correlation.pairs) == 12


@pytest.mark.parametrize("rotate", ["analysis", "test"])
def test_either_side_may_be_turned(ring, rotate):
    """Deck and test are perfect rings; the test's shapes were spun within their pairs."""
    n = 20
    model = ring(n, parameters=[("E", range(n))])
    target = measured(model, [1.1], slice(6, 18))
    c, s = np.cos(0.7), np.sin(0.7)
    spun = target.shapes / np.linalg.norm(target.shapes, axis=0)
    spun = spun @ np.kron(np.eye(6), [[c, -s], [s, c]])
    done = update(model, replace(target, shapes=spun), [Stage((0,))], Criteria(rotate=rotate),
                  n_modes=24, tolerance=1e-6)  # fmt: skip
    assert done.factors[0] == pytest.approx(1.1, rel=1e-4)
    assert len(done.after.correlation.pairs) == 12
    assert done.after.objective < 1e-4


@pytest.mark.parametrize("weight", [1.0, 4.0])
@pytest.mark.parametrize("regularisation", [0.0, 100.0, 1e4])
def test_one_step_of_one_spring_is_that_of_equation_four(regularisation, weight):
    """λ = p k/m against λ_t = p_t k/m: g = 1/(2σ p_t), r = g (p − p_t), Δp = −g r/(g² + w)."""
    model = chain([range(1)], n=1)
    model = replace(model, parameters=(replace(model.parameters[0], weight=weight),))
    target, p_t, sigma = measured(model, [1.2], slice(0, 1)), 1.2, 0.02
    done = update(model, target, [Stage((0,), "frequencies", 1)], n_modes=1,
                  weights=Weights({"frequency_sigma": sigma}, regularisation))  # fmt: skip
    g = 1.0 / (2.0 * sigma * p_t)
    step = g**2 * (p_t - 1.0) / (g**2 + regularisation * weight)
    assert done.factors[0] == pytest.approx(1.0 + step, rel=1e-6)
    assert done.history[0].objective == pytest.approx((g * (1.0 - p_t)) ** 2, rel=1e-9)


def test_regularisation_damps_the_steps_not_the_answer():
    model, truth = chain(HALVES), [1.3, 0.8]
    done = update(model, measured(model, truth), [Stage((0, 1), "both", 60)], n_modes=8,
                  weights=Weights(regularisation=2000.0), tolerance=1e-7)  # fmt: skip
    np.testing.assert_allclose(done.factors, truth, rtol=1e-4)


def test_what_the_test_hardly_determines_hardly_moves_in_a_step():
    """The last spring strains little; scatter of 3 % would drive a step far, and nowhere."""
    model, weights = chain([range(7), [7]]), Weights(regularisation=0.0)
    target = measured(model, [1.2, 1.0], slice(0, 3), noise=0.03, seed=3)
    once, done = (
        update(model, target, [Stage((0, 1), "frequencies", k)], weights=weights, n_modes=8)
        for k in (1, 30)
    )
    moved, error = once.factors - 1.0, done.standard_error
    assert error[0] < 0.25 < 0.75 < error[1]
    assert moved[0] == pytest.approx(done.factors[0] - 1.0, abs=error[0] / 4)
    assert abs(moved[1]) < error[1] / 20


def test_nothing_holds_a_step_where_residuals_vanish():
    model = chain([range(7), [7]])
    target = measured(model, [1.2, 1.7], slice(0, 4))
    done = update(model, target, [Stage((0, 1), "frequencies")], n_modes=8, tolerance=1e-6)
    assert len(done.history) - 1 <= 6
    np.testing.assert_allclose(done.factors, [1.2, 1.7], rtol=1e-5)


def test_a_factor_stays_within_its_bounds_and_says_so():
    model = chain(HALVES)
    tight, free = model.parameters
    model = replace(model, parameters=(replace(tight, lower=0.9, upper=1.1), free))
    done = update(model, measured(model, [1.3, 1.0]), [Stage((0, 1))], n_modes=8)
    assert done.factors[0] == pytest.approx(1.1, abs=1e-12)
    assert done.at_bound.tolist() == [True, False]
    assert all(0.9 <= h.factors[0] <= 1.1 for h in done.history)


def test_stages_move_their_own_parameters_in_order():
    model, truth = chain(HALVES), [1.3, 0.8]
    seen = []
    done = update(
        model, measured(model, truth), [Stage((1,), "shapes", 3), Stage((0,), "frequencies", 4)],
        n_modes=8, progress=seen.append,
    )  # fmt: skip
    assert tuple(seen) == done.history
    assert [h.iteration for h in done.history] == list(range(len(seen)))
    assert {h.stage for h in done.history} == {1, 2}
    first = [h for h in done.history if h.stage == 1]
    assert all(h.factors[0] == 1.0 for h in first)
    assert all(h.factors[1] == first[-1].factors[1] for h in done.history if h.stage == 2)
    assert done.factors[0] != 1.0


def test_a_pair_lost_at_the_mac_limit_does_not_stop_the_others(monkeypatch):
    """One test shape loses its partner as soon as the factor moves: the rest is followed still,
    and the loss is told."""
    model = chain([range(N)])
    target = measured(model, [1.5])
    true_correlate = objective.correlate

    def gated(hz, shapes, test_hz, test_shapes, criteria, rigid):
        found = true_correlate(hz, shapes, test_hz, test_shapes, criteria, rigid)
        if hz[0] > 1.02 * start:
            kept = tuple(q for q in found.pairs if q.test != 3)
            found = replace(found, pairs=kept, unpaired_test=(3,))
        return found

    start = np.sqrt(solve(model, n_modes=1).eigenvalues[0]) / (2.0 * np.pi)
    monkeypatch.setattr(objective, "correlate", gated)
    done = update(model, target, [Stage((0,), "frequencies", 20)], n_modes=8, tolerance=1e-6)
    assert done.factors[0] == pytest.approx(1.5, rel=1e-4)
    assert any("test mode 4 paired with the model as given" in w for w in done.warnings)


def test_what_ends_farther_from_the_test_than_it_began_is_said():
    """Pairs are lost step by step, each of which is one."""
    model = chain([range(N)])
    problem = Problem.of([Configuration(model, measured(model, [1.0]), n_modes=8)])
    residuals = Stage((0,)).minimised
    near, far = (problem.at(problem.full, np.array([p]), residuals) for p in (1.01, 3.0))
    (said,) = problem.farther(near, far, residuals)
    assert "farther from the test than the given one" in said
    assert problem.farther(far, near, residuals) == ()
    assert problem.farther(near, near, residuals) == ()


def test_an_update_that_has_not_settled_says_so():
    model = chain(HALVES)
    done = update(model, measured(model, [1.3, 0.8]), [Stage((0, 1), "both", 1)], n_modes=8)
    assert done.stopped.reason is Reason.MOST_ITERATIONS
    assert any("had not settled after 1 iterations" in w for w in done.warnings)


def test_parameters_of_one_name_are_refused():
    model = chain(HALVES)
    with pytest.raises(InputError, match="more than one parameter is called 'k0'"):
        replace(model, parameters=(model.parameters[0], model.parameters[0]))


def test_only_the_named_test_modes_count():
    """A test mode that is wrong does not disturb when it is left out."""
    model, truth = chain(HALVES), [1.2, 0.9]
    target = measured(model, truth)
    wrong = replace(target, frequencies_hz=target.frequencies_hz * [1, 1, 1.08, 1, 1, 1])
    kept = replace(wrong, modes=(0, 1, 3, 4, 5))
    off = update(model, wrong, [Stage((0, 1))], n_modes=8, tolerance=1e-6)
    done = update(model, kept, [Stage((0, 1))], n_modes=8, tolerance=1e-6)
    np.testing.assert_allclose(done.factors, truth, rtol=1e-4)
    assert abs(off.factors - truth).max() > 0.01


def test_the_history_is_what_happened():
    model = chain(HALVES)
    target = measured(model, [1.3, 0.8])
    done = update(model, target, [Stage((0, 1))], n_modes=8)
    objectives = [h.objective for h in done.history]
    assert objectives == sorted(objectives, reverse=True)
    assert done.history[0].factors.tolist() == [1.0, 1.0]
    np.testing.assert_array_equal(done.history[-1].factors, done.factors)
    for state, entry in ((done.before, done.history[0]), (done.after, done.history[-1])):
        for p in state.correlation.pairs:
            assert entry.deviations_percent[p.test] == pytest.approx(p.deviation_percent)


def test_every_full_order_solve_is_counted(monkeypatch):
    calls = []

    def counted(*words, **options):
        calls.append(1)
        return solve(*words, **options)

    monkeypatch.setattr(full_or_reduced, "solve", counted)
    model = chain(HALVES)
    done = update(model, measured(model, [1.3, 0.8]), [Stage((0, 1))], n_modes=8)
    assert done.eigensolutions == len(calls)


def test_the_standard_error_is_the_scatter_of_repeated_tests():
    """One factor on every spring: λ ~ p, so n frequencies with noise σ give p within 2σ/√n."""
    model, sigma = chain([range(N)]), 0.004
    runs = [
        update(model, measured(model, [1.1], noise=sigma, seed=s),
               [Stage((0,), "frequencies")], n_modes=8, tolerance=1e-6)
        for s in range(40)
    ]  # fmt: skip
    found = np.array([r.factors[0] for r in runs])
    said = np.array([r.standard_error[0] for r in runs])
    expected = 1.1 * 2.0 * sigma / np.sqrt(6)
    assert np.std(found) == pytest.approx(expected, rel=0.25)
    assert np.sqrt(np.mean(said**2)) == pytest.approx(expected, rel=0.15)


def test_as_many_parameters_as_data_have_the_errors_that_are_stated():
    """Nothing is left of the residuals, which says nothing of how good they are."""
    model = chain([range(N)])
    done = update(
        model, measured(model, [1.1], slice(0, 1)), [Stage((0,), "frequencies")], n_modes=8
    )
    assert done.standard_error == pytest.approx([1.1 * 2.0 * UPDATING.frequency], rel=1e-3)


@pytest.mark.parametrize("noise", [0.0, 1e-3])
def test_what_is_stated_by_itself_is_known_no_better_where_modes_fit_well(noise):
    """Frequencies know the ratio of stiffness and mass, the size only what is said of it."""
    model = chain([range(N), range(N)], ["k", "m"])
    said = Relation(np.array([1.0, 0.0]), np.zeros(2), 1.2, 0.12)
    target = replace(measured(model, [1.2, 1.0], noise=noise), beside=Beside(relations=(said,)))
    stage = Stage((0, 1), "frequencies, relations")
    done = update(model, target, [stage], weights=Weights(regularisation=0.0), n_modes=8)
    assert done.factors == pytest.approx([1.2, 1.0], rel=3e-3)
    assert done.standard_error == pytest.approx([0.12, 0.1], rel=2e-3)
    one = Configuration(model, target, weights=Weights(regularisation=0.0), n_modes=8)
    half = np.diff(profile_intervals([one], stage, done), axis=1)[:, 0] / 2.0
    assert half == pytest.approx(1.96 * done.standard_error, rel=0.05)


def test_what_the_test_cannot_tell_is_said():
    """All stiffness and all mass: their common scale leaves everything the same."""
    model = chain([range(N), range(N)], ["k", "m"])
    done = update(model, measured(model, [1.2, 1.0]), [Stage((0, 1))], n_modes=8)
    assert np.isnan(done.standard_error).all()
    first, second = done.warnings
    assert "does not determine k0 and m1" in first
    assert "known together, not one by one: k0 · m1^-1 (factor 1.2 " in second
    assert done.factors[0] / done.factors[1] == pytest.approx(1.2, rel=1e-3)


def test_a_parameter_without_any_effect_is_said():
    model = chain([range(4), []])
    done = update(model, measured(model, [1.2, 1.0]), [Stage((0, 1))], n_modes=8)
    assert done.factors == pytest.approx([1.2, 1.0], rel=1e-3)
    assert np.isnan(done.standard_error[1])
    assert np.isfinite(done.standard_error[0])
    assert "does not determine k1: a change leaves" in done.warnings[0]


def test_a_parameter_alone_whose_effect_is_rounding_is_said_so_too():
    model = chain([[]])
    lost = Term(1e-12 * sp.identity(N, format="csr"), (proportional(0, 0.1, 10),))
    model = replace(model, stiffness=(*model.stiffness, lost))
    done = update(model, measured(model, [1.0], noise=0.01), [Stage((0,))], n_modes=8)
    assert np.isnan(done.standard_error[0])
    assert "does not determine k0: a change leaves" in done.warnings[0]


def test_parameters_outside_all_stages_keep_the_deck():
    model = chain(HALVES)
    done = update(model, measured(model, [1.2, 1.0]), [Stage((0,))], n_modes=8)
    assert done.factors[1] == 1.0
    assert np.isnan(done.standard_error[1])


@pytest.mark.parametrize("missing", [1, 2])
def test_unmeasured_sensors_do_not_matter(missing):
    model, truth = chain(HALVES), [1.3, 0.8]
    rows = np.arange(0, N, missing)
    sensors = sp.identity(N, format="csr")[rows]
    target = measured(model, truth, slice(0, 3), sensors=sensors)
    done = update(model, target, [Stage((0, 1))], n_modes=8, tolerance=1e-6)
    np.testing.assert_allclose(done.factors, truth, rtol=1e-4)


def test_a_test_that_pairs_with_nothing_is_refused():
    model = chain(HALVES)
    target = measured(model, [1.0, 1.0])
    far = replace(target, frequencies_hz=target.frequencies_hz * 50.0)
    with pytest.raises(InputError, match="no test mode pairs with the model"):
        update(model, far, [Stage((0, 1))], n_modes=8)


def test_stages_that_make_no_sense_are_refused():
    model = chain(HALVES)
    with pytest.raises(InputError, match="names no parameter"):
        Stage(())
    with pytest.raises(InputError, match=r"give one of frequencies, shapes, .*, both"):
        Stage((0,), "everything")
    with pytest.raises(InputError, match="parameter 7 of 2"):
        update(model, measured(model, [1.0, 1.0]), [Stage((7,))], n_modes=8)


def test_a_model_that_fits_stays_as_it_is():
    model = chain(HALVES)
    done = update(model, measured(model, [1.0, 1.0]), [Stage((0, 1))], n_modes=8)
    np.testing.assert_allclose(done.factors, 1.0, atol=1e-9)


@pytest.mark.parametrize("rotate", ["analysis", "test", "none"])
def test_residuals_and_objective_speak_of_the_same_shapes(ring, rotate):
    """The squared residuals of a linearisation add up to the objective of its pairs."""
    model = ring(20, parameters=[("E", [0, 1, 2, 9, 10]), ("rho", [4, 5, 6])])
    target = measured(model, [1.25, 1.3], slice(6, 18))
    full = full_or_reduced.FullOrder(model, target.sensors, 24)
    what = objective.Objective(target, Criteria(rotate=rotate, mac_min=0.3), Weights())
    state = what.at(full, np.ones(2), [SHAPES])
    missing = 12 - len(state.correlation.pairs)
    lin = what.linearise(full, state, [0, 1], [SHAPES])
    assert np.sum(lin.values**2) + missing * 0.7 / 0.1**2 == pytest.approx(state.objective)
