"""Which modes take part: a suspension is no effect, and a model too stiff has enough modes."""

from types import SimpleNamespace as Of

import numpy as np
import pytest
import scipy.sparse as sp
from tests.core.discovery import strings

from trueup.core.data.geometry import Geometry
from trueup.core.data.parametric_model import Dofs, Model, Term
from trueup.core.discovery.screening.mode_selection import (
    elastic,
    matchable,
    reference_modes,
    said_of_unfounded,
    unfounded,
)
from trueup.core.errors import InputError

X = np.linspace(-1.0, 1.0, 9)
RIGID = np.column_stack([np.ones(9), X])
BENDING = (X**2 - np.mean(X**2))[:, None]


def placed(hz, shapes):
    return Of(
        test=Of(frequencies_hz=np.array(hz), shapes=np.column_stack(shapes)),
        observation=Of(matrix=np.eye(9)),
    )


def solved(rigid=2):
    hz = np.array([0.0, 0.0, 40.0])[2 - rigid :]
    return Of(eigenvalues=(2.0 * np.pi * hz) ** 2, rigid_body_modes=rigid)


MOTION = np.hstack([RIGID, BENDING])


def test_bounce_and_pitch_are_left_out_and_bending_is_not():
    test = placed([2.0, 9.0, 41.0], [RIGID[:, 0], RIGID[:, 1] + 0.1 * RIGID[:, 0], BENDING[:, 0]])
    assert elastic(test, solved(), MOTION).tolist() == [False, False, True]


def compared(hz, doubted, paired):
    return Of(
        test=Of(frequencies_hz=np.array(hz), doubted=np.array(doubted)),
        correlation=Of(pairs=[Of(test=k) for k in paired]),
    )


def test_what_its_identification_doubts_is_left_out_unless_the_deck_has_it():
    before = compared([10.0, 20.0, 30.0, 40.0], [False, True, True, True], [2])
    among = np.array([True, True, True, False])
    unused = unfounded(before, among)
    assert unused.tolist() == [False, True, False, False]
    (said,) = said_of_unfounded(before, unused)
    assert "2 (20.00 Hz)" in said
    assert said_of_unfounded(before, np.zeros(4, bool)) == ()


def test_a_test_of_doubted_modes_alone_keeps_them():
    before = compared([10.0, 20.0], [True, True], [])
    assert not unfounded(before, np.ones(2, bool)).any()


def test_a_mode_at_zero_is_left_out_even_of_a_held_structure():
    test = placed([0.0, 41.0], [BENDING[:, 0], BENDING[:, 0]])
    assert elastic(test, solved(rigid=0), BENDING).tolist() == [False, True]


def test_a_soft_bending_mode_of_a_wrong_model_stays():
    test = placed([15.0], [BENDING[:, 0]])
    assert elastic(test, solved(), MOTION).tolist() == [True]


def test_what_the_sensors_do_not_measure_is_told_by_its_frequency_alone():
    rng = np.random.default_rng(1)
    test = placed([1.5], [rng.standard_normal(9)])
    assert elastic(test, solved(), MOTION).tolist() == [False]


def test_a_held_structure_has_no_such_modes():
    test = placed([2.0], [RIGID[:, 0]])
    assert elastic(test, solved(rigid=0), BENDING).tolist() == [True]


def string():
    grids, zero = np.arange(1, strings.N + 1), np.zeros(strings.N)
    geometry = Geometry(grids, np.column_stack([strings.X, zero, zero]))
    dofs, eye = Dofs(grids, np.ones(strings.N, np.int64)), sp.identity(strings.N, format="csr")
    return Model(geometry, dofs, eye, (Term(sp.csr_matrix(strings.K)),), (Term(eye),))


def test_a_model_far_too_stiff_has_as_many_modes_as_the_test_all_the_same():
    lowest = np.sqrt(np.linalg.eigvalsh(strings.K)[0]) / (2.0 * np.pi)
    assert len(reference_modes(string(), 0.1 * lowest, 12).eigenvalues) >= 12


def test_more_modes_of_a_test_than_a_model_has_are_refused_with_both_numbers():
    solution = reference_modes(string(), 1.0, 100)
    matchable(strings.N, solution)
    with pytest.raises(InputError, match=r"33 elastic modes .* only 32"):
        matchable(strings.N + 1, solution)
