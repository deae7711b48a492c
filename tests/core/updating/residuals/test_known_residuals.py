"""The list of residuals, and one that is added to it from outside the package."""

import numpy as np
import pytest
from tests.core.updating.spring_chain import N, chain, measured

from trueup.core.errors import InputError
from trueup.core.updating.residuals import (
    RESIDUALS,
    Residual,
    Weights,
    register_residual,
    residuals_named,
)
from trueup.core.updating.update import Stage, update

ALL = [range(N), range(N)]
TRUTH = [1.2, 0.9]


@pytest.fixture
def weighing(documented):
    """What docs/extending.md adds, gone again after the test."""
    before = list(RESIDUALS)
    yield documented("A residual")
    RESIDUALS[:] = before


def test_names_are_one_residual_several_or_both():
    assert [r.name for r in residuals_named("both")] == ["frequencies", "shapes"]
    assert [r.name for r in residuals_named("shapes, frequencies")] == ["shapes", "frequencies"]
    assert [r.name for r in residuals_named("both, shapes")] == ["frequencies", "shapes"]
    with pytest.raises(InputError, match="residuals is 'weight'; give one of frequencies, shapes"):
        residuals_named("weight")


def test_a_name_or_key_that_is_taken_is_refused_and_so_is_no_residual():
    with pytest.raises(InputError, match="what is registered is given as int"):
        register_residual(3)
    with pytest.raises(InputError, match="'shapes'"):
        register_residual(RESIDUALS[1])


def test_each_has_its_own_default_and_key(weighing):
    known = Weights({"shape_sigma": 0.2}).all
    assert known["frequency_sigma"] == 0.01
    assert known["shape_sigma"] == 0.2
    assert known["moved_sigma"] == 0.001


def test_a_mass_that_was_weighed_sets_the_scale_that_frequencies_leave_open(weighing):
    model = chain(ALL, ["k", "m"])
    target = measured(model, TRUTH)
    assert weighing["moving_along_x"](model, model.M(np.array(TRUTH))) == pytest.approx(14.4)
    alone = update(model, target, [Stage((0, 1), "frequencies")], n_modes=8)
    both = update(model, target, [Stage((0, 1), "frequencies, moved", 20)], n_modes=8,
                  weights=Weights(regularisation=0.0), tolerance=1e-7)  # fmt: skip
    assert np.isnan(alone.standard_error).all()
    assert abs(alone.factors - TRUTH).max() > 0.05
    np.testing.assert_allclose(both.factors, TRUTH, rtol=1e-6)
    assert np.isfinite(both.standard_error).all()


def test_one_step_of_the_mass_alone_is_that_of_equation_four(weighing):
    """16 p against 14.4: g = 16/(14.4 σ), Δp = −g r/(g² + w) with r = g (p − 0.9)."""
    model = chain(ALL[:1], ["m"])
    done = update(model, measured(model, [0.9]), [Stage((0,), "moved", 1)], n_modes=8,
                  weights=Weights({"moved_sigma": 0.1}, 50.0))  # fmt: skip
    g = 16.0 / 14.4 / 0.1
    assert done.factors[0] == pytest.approx(1.0 - 0.1 * g**2 / (g**2 + 50.0), rel=1e-9)
    assert done.history[0].objective == pytest.approx((0.1 * g) ** 2, rel=1e-9)


@pytest.mark.parametrize(
    ("value", "derivative", "said"),
    [
        (lambda s: s.eigenvalues, None, r"its value is no table"),
        (lambda s: s.eigenvalues[:, None], lambda s, d: d.eigenvalues, "its derivative is not"),
    ],
)
def test_a_value_or_derivative_of_another_shape_is_refused(value, derivative, said):
    odd = Residual("odd", weight="odd_sigma", sigma=1.0, value=value, derivative=derivative)
    register_residual(odd)
    try:
        with pytest.raises(InputError, match=f"residual 'odd': {said}"):
            update(chain(ALL[:1], ["k"]), measured(chain(ALL[:1], ["k"]), [1.1]),
                   [Stage((0,), "odd", 1)], n_modes=8)  # fmt: skip
    finally:
        RESIDUALS.remove(odd)
