"""What a test does not determine stays as it is, and what it can say is known before a step."""

from __future__ import annotations

import re
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, strategies as st
from tests.core.chains import proportional
from tests.core.updating.spring_chain import HALVES, N, chain, measured

from trueup.core.data.parameter import Parameter
from trueup.core.updating import determined
from trueup.core.updating.determined import made_up, put_back, update_determined
from trueup.core.updating.identifiability import identifiability, unsure
from trueup.core.updating.problem import Configuration
from trueup.core.updating.residuals import Beside, Relation
from trueup.core.updating.stages import Reason
from trueup.core.updating.update import Stage, update_configurations


def test_of_stiffness_and_mass_in_common_none_moves_and_the_ratio_is_said():
    """Frequencies know the ratio alone: 1.2 by the stiffness or 1/1.2 by the mass."""
    model = chain([range(N), range(N)], ["k", "m"])
    target = measured(model, [1.2, 1.0], noise=1e-4)
    done = update_determined([Configuration(model, target, n_modes=8)], [Stage((0, 1))])
    assert done.factors.tolist() == [1.0, 1.0]
    assert done.undetermined == (0, 1)
    assert np.isnan(done.standard_error).all()
    (said,) = (w for w in done.warnings if "known together" in w)
    exponents = [float(e or 1.0) for e in re.findall(r"[km]\d(?:\^(-?[\d.]+))?", said)]
    assert exponents == [1.0, -1.0]
    factor = float(re.search(r"factor ([\d.]+) ±", said)[1])
    assert max(factor, 1.0 / factor) == pytest.approx(1.2, rel=1e-3)
    assert any("k0 and m1 stay as in the deck" in w for w in done.warnings)


def test_what_is_known_by_itself_is_not_led_astray_by_what_is_not():
    """Of k0 and q the product is known: one stands for it while k1 is found, then is put back."""
    one, stage, _ = _of_three((1.2, 0.9, 1.1))
    done = update_determined([one], [stage])
    assert len(done.combined) == 1
    assert done.factors[0] * done.factors[2] == pytest.approx(1.32, rel=1e-3)
    found = put_back([one], stage, done)
    assert found.factors[[0, 2]].tolist() == [1.0, 1.0]
    assert found.factors[1] == done.factors[1] == pytest.approx(0.9, rel=1e-3)
    assert np.isnan(found.standard_error).tolist() == [True, False, True]
    assert found.undetermined == (0, 2)
    assert found.after.objective > done.after.objective
    np.testing.assert_array_equal(found.after.factors, found.factors)
    assert put_back([one], stage, found) is found


def _of_three(truth: tuple[float, float, float]):
    """Of k0 and q the product is known, k1 by itself."""
    model = chain(HALVES)
    first, *others = model.stiffness
    both = replace(first, factors=(*first.factors, proportional(2, 0.1, 10)))
    more = Parameter("q", ("q",), (1.0,))
    model = replace(model, stiffness=(both, *others), parameters=(*model.parameters, more))
    one = Configuration(model, measured(model, truth, noise=1e-4), n_modes=8)
    stage = Stage((0, 1, 2), "frequencies", 30)
    return one, stage, put_back([one], stage, update_determined([one], [stage]))


def test_a_deck_that_is_worse_with_what_was_put_back_is_fitted_beside_it():
    """k0·q is 1.15, k1 0.9; with k0·q at 1 a k1 of 0.9 is farther from the test than 1."""
    one, stage, put = _of_three((1.15, 0.9, 1.0))
    done = made_up([one], [stage], put)
    assert put.factors[1] == pytest.approx(0.9, rel=2e-3)
    assert put.after.objective > put.before.objective
    held = update_configurations([one], [replace(stage, parameters=(1,))])
    assert done.factors.tolist() == [1.0, pytest.approx(held.factors[1], rel=1e-3), 1.0]
    astray = np.hypot(held.standard_error[1], held.factors[1] - put.factors[1])
    assert done.standard_error[1] == pytest.approx(astray, rel=1e-3)
    assert done.after.objective == pytest.approx(held.after.objective, rel=1e-4)
    assert done.after.objective < done.before.objective
    assert done.undetermined == (0, 2)
    (said,) = (w for w in done.warnings if "fitted anew" in w)
    assert re.search(r"k1 1\.0\d+ \(with all moving 0\.(8999|9)", said)
    assert not any(w.endswith("farther from the test than it came") for w in done.warnings)


def test_a_deck_that_is_no_worse_keeps_what_is_known_with_all_moving():
    one, stage, put = _of_three((1.02, 0.7, 1.0))
    assert put.after.objective < put.before.objective
    assert made_up([one], [stage], put) is put
    assert put.factors[1] == pytest.approx(0.7, rel=2e-3)


def test_what_is_determined_moves_as_ever():
    model = chain(HALVES)
    done = update_determined(
        [Configuration(model, measured(model, [1.2, 0.9]), n_modes=8)], [Stage((0, 1))]
    )
    assert done.undetermined == ()
    assert done.factors == pytest.approx([1.2, 0.9], rel=1e-3)


def test_where_nothing_is_determined_nothing_moves():
    model = chain([[], []])
    done = update_determined(
        [Configuration(model, measured(model, [1.0, 1.0]), n_modes=8)], [Stage((0, 1))]
    )
    assert done.factors.tolist() == [1.0, 1.0]
    assert done.undetermined == (0, 1)
    assert done.stopped.reason is Reason.NOTHING_DETERMINED


def test_orthogonal_parameters_have_the_errors_they_have_alone():
    G = np.diag([4.0, 10.0, 0.5])
    said = identifiability(G, 1.0, 0.5)
    np.testing.assert_allclose(said.standard_error, [0.25, 0.1, 2.0])
    np.testing.assert_allclose(said.standard_error, said.alone)
    assert said.determined == (1, 0)
    np.testing.assert_allclose(said.correlation, np.eye(3))


def test_standard_errors_are_those_of_least_squares():
    G = np.random.default_rng(1).standard_normal((12, 4))
    said = identifiability(G, 0.3, 1.0)
    np.testing.assert_allclose(said.standard_error**2, 0.3 * np.linalg.inv(G.T @ G).diagonal())
    assert sorted(said.determined) == [0, 1, 2, 3]


@given(st.integers(0, 10_000), st.floats(0.2, 5.0))
def test_of_two_that_do_the_same_one_is_determined(seed, ratio):
    g = np.random.default_rng(seed).standard_normal((9, 3))
    said = identifiability(np.column_stack([g, ratio * g[:, 1]]), 1e-6, 0.5)
    assert len({1, 3} & {*said.determined}) == 1
    assert {0, 2} < {*said.determined}
    assert np.isnan(said.standard_error[[1, 3]]).all()
    assert said.correlation[1, 3] == pytest.approx(1.0)


def test_fewer_residuals_than_parameters_determine_as_many():
    said = identifiability(np.random.default_rng(2).standard_normal((2, 5)), 1e-6, 0.5)
    assert len(said.determined) == 2
    assert said.unseen.shape == (3, 5)


def _stiff_to_ground(factor: float, noise: float, **limits: float):
    """A spring to ground that hardly matters once it is stiff, and the other springs, at 1.1."""
    model = chain([[0], range(1, N)], **limits)
    one = Configuration(model, measured(model, [factor, 1.1], noise=noise, seed=1), n_modes=8)
    stage = Stage((0, 1), "frequencies", 40)
    return put_back([one], stage, update_determined([one], [stage]))


def test_what_the_deck_has_wrong_moves_however_large_its_error():
    done = _stiff_to_ground(6.0, 0.005, upper=9.0)
    assert done.undetermined == ()
    assert done.standard_error[0] > 0.3 * done.factors[0]
    assert (np.abs(done.factors - [6.0, 1.1]) < done.standard_error).all()


def test_what_stays_as_in_the_deck_does_not_lead_the_others_astray():
    """The spring's own value is open; held to the deck's, a sixth, the others would be 1.26."""
    done = _stiff_to_ground(6.0, 0.01)
    assert done.factors[0] == 1.0
    assert done.undetermined == (0,)
    assert abs(done.factors[1] - 1.1) < done.standard_error[1] < 0.04
    assert sum("k0 stays as in the deck" in w for w in done.warnings) == 1


def test_what_ended_worse_with_more_parameters_is_not_taken(monkeypatch):
    """As where modes were lost on the way: what was found without the others is better."""

    def worse(configurations, stages, **more):
        done = update_configurations(configurations, stages, **more)
        lost = replace(done.after, objective=1e6)
        return replace(done, after=lost) if len(stages[0].parameters) > 1 else done

    monkeypatch.setattr(determined, "update_configurations", worse)
    assert _stiff_to_ground(6.0, 0.01).factors[1] == pytest.approx(1.264, abs=1e-3)


def test_the_error_from_which_on_a_value_is_open():
    assert unsure(np.array([1.0, 1.5, np.e**3, np.e**-3])) == pytest.approx(
        [0.2, 0.3, np.e**3, np.e**-3]
    )


def test_a_stage_before_the_last_determines_what_it_moved_last():
    """Mass by what is said of it, then stiffness by frequencies, which know their ratio alone."""
    model = chain([range(N), range(N)], ["k", "m"])
    said = Relation(np.array([0.0, 1.0]), np.zeros(2), 0.9, 0.009)
    target = replace(measured(model, [1.2, 0.9], noise=1e-3), beside=Beside(relations=(said,)))
    stages = [Stage((1,), "relations"), Stage((0,), "frequencies")]
    done = update_determined([Configuration(model, target, n_modes=8)], stages)
    assert done.undetermined == done.combined == ()
    assert done.factors == pytest.approx([1.2, 0.9], rel=5e-3)
    assert done.standard_error == pytest.approx([0.012, 0.009], rel=0.02)
