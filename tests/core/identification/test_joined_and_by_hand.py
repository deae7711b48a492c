"""Surveys of runs whose frequencies differ, and modes that are taken or refused by hand."""

from dataclasses import replace

import numpy as np
import pytest

from trueup.core.errors import InputError
from trueup.core.identification.identify import identify


def test_rejected_roots_fill_up_the_number_of_modes_asked_for(survey):
    """Of four runs joined whose frequencies differ no root is a mode unless the user says so."""
    hz = np.array([31.0, 47.0, 72.0])
    runs = [
        survey(11, frequencies=hz * s, n_response=20, n_line=1000, n_reference=1)[0]
        for s in np.linspace(0.99, 1.01, 4)
    ]
    frfs = replace(runs[0], values=np.array([runs[o % 4].values[o] for o in range(20)]))
    assert not len(identify(frfs).modes)
    forced = identify(frfs, modes=2)
    assert forced.modes.frequencies_hz == pytest.approx(hz[1:], rel=0.01)
    (said,) = [w for w in forced.warnings if "are asked for" in w]
    taken = [f"{f:.2f}" for f in forced.modes.frequencies_hz]
    assert f"2 modes are asked for: rejected roots ({', '.join(taken)} Hz) are taken" in said
    with pytest.raises(InputError, match="9 modes are asked for; the functions hold"):
        identify(frfs, modes=9)


def test_modes_of_two_runs_joined_are_found_at_the_mean(survey):
    hz = np.array([31.0, 47.0, 72.0])
    one, other = (
        survey(11, frequencies=hz * s, n_response=20, n_line=1000)[0] for s in (1.0, 1.01)
    )
    found = identify(replace(one, values=np.concatenate([one.values[:10], other.values[10:]])))
    assert found.modes.frequencies_hz == pytest.approx(hz * 1.005, rel=0.002)
    assert any("differ from response to response" in w for w in found.warnings)
    assert found.quality.min() > 0.99


def test_modes_of_two_runs_too_far_apart_to_be_joined_bear_a_remark(survey):
    hz = np.array([30.0, 47.0, 66.0, 85.0])
    one, other = (
        survey(11, frequencies=hz * s, n_response=20, n_line=1000)[0] for s in (1.0, 1.03)
    )
    assert not any(identify(one).remarks)
    found = identify(replace(one, values=np.concatenate([one.values[:10], other.values[10:]])))
    assert len(found.modes) == 8
    assert all("perhaps one resonance" in r for r in found.remarks)


def test_a_mode_is_refused_and_a_rejected_root_taken_by_hand(survey):
    frfs, truth = survey(11, n_mode=6, n_response=20, n_line=1000)
    hz = np.sort(truth.frequencies_hz)
    without = identify(frfs, refuse=[hz[2]])
    assert without.modes.frequencies_hz == pytest.approx(np.delete(hz, 2), rel=1e-3)
    (refused,) = [r for r in without.rejected if r.reason == "refused by hand"]
    assert refused.frequency_hz == pytest.approx(hz[2], rel=1e-3)
    left = np.sqrt(np.mean(np.abs(without.synthesised().values - frfs.values) ** 2))
    assert left < 1.1 * np.sqrt(np.mean(truth.noise_std**2))
    with pytest.raises(InputError, match="is both taken and refused"):
        identify(frfs, refuse=[hz[2]], take=[hz[2]])
    with pytest.raises(InputError, match="no mode to refuse within"):
        identify(frfs, refuse=[hz[2] + 1.0])
    with pytest.raises(InputError, match="refused at 15 Hz: only 20 to 100 Hz take part"):
        identify(frfs, refuse=[15.0])
    with pytest.raises(
        InputError, match=r"no root can be taken at 60\.3 Hz: beside the other roots"
    ):
        identify(frfs, take=[60.3])
