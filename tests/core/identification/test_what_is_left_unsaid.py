"""What identification says of peaks without a mode, and of modes that one reference sees twice."""

import numpy as np
import pytest

from trueup.core.data.dofs import Dofs
from trueup.core.data.frfs import Frfs
from trueup.core.identification.identify import identify
from trueup.core.identification.peaks_without_mode import of_peaks
from trueup.core.identification.survey.modal_synthesis import modal_response, poles_from
from trueup.core.identification.survey.mode_indicator import cmif
from trueup.core.identification.survey.survey_data import prepare

F = np.arange(20.0, 120.0, 0.125)
HZ = np.array([31.0, 52.0, 77.0, 98.0])


def made(factor: np.ndarray, noise: float = 0.01) -> Frfs:
    """Responses (n,) to one reference, all frequencies of each times its factor."""
    rng = np.random.default_rng(4)
    shapes = rng.uniform(0.5, 1.0, (len(factor), 4)) * rng.choice([-1.0, 1.0], (len(factor), 4))
    part = np.full((1, 4), 1e-3j)
    values = np.concatenate(
        [
            modal_response(F, poles_from(HZ * k, np.full(4, 0.002)), row[None] + 0j, part)
            for k, row in zip(factor, shapes, strict=True)
        ]
    )
    size = noise * np.sqrt(np.mean(np.abs(values) ** 2))
    values += size * (rng.standard_normal(values.shape) + 1j * rng.standard_normal(values.shape))
    outputs = Dofs(np.arange(1, len(factor) + 1), np.full(len(factor), 3))
    return Frfs(F, outputs, outputs.take([0]), values, "acceleration", "made")


@pytest.mark.parametrize(("known", "told"), [(HZ, ""), (HZ[[0, 1, 3]], "77.00"), (HZ[:2], "98.00")])
def test_a_peak_where_no_mode_was_accepted_is_told(known, told):
    survey = prepare(made(np.ones(12)))
    said = " ".join(of_peaks(survey, (), cmif(survey.values)[:, 0], known))
    assert told in said
    assert bool(said) == bool(told)


def test_noise_makes_no_peak():
    survey = prepare(made(np.ones(12), noise=0.3))
    assert of_peaks(survey, (), cmif(survey.values)[:, 0], HZ) == []


def test_all_peaks_are_modes_of_a_survey_in_order():
    assert not [w for w in identify(made(np.ones(12))).warnings if "peak" in w]


def test_modes_that_one_reference_sees_twice_at_other_responses_are_remarked():
    """Half of the responses were measured with a heavy sensor: every mode stands twice."""
    found = identify(made(np.repeat([1.0, 0.985], 6)))
    assert len(found.modes) == 8
    assert all("at other responses" in r for r in found.remarks)


def test_a_pair_of_modes_of_separate_parts_bears_no_such_remark():
    frfs = made(np.ones(12))
    pair = poles_from([60.0, 60.8], [0.002, 0.002])
    apart = np.zeros((12, 2), complex)
    apart[:6, 0] = apart[6:, 1] = 0.8
    values = frfs.values + modal_response(F, pair, apart, np.full((1, 2), 1e-3j))
    found = identify(Frfs(F, frfs.responses, frfs.references, values, "acceleration", "made"))
    assert found.modes.frequencies_hz == pytest.approx([31, 52, 60, 60.8, 77, 98], abs=0.02)
    assert not any("at other responses" in r for r in found.remarks)
