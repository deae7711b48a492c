"""Which small properties could be noticed in the test, on the smallest of structures."""

import numpy as np
import pytest
import scipy.sparse as sp
from tests.core.chains import proportional

from trueup.core.assembly.element_assembly import ElementBlock
from trueup.core.data.dofs import Dofs
from trueup.core.data.geometry import Geometry
from trueup.core.data.parameter import Parameter
from trueup.core.data.parametric_model import Model, Term
from trueup.core.discovery.reduction.elements_and_supports import Members, Structure
from trueup.core.discovery.screening.parameter_screening import (
    noticeable,
    shifts,
    tied,
    told_apart,
)
from trueup.core.discovery.screening.screening_numbers import SCREENING
from trueup.core.eigen.normal_modes import Eigensolution
from trueup.core.elements.connectors.lumped import SPRING

BOUNDS = (0.25, 4.0)


def one_mass():
    """A mass 4 + p0 + p1 on a spring 3 + p2, at one coordinate: f² ∝ (3 + p2)/(4 + p0 + p1)."""
    one = sp.csr_matrix([[1.0]])
    names = ("small", "large", "spring")
    p = tuple(Parameter(n, (n.upper(),), (float(k),), *BOUNDS) for k, n in enumerate(names))

    def of(k, size):
        return Term(size * one, (proportional(k, *BOUNDS),))

    model = Model(
        Geometry(np.array([1]), np.zeros((1, 3)), ()),
        Dofs(np.array([1]), np.array([1])),
        one,
        (Term(3.0 * one), of(2, 1.0)),
        (Term(4.0 * one), of(0, 0.01), of(1, 0.99)),
        p,
    )
    solution = Eigensolution(
        np.array([0.8]), np.array([[1.0 / np.sqrt(5.0)]]), 0, {}, "lapack", 0.0, -1.0
    )
    return model, solution


def test_shifts_are_those_of_the_closed_form():
    model, solution = one_mass()
    hz = float(solution.frequencies_hz[0])
    found = shifts(model, solution, (hz, hz), (0, 1, 2))
    assert found == pytest.approx(np.array([[-0.5 * 0.01 / 5], [-0.5 * 0.99 / 5], [0.5 / 4.0]]))


def test_modes_far_outside_the_measured_band_do_not_count():
    model, solution = one_mass()
    hz = float(solution.frequencies_hz[0])
    assert shifts(model, solution, (2.0 * hz, 3.0 * hz), (0, 1)).shape == (2, 0)


def test_what_no_error_could_show_stays_put():
    slopes = np.array([[0.001, 0.002], [0.1, 0.0], [0.0, -0.2]])
    assert noticeable(slopes, [(0,), (1,), (2,)], 0.4) == [(1,), (2,)]


def test_values_alike_that_are_too_small_alone_move_together():
    slopes = np.full((5, 2), 0.01)
    assert noticeable(slopes, [(0, 1, 2), (3, 4)], 0.4) == [(0, 1, 2)]


def test_of_many_only_those_with_the_largest_shifts_move():
    slopes = np.linspace(0.1, 0.5, 40)[:, None]
    every = [(k,) for k in range(40)]
    assert noticeable(slopes, every, 0.4) == every[-SCREENING.most :]


def test_nothing_measured_means_nothing_noticed():
    assert noticeable(np.zeros((3, 0)), [(0, 1, 2)], 0.4) == []


def test_tied_parameters_move_alike_and_the_others_not_at_all():
    model, _ = one_mass()

    def evaluate(rows, p, wanted):
        return np.full((len(rows), 1, 1), p[0] + 10.0 * p[1] + 100.0 * p[2]), None

    block = ElementBlock(np.array([[0]]), 1, evaluate, ((0, 2),))
    member = Members(SPRING, np.array([7]), np.array([[0]]), block)
    whole = Structure(model, (member,), sp.csr_matrix([[1.0]]))
    own = tied(whole, [(1, 2)], ["both"])
    (parameter,) = own.model.parameters
    assert parameter.handle == ("LARGE", "SPRING")
    assert parameter.deck_values == (1.0, 2.0)
    p = np.array([2.0])
    assert own.model.K(p).toarray() == pytest.approx(np.array([[5.0]]))
    assert own.model.M(p).toarray() == pytest.approx(np.array([[4.0 + 0.01 + 1.98]]))
    assert own.model.dM(0, p).toarray() == pytest.approx(np.array([[0.99]]))
    (tied_member,) = own.members
    assert tied_member.block.depends == ((0,),)
    K = tied_member.stiffness(np.array([0]), p)
    assert K is not None
    assert K[0, 0, 0] == 1.0 + 10.0 * 2.0 + 100.0 * 2.0


def two_axes(turn):
    """Equal masses, each on a spring 1 + p along its own axis; modes turned by an angle."""
    names = ("along", "across")
    p = tuple(Parameter(n, (n.upper(),), (1.0,), *BOUNDS) for n in names)
    K = [sp.csr_matrix(np.diag(d)) for d in ([1.0, 0.0], [0.0, 1.0])]
    one = sp.identity(2, format="csr")
    model = Model(
        Geometry(np.array([1]), np.zeros((1, 3)), ()),
        Dofs(np.array([1, 1]), np.array([1, 2])),
        one,
        (Term(0.0 * one), *(Term(m, (proportional(k, *BOUNDS),)) for k, m in enumerate(K))),
        (Term(one),),
        p,
    )
    c, s = np.cos(turn), np.sin(turn)
    vectors = np.array([[c, -s], [s, c]])
    return model, Eigensolution(np.ones(2), vectors, 0, {}, "lapack", 0.0, -1.0)


@pytest.mark.parametrize("turn", [0.0, 0.3, 0.25 * np.pi])
def test_which_vectors_of_equal_frequency_a_solver_chose_does_not_count(turn):
    model, solution = two_axes(turn)
    hz = float(solution.frequencies_hz[0])
    slopes = shifts(model, solution, (hz, hz), (0, 1))
    assert told_apart(slopes, (0, 1), 0.4) == [(0,), (1,)]


def test_values_of_one_property_that_do_alike_move_together():
    slopes = np.array([[0.2, 0.1], [0.1, 0.05], [0.0, 0.2]])
    assert told_apart(slopes, (0, 1), 0.4) == [(0, 1)]
    assert told_apart(slopes, (0, 2), 0.4) == [(0,), (2,)]


def test_a_value_that_hardly_shows_follows_the_other_of_its_property():
    slopes = np.array([[0.2, 0.1], [0.0, 0.005]])
    assert told_apart(slopes, (0, 1), 0.4) == [(0, 1)]


def test_a_property_that_no_measured_mode_notices_stays_put():
    slopes = np.array([[0.01, 0.0], [0.0, 0.01]])
    assert told_apart(slopes, (0, 1), 0.4) == []
