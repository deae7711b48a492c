"""What is clear, and what an error of the model imitates."""

from types import SimpleNamespace as Some

import numpy as np
import pytest

from trueup.core.discovery.search.completeness import Completeness, completeness

HZ = np.arange(10.0, 20.0)


def judged(each, error=0.001, stray=(), evidence=0.0):
    chance = np.isin(np.arange(10), stray).astype(float)
    shared = Some(each=np.asarray(each, float), error=error, stray=chance)
    return Some(diffuse=shared, evidence=evidence, plain=evidence)


def found(each, gain=30.0, ahead=np.inf, **more):
    none = judged(np.zeros(10))
    return Completeness(none, none, judged(each, **more), gain, gain, ahead, HZ)


def test_what_many_modes_gain_by_is_clear():
    assert found(np.full(10, 3.0)).clear


def test_a_small_gain_is_not_clear():
    assert not found(np.full(10, 3.0), gain=4.0).clear


def test_the_larger_the_error_that_is_left_the_more_has_to_be_gained():
    assert not found(np.full(10, 3.0), error=0.02).clear
    assert found(np.full(10, 30.0), error=0.02, gain=300.0).clear


def test_two_places_that_are_as_good_are_not_clear():
    assert not found(np.full(10, 3.0), ahead=1.0).clear


@pytest.mark.parametrize("end", [slice(0, 2), slice(-2, None)])
def test_modes_at_an_end_of_the_band_decide_nothing(end):
    each = np.zeros(10)
    each[end] = 15.0
    assert not found(each).clear


def test_an_explanation_with_many_modes_left_is_not_clear():
    assert found(np.full(10, 3.0), stray=(4,)).clear
    assert not found(np.full(10, 3.0), stray=(4, 5)).clear


def test_a_suspect_that_gains_less_than_its_choices_is_dropped():
    one = Some(kind=0)
    levels = [Some(suspects=()), Some(suspects=(one,)), Some(suspects=(one, one))]
    kind = Some(kind="mass", tunings=1)
    evidence = {0: 0.0, 1: 30.0, 2: 40.0}
    searcher = Some(
        problem=Some(catalogue=[kind], whole=Some(frequencies_hz=HZ)),
        coarse=[np.arange(100)],
        judged=lambda _, f: judged(np.zeros(10), evidence=evidence[len(f.suspects)]),
    )
    none = judged(np.zeros(10))
    _, kept, said = completeness(
        searcher,
        Some(levels=levels, rivals=((), (), ())),
        Some(accepted=2, scale=1.0),
        none,
    )
    assert kept == 1
    assert said.gain == pytest.approx(30.0 - np.log(100))
