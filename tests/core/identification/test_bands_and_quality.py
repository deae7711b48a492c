"""Indicators with known answers."""

from itertools import pairwise

import numpy as np
import pytest

from trueup.core.identification.poles.complete_blocks import complete_blocks
from trueup.core.identification.quality import (
    correlation,
    multivariate_indicator,
    phase_collinearity,
    phase_deviation,
)
from trueup.core.identification.survey.modal_synthesis import modal_response, poles_from
from trueup.core.identification.survey.mode_indicator import cmif, peaks, split
from trueup.core.identification.survey.survey_data import prepare


def test_cmif_is_the_singular_values_line_by_line():
    rng = np.random.default_rng(0)
    values = rng.standard_normal((6, 2, 5)) + 1j * rng.standard_normal((6, 2, 5))
    found = cmif(values)
    assert found.shape == (5, 2)
    assert found[3] == pytest.approx(np.linalg.svd(values[:, :, 3])[1])


def test_bands_tile_the_range_and_hold_few_peaks(survey):
    frfs, _ = survey(2, n_mode=40, band=(20, 200), n_line=4000, n_response=20)
    indicator = cmif(prepare(frfs).values)
    floor = np.sqrt(20.0) + np.sqrt(2.0)
    bands = split(frfs.frequencies_hz, indicator, floor)
    assert len(bands) > 2
    assert bands[0].low == 20.0
    assert bands[-1].high == 200.0
    for a, b in pairwise(bands):
        assert a.high == b.low
        assert b.first < b.low
        assert a.last > a.high
    at = frfs.frequencies_hz[peaks(indicator, floor)]
    assert max(np.count_nonzero((at >= b.low) & (at <= b.high)) for b in bands) <= 10


def test_no_band_is_narrow_for_its_modes(survey):
    """Many close modes of 2 % damping on fine lines: few peaks a band is not worth a mode cut."""
    frfs, _ = survey(3, n_mode=24, damping=(0.02, 0.02), n_line=8000, n_response=20)
    indicator = cmif(prepare(frfs).values)
    bands = split(frfs.frequencies_hz, indicator, np.sqrt(20.0) + np.sqrt(2.0))
    for b in bands:
        assert b.last - b.first > 8.0 * 2.0 * 0.02 * 0.5 * (b.low + b.high) or len(bands) == 1


def test_two_equal_roots_peak_in_two_singular_values():
    f = np.linspace(40.0, 60.0, 401)
    shapes = np.eye(4)[:, :2].astype(complex)
    values = modal_response(f, poles_from([50.0, 50.0], [0.01, 0.01]), shapes, np.eye(2) + 0j)
    assert list(f[peaks(cmif(values), 1e-6)]) == pytest.approx([50.0, 50.0], abs=0.05)


def test_every_input_takes_part_in_some_complete_block():
    measured = np.ones((30, 3), bool)
    measured[:14, 2] = False
    measured[14:28, 0] = False
    blocks = complete_blocks(measured)
    seen = np.zeros_like(measured)
    for rows, columns in blocks:
        assert measured[np.ix_(rows, columns)].all()
        seen[np.ix_(rows, columns)] = True
    assert seen.any(axis=0).all()
    assert np.count_nonzero(seen.any(axis=1)) > 25


def test_phase_collinearity_and_deviation():
    """A normal mode at any phase; equal parts in quadrature; 30 degrees to either side."""
    rng = np.random.default_rng(0)
    real = rng.standard_normal(50)
    shapes = np.array(
        [
            real * np.exp(0.7j),
            np.concatenate([np.ones(25), 1j * np.ones(25)]),
            np.concatenate(
                [np.full(25, np.exp(1j * np.pi / 6)), np.full(25, np.exp(-1j * np.pi / 6))]
            ),
        ]
    ).T
    assert phase_collinearity(shapes) == pytest.approx([1.0, 0.0, 0.25])
    assert phase_deviation(shapes)[[0, 2]] == pytest.approx([0.0, 30.0], abs=1e-6)


def test_mode_indicator_dips_at_a_normal_mode_only():
    f = np.linspace(40.0, 60.0, 401)
    poles = poles_from([50.0], [0.01])
    shapes = np.array([[1.0], [-0.5], [0.3]]) + 0j
    values = modal_response(f, poles, shapes, shapes[:2] / (2j * poles.imag))
    found = multivariate_indicator(values)
    assert f[np.argmin(found)] == pytest.approx(50.0, abs=0.1)
    assert found.min() < 0.01
    assert found[0] > 0.9


def test_correlation_ignores_scale_and_sees_noise():
    rng = np.random.default_rng(0)
    h = rng.standard_normal(2000) + 1j * rng.standard_normal(2000)
    assert correlation(h, 3.0 * h) == pytest.approx(1.0)
    e = rng.standard_normal(2000) + 1j * rng.standard_normal(2000)
    assert correlation(h, h + e) == pytest.approx(0.5, abs=0.05)
    assert correlation(h, 0.0 * h) == 0.0
