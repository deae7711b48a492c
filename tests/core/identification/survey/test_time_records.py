"""Time records beside the functions: cut off, or of a hammer that struck twice."""

import numpy as np
import pytest

from trueup.core.identification.survey.time_records import (
    TimeRecord,
    faults_of_records,
    is_clipped,
    second_blow,
)

T = np.arange(4096) / 2048.0


def pulse(at, size=100.0, width=0.002):
    return size * np.exp(-(((T - at) / width) ** 2))


def ringing(seed=0):
    rng = np.random.default_rng(seed)
    wave = sum(a * np.sin(2.0 * np.pi * f * T) for a, f in [(5.0, 31.0), (3.0, 87.0), (2.0, 143.0)])
    return np.exp(-2.0 * T) * wave + 0.01 * rng.standard_normal(len(T))


def test_a_record_that_stays_at_its_largest_value_was_cut_off():
    assert not is_clipped(ringing())
    assert is_clipped(np.clip(ringing(), -3.0, 3.0))
    assert is_clipped(np.minimum(ringing(), 3.0))


@pytest.mark.parametrize(
    "record", [np.zeros(100), np.empty(0), pulse(0.1), np.round(pulse(0.1), 1)]
)
def test_rest_is_no_overload(record):
    assert not is_clipped(record)


@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_a_second_blow_is_told_with_its_delay(sign):
    noise = 0.5 * np.random.default_rng(1).standard_normal(len(T))
    once = pulse(0.1) - 4.0 * pulse(0.11, 1.0)
    assert second_blow(T, sign * once + noise) == 0.0
    assert second_blow(T, sign * (once + pulse(0.14, 40.0)) + noise) == pytest.approx(
        0.04, abs=2e-3
    )


@pytest.mark.parametrize("force", [
    np.random.default_rng(2).standard_normal(len(T)),
    np.sin(2.0 * np.pi * 30.0 * T),
    sum(pulse(at) for at in (0.1, 0.6, 1.1)),
    np.zeros(len(T)),
], ids=["random", "sine", "many blows", "nothing"])  # fmt: skip
def test_what_is_no_single_blow_has_no_second(force):
    assert second_blow(T, force) == 0.0


def test_faults_name_the_points():
    records = [
        TimeRecord("20:Z", T, pulse(0.1) + pulse(0.15, 30.0), True),
        TimeRecord("21:Z", T, pulse(0.1), True),
        TimeRecord("40:Z", T, np.clip(ringing(), -3.0, 3.0), False),
    ]
    cut, twice = faults_of_records(records)
    assert (cut.kind, cut.functions) == ("overload", ("40:Z",))
    assert (twice.kind, twice.functions) == ("double_hit", ("20:Z",))
    assert "49.8 ms after" in twice.sentence
