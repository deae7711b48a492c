"""Mass, centre of gravity and static deflections: closed forms and derivatives."""

from dataclasses import replace

import numpy as np
import pytest
import scipy.sparse as sp
from tests.core.updating.spring_chain import HALVES, N, chain, measured

from trueup.core.errors import InputError
from trueup.core.updating.residuals import RESIDUALS, Beside, LoadCase, Seen, Slopes, Weights
from trueup.core.updating.update import Stage, update

BY_NAME = {r.name: r for r in RESIDUALS}
NONE = np.zeros((0, 0))


def weighed(model):
    """The chain's masses of 2 kg lie at x = 0, 1, ... of the x axis."""
    x = np.arange(model.n_free)
    rigid = []
    for t in model.mass:
        m = t.matrix.diagonal()
        R = np.diag([m.sum()] * 3 + [0.0] * 3)
        R[1, 5] = R[5, 1] = m @ x
        R[2, 4] = R[4, 2] = -m @ x
        rigid.append(R)
    return replace(model, rigid_mass=tuple(rigid))


def seen(model, p, **beside):
    return Seen(model, np.array(p, float), (), np.zeros(0), NONE, NONE, Beside(**beside))


def slopes(n):
    return Slopes(tuple(range(n)), np.zeros((0, n)), None)


def end_load(model, force=10.0, rows=(3, 7), values=(1.0, 2.0)):
    load = np.zeros(model.n_free)
    load[-1] = force
    at = sp.identity(model.n_free, format="csr")[list(rows)]
    return LoadCase(load, at, np.array(values))


def test_mass_and_centre_of_gravity_in_closed_form():
    model = weighed(chain(HALVES, ["m", "m"]))
    here = seen(model, [1.0, 1.5], mass=25.0, centre_of_gravity=np.array([4.0, np.nan, 0.1]))
    assert BY_NAME["mass"].value(here)[0, 0] == pytest.approx(20.0 / 25.0 - 1.0)
    centre = (2.0 * 6.0 + 3.0 * 22.0) / 20.0
    np.testing.assert_allclose(
        BY_NAME["centre_of_gravity"].value(here)[:, 0], [(centre - 4.0) / 7.0, -0.1 / 7.0]
    )


def test_springs_in_a_row_add_their_stretches():
    model = chain(HALVES)
    here = seen(model, [1.0, 0.5], load_cases=(end_load(model),))
    u3, u7 = 4 * 10.0 / 1e4, 4 * 10.0 / 1e4 + 4 * 10.0 / 0.5e4
    np.testing.assert_allclose(
        BY_NAME["deflections"].value(here)[:, 0], [(u3 - 1.0) / 2.0, (u7 - 2.0) / 2.0]
    )


@pytest.mark.parametrize("name", ["mass", "centre_of_gravity", "deflections"])
def test_derivatives_are_those_of_the_values(name):
    model = weighed(chain((*HALVES, *HALVES), ["k", "k", "m", "m"]))
    p, step = np.array([1.1, 0.8, 1.3, 0.7]), 1e-5
    known = {
        "mass": 14.0,
        "centre_of_gravity": np.array([3.0, 0.0, 0.0]),
        "load_cases": (end_load(model), end_load(model, 5.0, (1,), (0.3,))),
    }
    residual = BY_NAME[name]
    found = residual.derivative(seen(model, p, **known), slopes(4))
    for k, e in enumerate(np.eye(4) * step):
        ahead, behind = (residual.value(seen(model, q, **known)) for q in (p + e, p - e))
        np.testing.assert_allclose(found[:, :, k], (ahead - behind) / (2 * step), atol=1e-8)


@pytest.mark.parametrize("more", ["mass", "deflections"])
def test_they_set_the_scale_that_frequencies_leave_open(more):
    truth = np.array([1.2, 0.9])
    model = weighed(chain([range(N), range(N)], ["k", "m"]))
    case = end_load(model, values=(4 * 10.0 / 1.2e4, 8 * 10.0 / 1.2e4))
    beside = Beside(mass=0.9 * 16.0, load_cases=(case,))
    target = replace(measured(model, truth), beside=beside)
    done = update(model, target, [Stage((0, 1), f"frequencies, {more}", 20)], n_modes=8,
                  weights=Weights(regularisation=0.0), tolerance=1e-7)  # fmt: skip
    np.testing.assert_allclose(done.factors, truth, rtol=1e-6)
    assert done.undetermined == ()


@pytest.mark.parametrize("name", ["mass", "centre_of_gravity", "deflections"])
def test_what_was_not_measured_has_no_row(name):
    there = seen(weighed(chain(HALVES)), [1.0, 1.0])
    assert BY_NAME[name].value(there).shape == (0, 1)
    assert BY_NAME[name].derivative(there, Slopes((0, 1), None, None)).shape == (0, 1, 2)


def test_a_free_structure_has_no_static_deflection():
    model = chain(HALVES)
    K = model.K().tolil()
    K[0, 0] -= 1e4
    free = replace(model, stiffness=(replace(model.stiffness[0], matrix=K.tocsr(), factors=()),))
    with pytest.raises(InputError, match="need a structure that is held"):
        BY_NAME["deflections"].value(seen(free, [1.0, 1.0], load_cases=(end_load(model),)))


def test_a_model_that_does_not_tell_its_mass_is_refused():
    with pytest.raises(InputError, match="does not tell its mass"):
        BY_NAME["mass"].value(seen(chain(HALVES), [1.0, 1.0], mass=3.0))
