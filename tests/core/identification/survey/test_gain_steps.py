"""A gain that changed during the survey is named as one fault of one reference, and mended."""

from dataclasses import replace

import numpy as np
import pytest

from trueup.core.identification.survey.check_survey import checked
from trueup.core.identification.survey.survey_data import prepare


@pytest.mark.parametrize(("times", "said"), [(3.0, "3"), (0.5, "0.5")])
@pytest.mark.parametrize("reference", [0, 1, 2])
def test_the_points_after_it_are_brought_to_the_size_of_the_others(survey, reference, times, said):
    frfs, _ = survey(12, n_mode=6, n_reference=3)
    values = np.array(frfs.values)
    values[27:, reference] *= times
    mended = checked(prepare(replace(frfs, values=values)))
    (fault,) = mended.faults
    label = frfs.references.labels[reference]
    assert (fault.kind, fault.done) == ("wrong_gain", "scaled")
    assert fault.functions == tuple(f"{n}:Z/{label}" for n in range(28, 41))
    assert f"about {said}" in fault.sentence
    assert mended.physical == pytest.approx(prepare(frfs).physical, rel=0.05)


@pytest.mark.parametrize("seed", range(4))
def test_a_survey_in_order_has_none(survey, seed):
    frfs, _ = survey(seed, n_mode=6, n_reference=3, noise=0.05)
    assert checked(prepare(frfs)).faults == ()


def test_references_exchanged_at_some_points_are_no_step(survey):
    frfs, _ = survey(12, n_mode=6, n_reference=3)
    values = np.array(frfs.values)
    values[27:36, [0, 1]] = values[27:36, [1, 0]]
    assert not any("gain" in f.kind for f in checked(prepare(replace(frfs, values=values))).faults)
