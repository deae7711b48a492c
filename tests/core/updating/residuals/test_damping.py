"""Damping ratios moved to the test's: equation (1c) of the source paper."""

from dataclasses import replace

import numpy as np
import pytest
from tests.core.reduction.test_damped_poles import at, damped, full
from tests.core.updating.spring_chain import HALVES, chain, measured

from trueup.core.correlation.criteria import Criteria
from trueup.core.errors import InputError
from trueup.core.reduction.damped_poles import ratios
from trueup.core.updating.objective import Objective
from trueup.core.updating.residuals import RESIDUALS, Weights
from trueup.core.updating.residuals.damping import DAMPING
from trueup.core.updating.update import Stage, update

TRUTH = np.array([1.2, 0.9, 1.6, 0.5, 1.4])


def case(truth=TRUTH, unknown=()):
    """Two stiffnesses, a dashpot and two loss factors, and a test of 6 of the 8 modes."""
    model = damped(chain(HALVES), [(7, 40.0)], h=[0.05, 0.02])
    zetas = ratios(at(full(model), truth).poles(np.eye(8)))[:6]
    zetas[list(unknown)] = np.nan
    return model, replace(measured(model, truth), damping=zetas)


def test_stiffnesses_dashpots_and_loss_factors_are_found_together():
    model, target = case()
    stage = Stage((0, 1, 2, 3, 4), "frequencies, damping", 20)
    done = update(model, target, [stage], n_modes=8, tolerance=1e-7)
    np.testing.assert_allclose(done.factors, TRUTH, rtol=1e-6)
    assert done.undetermined == ()


def test_a_mode_without_a_ratio_says_nothing():
    model, target = case(unknown=(1, 4))
    done = update(model, target, [Stage((2, 3, 4), "damping", 20)], n_modes=8,
                  tolerance=1e-7, start=np.array([1.2, 0.9, 1.0, 1.0, 1.0]))  # fmt: skip
    np.testing.assert_allclose(done.factors, TRUTH, rtol=1e-6)
    objective = Objective(target, Criteria(), Weights())
    seen = objective.at(full(model), np.array([1.2, 0.9, 1.0, 1.0, 1.0]), (DAMPING,)).seen
    left = DAMPING.value(seen)[:, 0]
    assert not left[[1, 4]].any()
    assert left[[0, 2, 3, 5]].all()


def test_modes_without_a_ratio_make_the_others_scatter_no_less():
    """Standard errors are those of a test that never saw the modes without one."""
    start, stage = np.array([1.2, 0.9, 1.0, 1.0, 1.0]), Stage((2,), "damping", 20)
    model, target = case(unknown=(3, 4, 5))
    found = [
        update(model, t, [stage], n_modes=8, start=start).standard_error[2]
        for t in (target, replace(target, modes=(0, 1, 2)))
    ]
    assert found[0] == pytest.approx(found[1], rel=1e-3)


def test_standard_errors_of_the_ratios_weigh():
    _, target = case()
    target = replace(target, damping_std=0.3 * target.damping)
    own = DAMPING.error(target)
    np.testing.assert_allclose(own, 0.3)
    assert DAMPING.error(replace(target, damping_std=None)) is None


@pytest.mark.parametrize(
    ("change", "says"),
    [
        ({"damping": None}, "the test tells none"),
        ({"damping": np.full(6, np.nan)}, "the test tells none"),
    ],
)
def test_a_test_without_ratios_is_refused(change, says):
    model, target = case()
    with pytest.raises(InputError, match=says):
        update(model, replace(target, **change), [Stage((2,), "damping")], n_modes=8)


def test_a_deck_without_damping_is_refused():
    model, target = case()
    bare = replace(model, damping=(), loss=())
    with pytest.raises(InputError, match="needs a deck with damping"):
        update(bare, target, [Stage((0,), "damping")], n_modes=8)


def test_it_is_known_by_name():
    assert {r.name: r.weight for r in RESIDUALS}["damping"] == "damping_sigma"
