"""A free structure on bungees: its suspension is not an effect that the model lacks."""

from types import SimpleNamespace as Of

import numpy as np

from trueup.core.discovery.screening.mode_selection import elastic

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
