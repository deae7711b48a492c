"""What is no frequency response is named and left out, or refused in one sentence."""

from dataclasses import replace

import numpy as np
import pytest

from trueup.core.data.dofs import Dofs
from trueup.core.errors import InputError
from trueup.core.identification.identify import identify
from trueup.core.identification.survey.survey_data import noise_levels, prepare


@pytest.fixture(scope="module")
def frfs(survey):
    return survey(1, n_mode=4, n_response=12, n_reference=2, n_line=500)[0]


def with_values(frfs, place, values):
    changed = np.array(frfs.values)
    changed[place] = values
    return replace(frfs, values=changed)


@pytest.mark.parametrize(
    ("values", "words"),
    [
        (1.0 + 2.0j, "dead channel"),
        (0.0, "dead channel"),
        ("coherence", "a coherence"),
        ("time", "a time record"),
        ("noise", "nothing but noise"),
    ],
)
def test_what_is_no_frequency_response_is_named_and_left_out(frfs, values, words):
    rng = np.random.default_rng(0)
    shape = frfs.values[3].shape
    if values == "coherence":
        values = rng.uniform(0.0, 1.0, shape)
    elif values == "time":
        values = rng.standard_normal(shape)
    elif values == "noise":
        values = rng.standard_normal(shape) + 1j * rng.standard_normal(shape)
    found = prepare(with_values(frfs, 3, values))
    (warning,) = found.warnings
    assert words in warning
    assert "4:Z/1:Z, 4:Z/12:Z" in warning
    assert "survey 1" in warning
    assert 4 not in found.outputs.node
    assert len(found.outputs) == 11


@pytest.mark.parametrize("nothing", [np.nan, np.inf, 1.8e308, 0.0])
def test_a_gap_in_one_function_costs_that_function_only(frfs, nothing):
    """What wrote the file may have put nil, or a value without a square, where it had none."""
    found = prepare(with_values(frfs, (5, 0, 17), nothing))
    hz = frfs.frequencies_hz[17]
    assert (
        f"6:Z/1:Z has no value (not finite, or nil) at up to one line, {hz:.4g} Hz"
        in (found.warnings[0])
    )
    assert not found.measured[5, 0]
    assert found.measured.sum() == 23


def test_a_gap_says_of_how_many_functions_and_where(frfs):
    found = prepare(with_values(frfs, (slice(4, 7), slice(None), slice(100, 200)), 0.0))
    low, high = frfs.frequencies_hz[[100, 199]]
    assert "and 1 more have no value" in found.warnings[0]
    assert f"at up to 100 lines between {low:.4g} and {high:.4g} Hz" in found.warnings[0]


def test_a_line_that_no_function_has_costs_that_line_only(frfs):
    found = prepare(with_values(frfs, (slice(None), slice(None), 17), np.nan))
    assert "most functions have no value at one line" in found.warnings[0]
    assert found.measured.all()
    assert found.frequencies_hz == pytest.approx(np.delete(frfs.frequencies_hz, 17))


def test_one_function_under_many_names_is_refused(frfs):
    same = np.broadcast_to(frfs.values[0, 0], frfs.values.shape)
    with pytest.raises(InputError, match="all 24 functions of survey 1 are equal to the last"):
        identify(replace(frfs, values=same))


def test_missing_combinations_are_told_in_one_sentence(frfs):
    found = prepare(with_values(frfs, (5, 0), np.nan))
    (warning,) = found.warnings
    assert "lacks 1 of 24 combinations of response and reference (6:Z/1:Z)" in warning
    assert not found.measured[5, 0]
    assert np.all(found.values[5, 0] == 0.0)


def test_sets_without_a_common_function_are_not_mixed(frfs):
    """Rows 0-6 see only the first reference, rows 7-11 only the second."""
    values = np.array(frfs.values)
    values[:7, 1] = np.nan
    values[7:, 0] = np.nan
    found = prepare(replace(frfs, values=values))
    assert "share no reference" in found.warnings[0]
    assert list(found.outputs.node) == [1, 2, 3, 4, 5, 6, 7]


@pytest.mark.parametrize(
    ("change", "words"),
    [
        (lambda f: {"frequencies_hz": f.frequencies_hz[::-1]}, "does not rise at line 2"),
        (lambda f: {"values": np.full(f.values.shape, np.nan)}, "no frequency response"),
        (lambda f: {"values": np.abs(f.values) / np.abs(f.values).max()}, "a coherence"),
        (lambda f: {"values": f.values.real}, "a time record"),
        (lambda f: {"values": f.values.conj()}, "conjugate"),
        (lambda f: {"quantity": "pressure"}, "displacement, velocity, acceleration"),
    ],
)
def test_what_cannot_be_used_is_refused_in_one_sentence(frfs, change, words):
    with pytest.raises(InputError, match=words) as caught:
        identify(replace(frfs, **change(frfs)))
    assert "\n" not in str(caught.value)


@pytest.mark.parametrize(
    ("options", "words"),
    [
        ({"fmin": 500.0}, "0 frequency line"),
        ({"fmin": 50.0, "fmax": 50.0}, "is empty"),
        ({"max_order": 1}, "model order 1"),
    ],
)
def test_options_that_leave_nothing_are_refused(frfs, options, words):
    with pytest.raises(InputError, match=words):
        identify(frfs, **options)


def test_a_model_order_out_of_reach_is_said(frfs):
    found = identify(frfs, max_order=500)
    assert "the model order 500 is bounded at 90, the most for 2 reference(s)" in found.warnings


def test_a_line_at_zero_hertz_is_left_out(frfs):
    f = np.concatenate([[0.0], frfs.frequencies_hz])
    values = np.concatenate([frfs.values[:, :, :1], frfs.values], axis=2)
    assert prepare(replace(frfs, frequencies_hz=f, values=values)).frequencies_hz[0] > 0.0


def test_noise_is_estimated_beside_resonances(survey):
    frfs, truth = survey(4, noise=0.02, n_response=10, n_line=2000)
    assert noise_levels(frfs.values) == pytest.approx(truth.noise_std[:, :, 0], rel=0.15)


def test_the_input_is_not_changed(frfs):
    before = frfs.values.copy()
    identify(frfs)
    assert np.array_equal(frfs.values, before, equal_nan=True)


def test_more_references_than_responses_is_a_roving_hammer(frfs):
    roving = replace(
        frfs,
        values=frfs.values.transpose(1, 0, 2),
        responses=frfs.references,
        references=frfs.responses,
    )
    found = prepare(roving)
    assert found.roving_hammer
    assert "roving-hammer" in found.warnings[0]
    assert list(found.outputs.node) == list(frfs.responses.node)
    assert list(found.inputs.node) == list(frfs.references.node)


def test_labels_of_rotations_are_theirs():
    assert Dofs([7], [4]).labels == ["7:RX"]
