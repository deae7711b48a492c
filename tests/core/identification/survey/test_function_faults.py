"""Functions that are dead, cut off, noisier than the others, or of a double hit."""

from dataclasses import replace

import numpy as np
import pytest

from trueup.core.identification.survey.check_survey import checked
from trueup.core.identification.survey.survey_data import prepare


@pytest.fixture(scope="module")
def frfs(survey):
    return survey(9, n_mode=6, band=(10.0, 100.0), n_line=901)[0]


def faults(frfs, changed):
    """Return what is found with the function of point 8 for the first reference changed."""
    values = np.array(frfs.values)
    values[7, 0] = changed(values[7, 0], np.random.default_rng(2))
    return checked(prepare(replace(frfs, values=values))).faults


def noise(rng, n):
    return rng.standard_normal(n) + 1j * rng.standard_normal(n)


@pytest.mark.parametrize("size", [1e-6, 1.0, 1e3])
@pytest.mark.parametrize("smoothed", [1, 5, 15])
@pytest.mark.parametrize("offset", [0.0, 50.0])
def test_noise_of_any_size_and_colour_is_a_dead_channel(frfs, size, smoothed, offset):
    def dead(h, rng):
        return size * (offset + np.convolve(noise(rng, len(h)), np.hanning(smoothed + 2), "same"))

    (fault,) = faults(frfs, dead)
    assert (fault.kind, fault.functions, fault.done) == ("dead_channel", ("8:Z/1:Z",), "left out")


def test_a_dead_channel_of_a_whole_reference_leaves_the_others(survey):
    frfs, _ = survey(9, n_mode=6, n_reference=3)
    values, rng = np.array(frfs.values), np.random.default_rng(1)
    for o in range(len(values)):
        values[o, 1] = np.convolve(noise(rng, values.shape[2]), np.hanning(9), "same")
    mended = checked(prepare(replace(frfs, values=values)))
    assert {f.kind for f in mended.faults} == {"dead_channel"}
    assert mended.inputs.labels == ["1:Z", "40:Z"]


def test_a_resonance_that_one_function_alone_sees_is_no_fault(frfs):
    f = frfs.frequencies_hz
    assert faults(frfs, lambda h, rng: h + 30.0 * np.abs(h).max() / (f / 50.0 - 1.0 - 0.002j)
                  * 0.002) == ()  # fmt: skip


@pytest.mark.parametrize("level", [0.1, 0.5])
def test_a_noise_floor_far_above_the_survey_is_named(frfs, level):
    (fault,) = faults(frfs, lambda h, rng: h + level * np.abs(h).std() * noise(rng, len(h)))
    assert (fault.kind, fault.functions, fault.done) == ("noise_floor", ("8:Z/1:Z",), "left out")


def test_noise_in_the_notches_of_a_force_spectrum_is_named(frfs):
    f = frfs.frequencies_hz
    force = np.abs(1.0 + 0.95 * np.exp(-2j * np.pi * f * 0.03))
    found = faults(frfs, lambda h, rng: h + 0.2 * np.abs(h).std() * noise(rng, len(h)) / force)
    assert [x.kind for x in found] == ["noise_floor"]


def test_three_times_the_noise_is_none(frfs):
    assert faults(frfs, lambda h, rng: h + 0.02 * np.abs(h).std() * noise(rng, len(h))) == ()


@pytest.mark.parametrize("part", [
    lambda h, top: h / np.maximum(np.abs(h) / top, 1.0),
    lambda h, top: np.clip(h.real, -top, top) + 1j * np.clip(h.imag, -top, top),
])  # fmt: skip
def test_a_function_that_stops_at_one_value_is_an_overload(frfs, part):
    (fault,) = faults(frfs, lambda h, rng: part(h, 0.3 * np.abs(h).max()))
    assert (fault.kind, fault.functions) == ("overload", ("8:Z/1:Z",))


def test_a_response_in_time_that_stops_at_one_value_is_an_overload(survey):
    """Lines from 0.1 Hz on: the impulse response is known."""
    frfs, _ = survey(9, n_mode=6, band=(0.1, 100.0), n_line=1000, noise=0.001)
    values = np.array(frfs.values)
    h = np.fft.irfft(np.concatenate([[0.0], values[7, 0]]))
    values[7, 0] = np.fft.rfft(np.clip(h, -0.5 * h.max(), 0.5 * h.max()))[1:]
    found = checked(prepare(replace(frfs, values=values))).faults
    assert ("overload", ("8:Z/1:Z",)) in [(f.kind, f.functions) for f in found]


@pytest.mark.parametrize("delay", [0.04, 0.06])
def test_a_double_hit_is_named_with_its_delay(frfs, delay):
    ripple = 1.0 + 0.5 * np.exp(-2j * np.pi * frfs.frequencies_hz * delay)
    (fault,) = faults(frfs, lambda h, rng: h * ripple)
    assert (fault.kind, fault.functions) == ("double_hit", ("8:Z/1:Z",))
    assert float(fault.sentence.split(" ms")[0].split()[-1]) == pytest.approx(1e3 * delay, rel=0.1)


def test_a_ripple_of_few_cycles_is_named_where_the_functions_of_a_point_have_it_together(frfs):
    ripple = 1.0 + 0.5 * np.exp(-2j * np.pi * frfs.frequencies_hz * 0.03)
    values = np.array(frfs.values)
    values[7, 0] *= ripple
    assert checked(prepare(replace(frfs, values=values))).faults == ()
    values[7, 1] *= ripple
    (fault,) = checked(prepare(replace(frfs, values=values))).faults
    assert (fault.kind, fault.functions) == ("double_hit", ("8:Z/1:Z", "8:Z/40:Z"))


@pytest.mark.parametrize("settings", [
    {}, {"n_reference": 1}, {"n_reference": 3}, {"complexity": 0.2, "n_reference": 3},
    {"missing": 0.3, "n_reference": 3}, {"n_response": 6, "n_reference": 3}, {"noise": 0.2},
    {"noise": 0.1, "noise_kind": "multiplicative"}, {"damping": (0.02, 0.05)},
    {"n_mode": 2}, {"quantity": "displacement"}, {"quantity": "velocity"},
])  # fmt: skip
@pytest.mark.parametrize("seed", range(3))
def test_nothing_is_named_on_a_survey_in_order(survey, seed, settings):
    assert checked(prepare(survey(seed, **settings)[0])).faults == ()
