"""A model that is wrong everywhere a little: the error that was put in is the one that is found."""

from dataclasses import replace

import numpy as np
import pytest

from trueup.core.discovery.model_error.adequacy import adequacy, as_many_astray
from trueup.core.discovery.model_error.diffuse_error import Seen
from trueup.core.discovery.model_error.diffuse_slope import diffuse


def made(error, noise=0.02, n=30, sensors=40, close=False, seed=0):
    """A model and a test of its twin, whose stiffness differs by a random relative change."""
    rng = np.random.default_rng(seed)
    hz = np.geomspace(20.0, 200.0, n)
    if close:
        hz[1::2] = hz[::2] * (1.0 + 1e-5)
    root = 2.0 * np.pi * hz
    E = rng.normal(size=(n, n))
    E = (E + E.T) / np.sqrt(2.0)
    values, turn = np.linalg.eigh(root[:, None] * (np.eye(n) + error * E) * root)
    modes = rng.normal(size=(sensors, n))
    shapes = modes @ turn
    shapes += noise * np.sqrt(np.mean(shapes**2, axis=0)) * rng.normal(size=shapes.shape)
    shapes = (shapes / np.linalg.norm(shapes, axis=0))[:, :15]
    hz_test = np.sqrt(values[:15]) / (2.0 * np.pi)
    return Seen(hz_test, shapes, np.full(15, 1e-3), root**2, modes, 20)


@pytest.mark.parametrize("error", [0.003, 0.01, 0.03])
def test_the_error_that_was_put_in_is_found(error):
    found = [diffuse(made(error, seed=k)).error for k in range(5)]
    assert error / 1.5 < np.exp(np.mean(np.log(found))) < 1.5 * error


def test_a_right_model_leaves_the_noise_alone():
    found = diffuse(made(0.0))
    assert found.error < 0.001
    assert 0.015 < found.noise < 0.028
    assert list(found.match) == list(range(15))


def test_close_modes_may_turn_without_any_error_of_the_model():
    assert diffuse(made(0.001, close=True)).error < 0.003


def test_a_mode_that_nobody_explains_does_not_rule_the_others():
    seen = made(0.003)
    shapes = seen.shapes.copy()
    shapes[:, 4] = np.random.default_rng(9).normal(size=len(shapes))
    shapes[:, 4] /= np.linalg.norm(shapes[:, 4])
    found = diffuse(Seen(seen.hz, shapes, seen.scatter, seen.eigenvalues, seen.modes, 20))
    assert np.flatnonzero(found.stray > 0.5).tolist() == [4]
    assert found.error < 0.01


def test_order_of_sensors_and_modes_says_nothing():
    seen = made(0.01)
    rng = np.random.default_rng(3)
    rows, columns = rng.permutation(40), rng.permutation(15)
    other = Seen(
        seen.hz[columns],
        seen.shapes[rows][:, columns],
        seen.scatter,
        seen.eigenvalues,
        seen.modes[rows],
        20,
    )
    assert diffuse(other).log == pytest.approx(diffuse(seen).log, abs=1e-6)


def test_the_larger_the_error_the_less_adequate():
    said = [adequacy(e) for e in (1e-4, 1e-3, 1e-2, 1e-1)]
    assert said == sorted(said, reverse=True)
    assert said[0] > 0.9
    assert said[-1] < 0.03


def test_a_mode_that_nothing_explains_is_rare_and_two_of_ten_are_no_chance():
    assert as_many_astray(0, 10) == 1.0
    assert as_many_astray(1, 10) == pytest.approx(1.0 - 0.97**10)
    assert as_many_astray(2, 10) == pytest.approx(1.0 - 0.97**10 - 0.3 * 0.97**9)
    assert as_many_astray(2, 40) > 0.3


def test_a_mode_that_no_sensor_sees_changes_nothing():
    """What sensors read of it is rounding; they read fewer than there are modes."""
    seen = made(0.03, sensors=18)
    blind = np.random.default_rng(3).normal(size=(len(seen.modes), 1)) * 1e-14
    modes = np.hstack([seen.modes[:, :6], blind, seen.modes[:, 6:]])
    values = np.insert(seen.eigenvalues, 6, seen.eigenvalues[6] * (1.0 + 1e-9))
    found = diffuse(replace(seen, eigenvalues=values, modes=modes, columns=21))
    assert found.match.tolist() == [0, 1, 2, 3, 4, 5, 7, 8, 9, 10, 11, 12, 13, 14, 15]
    assert found.log == pytest.approx(diffuse(seen).log, abs=1e-6)
