"""Noise that all points share, and machines that run: neither is a mode."""

from dataclasses import replace

import numpy as np
import pytest

from trueup.core.identification.identify import identify


def disturbed(frfs, shape, spectrum, share):
    """Add one shape times a spectrum before each reference, of a share of each function's rms."""
    rms = np.sqrt(np.mean(np.abs(frfs.values) ** 2, axis=2, keepdims=True))
    added = share * rms * shape[:, None, None] * spectrum
    return replace(frfs, values=frfs.values + added)


@pytest.fixture
def measured(survey):
    return survey(7, n_mode=4, n_response=30, n_line=800, noise=0.005)


def test_noise_of_one_shape_all_over_the_band_makes_no_mode(measured):
    frfs, truth = measured
    rng = np.random.default_rng(1)
    lines = rng.standard_normal((1, 2, 800)) + 1j * rng.standard_normal((1, 2, 800))
    kernel = np.hanning(9) / np.linalg.norm(np.hanning(9))
    lines = np.apply_along_axis(np.convolve, 2, lines, kernel, "same")
    found = identify(disturbed(frfs, rng.standard_normal(30), lines, 0.03))
    assert found.modes.frequencies_hz == pytest.approx(truth.frequencies_hz, rel=1e-3)
    assert any("noise that all points share" in r.reason for r in found.rejected)


def test_a_tone_in_all_functions_makes_no_mode(measured):
    frfs, truth = measured
    rng = np.random.default_rng(2)
    lines = np.zeros((1, 2, 800), complex)
    lines[..., 200], lines[..., 600] = 1.0, 1.0j
    lines[..., 199] = lines[..., 201] = 0.3
    found = identify(disturbed(frfs, rng.standard_normal(30), lines, 0.3))
    assert found.modes.frequencies_hz == pytest.approx(truth.frequencies_hz, rel=1e-3)
    assert any("a tone" in r.reason for r in found.rejected)
