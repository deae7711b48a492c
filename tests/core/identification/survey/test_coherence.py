"""Coherence beside the functions: low at resonances or in one function, not at antiresonances."""

from dataclasses import replace

import numpy as np
import pytest

from trueup.core.identification.identify import identify
from trueup.core.identification.survey.check_survey import checked
from trueup.core.identification.survey.coherence import Coherence
from trueup.core.identification.survey.survey_data import prepare


@pytest.fixture(scope="module")
def measured(survey):
    """A survey and its coherence: low at antiresonances, as noise at the response makes it."""
    frfs, truth = survey(3, n_mode=6)
    power = np.abs(frfs.values) ** 2
    noise = 0.002 * power.mean(axis=2, keepdims=True)
    values = power / (power + noise)
    return frfs, truth, Coherence(frfs.frequencies_hz, frfs.responses, frfs.references, values)


def faults(measured, change=lambda values: None):
    frfs, _, coherence = measured
    values = coherence.values.copy()
    change(values)
    return checked(prepare(frfs), None, replace(coherence, values=values)).faults


def test_antiresonances_are_no_fault(measured):
    assert measured[2].values.min() < 0.5
    assert faults(measured) == ()


def test_functions_of_low_coherence_are_named(measured):
    def low(values):
        values[7, 0] *= 0.5
        values[20, 1] *= 0.6

    (fault,) = faults(measured, low)
    assert (fault.kind, fault.functions) == ("low_coherence", ("8:Z/1:Z", "21:Z/40:Z"))
    assert "down to 0.50" in fault.sentence


def test_a_resonance_of_low_coherence_is_named(measured):
    frfs, truth, _ = measured
    hz = truth.frequencies_hz[2]
    near = np.abs(frfs.frequencies_hz - hz) < 0.2

    def low(values):
        values[:, :, near] *= 0.6

    found = faults(measured, low)
    assert {f.kind for f in found} == {"low_coherence"}
    said = next(f.sentence for f in found if not f.functions)
    assert float(said.split("near ")[1].split(" Hz")[0]) == pytest.approx(hz, abs=0.2)


def test_the_mode_of_a_resonance_of_low_coherence_bears_a_remark(measured):
    frfs, truth, coherence = measured
    values = coherence.values.copy()
    values[:, :, np.abs(frfs.frequencies_hz - truth.frequencies_hz[2]) < 0.2] *= 0.6
    found = identify(frfs, coherence=replace(coherence, values=values))
    marked = ["low coherence at its resonance (0.60)" in r for r in found.remarks]
    assert found.modes.frequencies_hz[marked] == pytest.approx([truth.frequencies_hz[2]], rel=1e-3)


def test_a_roving_hammer_and_missing_coherences_are_met(measured):
    frfs, _, coherence = measured
    turned = replace(frfs, values=frfs.values.transpose(1, 0, 2), responses=frfs.references,
                     references=frfs.responses)  # fmt: skip
    values = coherence.values.transpose(1, 0, 2).copy()
    values[0, 7] *= 0.5
    values[1, 3:] = np.nan
    roving = Coherence(frfs.frequencies_hz, turned.responses, turned.references, values)
    (fault,) = checked(prepare(turned), None, roving).faults
    assert fault.functions == ("1:Z/8:Z",)
