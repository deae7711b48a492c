"""Surveys of known truth: every mode found, nothing else, with honest errors."""

from dataclasses import replace

import numpy as np
import pytest

from trueup.core.data.dofs import Dofs
from trueup.core.identification.identify import identify
from trueup.core.identification.survey.modal_synthesis import modal_response, poles_from
from trueup.core.identification.uncertainty.uncertainty_numbers import UNCERTAINTY


def subspace_mac(a, b):
    """Smallest squared cosine between two subspaces."""
    qa, qb = np.linalg.qr(a)[0], np.linalg.qr(b)[0]
    return float(np.linalg.svd(qa.conj().T @ qb)[1].min() ** 2)


def mac(a, b):
    return np.abs(np.vdot(a, b)) ** 2 / (np.vdot(a, a).real * np.vdot(b, b).real)


def assert_found(result, truth, frequency=1e-3, damping=0.1, shape=0.99):
    order = np.argsort(truth.frequencies_hz)
    assert result.modes.frequencies_hz == pytest.approx(truth.frequencies_hz[order], rel=frequency)
    assert result.modes.damping == pytest.approx(truth.damping[order], rel=damping)
    rows = result.modes.dofs.node - 1
    for k, j in enumerate(order):
        assert mac(result.modes.shapes[:, k], truth.shapes[rows, j]) > shape


@pytest.mark.parametrize("quantity", ["displacement", "velocity", "acceleration"])
def test_any_quantity_gives_the_same_modes_and_masses(survey, quantity):
    frfs, truth = survey(11, n_mode=6, n_response=20, n_line=1000, quantity=quantity)
    result = identify(frfs)
    assert_found(result, truth)
    assert result.quality.min() > 0.99
    assert result.remarks == ("",) * 6
    assert not result.close_pair_possible.any()
    order = np.argsort(truth.frequencies_hz)
    mass = (truth.mass / np.abs(truth.shapes).max(axis=0) ** 2)[order]
    assert result.real_modes.generalized_mass == pytest.approx(mass, rel=0.02)
    assert np.abs(result.real_modes.shapes).max(axis=0) == pytest.approx(np.ones(6))


@pytest.mark.parametrize("order", [1, 2])
def test_the_kind_of_motion_changes_nothing(survey, order):
    """One test, written as accelerances, mobilities (order 1) or receptances (order 2)."""
    frfs, _ = survey(11, n_mode=6, n_response=20, n_line=1000, band=(5.0, 100.0), noise=0.05)
    known = identify(frfs)
    again = replace(
        frfs,
        values=frfs.values / (2j * np.pi * frfs.frequencies_hz) ** order,
        quantity=["velocity", "displacement"][order - 1],
    )
    found = identify(again)
    same = {"rel": 1e-6, "abs": 1e-9}
    assert found.modes.frequencies_hz == pytest.approx(known.modes.frequencies_hz, **same)
    assert found.modes.damping == pytest.approx(known.modes.damping, **same)
    assert found.real_modes.generalized_mass == pytest.approx(
        known.real_modes.generalized_mass, **same
    )
    for name in ("frequency_std", "shape_std", "mode_indicator", "quality", "frac"):
        assert getattr(found, name) == pytest.approx(getattr(known, name), **same)
    assert found.remarks == known.remarks
    assert found.warnings == known.warnings
    shares = [[d.positive_share for d in one.driving_points] for one in (found, known)]
    assert shares[0] == pytest.approx(shares[1], **same)
    assert found.synthesised().quantity == found.measured.quantity == again.quantity
    assert found.measured.values == pytest.approx(again.values, **same)
    size = np.abs(again.values).max()
    assert np.abs(found.synthesised().values - again.values).max() < 0.2 * size


@pytest.mark.parametrize(
    "options",
    [
        {"noise": 0.0},
        {"noise": 0.1},
        {"noise": 0.03, "noise_kind": "multiplicative"},
        {"missing": 0.3, "n_reference": 3},
        {"damping": (0.01, 0.05)},
        {"damping": (0.0005, 0.002)},
        {"n_response": 6},
        {"n_reference": 1},
        {"complexity": 0.3},
        {"n_line": 300},
    ],
    ids=str,
)
def test_every_mode_and_nothing_else(survey, options):
    frfs, truth = survey(12, **{"n_mode": 6, "n_response": 20, "n_line": 1000, **options})
    assert_found(identify(frfs), truth)


@pytest.mark.slow
@pytest.mark.parametrize("seed", range(6))
@pytest.mark.parametrize(
    "options",
    [
        {"n_mode": 30},
        {"n_mode": 20, "n_reference": 1},
        {"n_mode": 40, "n_reference": 3, "noise": 0.05, "band": (20, 200), "n_line": 2000},
        {"n_mode": 12, "missing": 0.3, "n_reference": 3},
        {"n_mode": 30, "band": (2, 500), "n_line": 6000},
    ],
    ids=str,
)
def test_dense_and_wide_surveys(survey, seed, options):
    frfs, truth = survey(200 + seed, **options)
    result = identify(frfs)
    order = np.argsort(truth.frequencies_hz)
    assert result.modes.frequencies_hz == pytest.approx(truth.frequencies_hz[order], rel=1e-3)
    off = (result.modes.frequencies_hz - truth.frequencies_hz[order]) / result.frequency_std
    assert np.sqrt(np.mean(off**2)) < 2.0


@pytest.mark.parametrize("apart", [0.003, 0.0])
def test_a_pair_is_separated_by_two_references(survey, apart):
    """Roots 0.3 % apart (and equal ones) at 0.5 % damping, two references, 1 % noise."""
    frfs, truth = survey(
        21,
        frequencies=[50.0, 50.0 * (1 + apart)],
        damping=(0.005, 0.005),
        noise=0.01,
        n_response=20,
        band=(42, 58),
        n_line=500,
    )
    result = identify(frfs)
    assert len(result.modes) == 2
    assert result.modes.frequencies_hz == pytest.approx(truth.frequencies_hz, rel=2e-4)
    assert subspace_mac(result.modes.shapes, truth.shapes) > 0.999
    assert subspace_mac(result.real_modes.shapes, truth.shapes) > 0.999
    assert not result.close_pair_possible.any()


def test_one_reference_says_that_a_pair_may_hide(survey):
    frfs, _ = survey(
        21,
        frequencies=[50.0, 50.0],
        damping=(0.005, 0.005),
        n_reference=1,
        n_response=20,
        band=(42, 58),
        n_line=500,
    )
    result = identify(frfs)
    assert len(result.modes) == 1
    assert result.close_pair_possible.all()
    assert any("close pair may hide" in w for w in result.warnings)


def test_a_sensor_that_cannot_see_a_mode_spoils_no_other(survey):
    """One reference stands on a node line of mode 2, and one sensor was measured with it only."""
    frfs, truth = survey(23, frequencies=[40.0, 60.0], n_response=12, n_line=600, outside=False)
    poles = poles_from(truth.frequencies_hz, truth.damping)
    shapes = truth.shapes.copy()
    shapes[0, 1] = 0.0
    part = shapes[[0, 11]] / (2j * poles.imag * truth.mass)
    values = modal_response(frfs.frequencies_hz, poles, shapes, part)
    rng = np.random.default_rng(0)
    e = rng.standard_normal(values.shape) + 1j * rng.standard_normal(values.shape)
    values += 0.01 * np.sqrt(np.mean(np.abs(values) ** 2, axis=2, keepdims=True)) * e
    values[7, 1] = np.nan
    result = identify(replace(frfs, values=values))
    assert "hardly known at 8:Z" in result.remarks[1]
    assert result.remarks[0] == ""
    others = np.arange(12) != 7
    assert mac(result.real_modes.shapes[others, 1], shapes[others, 1].real) > 0.999
    assert result.shape_std[others, 1].max() < 0.02
    assert result.shape_std[7, 1] > 0.5
    assert np.abs(result.real_modes.shapes[others, 1]).max() == pytest.approx(1.0)
    assert result.mpc[1] > 0.99


def test_references_that_see_one_and_the_same_count_as_one(survey):
    frfs, _ = survey(22, n_mode=4, n_response=15, n_line=600)
    values = np.array(frfs.values)
    rng = np.random.default_rng(0)
    e = rng.standard_normal(values[:, 0].shape) + 1j * rng.standard_normal(values[:, 0].shape)
    values[:, 1] = 2.0 * values[:, 0] + 0.01 * np.abs(values[:, 0]).mean() * e
    result = identify(replace(frfs, values=values))
    assert result.close_pair_possible.all()
    assert any("same combination" in w for w in result.warnings)


def test_roving_hammer_gives_the_same_modes(survey):
    frfs, truth = survey(13, n_mode=5, n_response=15, n_line=800)
    roving = replace(
        frfs,
        values=frfs.values.transpose(1, 0, 2),
        responses=frfs.references,
        references=frfs.responses,
    )
    result = identify(roving)
    assert_found(result, truth)
    assert np.isfinite(result.real_modes.generalized_mass).all()


def test_references_under_each_others_name_are_named_and_exchanged(survey):
    frfs, truth = survey(13, n_mode=5, n_response=15, n_line=800)
    result = identify(replace(frfs, references=frfs.references.take(np.array([1, 0]))))
    assert_found(result, truth)
    assert np.isfinite(result.real_modes.generalized_mass).all()
    assert [f.kind for f in result.faults] == ["swapped_references"]
    assert any("under each other's name" in w for w in result.warnings)


@pytest.mark.parametrize("wrong", [np.inf, 1.79e308, np.nan])
def test_a_function_with_a_value_that_is_no_number_is_left_out(survey, wrong):
    frfs, truth = survey(13, n_mode=5, n_response=15, n_line=800)
    values = frfs.values.copy()
    values[3, 1, 100] = wrong
    result = identify(replace(frfs, values=values))
    assert_found(result, truth)
    assert any("has no value (not finite, or nil)" in w for w in result.warnings)


def test_a_response_listed_twice_and_one_reversed(survey):
    """The same sensor measured again, and another mounted backwards (its axis says so)."""
    frfs, truth = survey(13, n_mode=5, n_response=15, n_line=800)
    values = np.concatenate([frfs.values, frfs.values[:1]])
    values[4] *= -1.0
    axis = np.tile([0.0, 0.0, 1.0], (16, 1))
    axis[4] *= -1.0
    node = np.append(frfs.responses.node, 1)
    result = identify(replace(frfs, values=values, responses=Dofs(node, np.full(16, 3), axis)))
    assert result.modes.frequencies_hz == pytest.approx(truth.frequencies_hz, rel=1e-3)
    straight = result.real_modes.shapes * axis[:, 2:]
    for k in range(5):
        assert mac(straight[:15, k], truth.shapes[:, k]) > 0.999
    assert result.real_modes.shapes[15] == pytest.approx(result.real_modes.shapes[0], abs=1e-3)


def test_a_line_without_modes_gives_none():
    """The mass line of a free body with 1 % noise: no mode, and it says so."""
    from trueup.core.data.frfs import Frfs

    f = np.linspace(10.0, 100.0, 600)
    rng = np.random.default_rng(0)
    e = rng.standard_normal((8, 2, 600)) + 1j * rng.standard_normal((8, 2, 600))
    values = rng.standard_normal((8, 2, 1)) * (1.0 + 0.3 * (f / 100.0) ** 2) + 0.01 * e
    dofs = Dofs(np.arange(1, 9), np.full(8, 3))
    result = identify(Frfs(f, dofs, dofs.take(np.array([0, 7])), values))
    assert len(result.modes) == 0
    assert result.warnings == ("no mode stands out of the noise",)
    assert result.synthesised().values == pytest.approx(values, abs=0.06)


def test_synthesised_functions_leave_the_noise(survey):
    frfs, truth = survey(14, n_mode=8, n_response=15, noise=0.03)
    made = identify(frfs).synthesised()
    assert made.values.shape == frfs.values.shape
    left = np.sqrt(np.mean(np.abs(made.values - frfs.values) ** 2, axis=2))
    assert left == pytest.approx(truth.noise_std[:, :, 0], rel=0.1)
    elsewhere = identify(frfs).synthesised(np.array([30.0, 50.0]))
    assert elsewhere.values.shape == (15, 2, 2)


def test_standard_errors_cover_the_truth(survey):
    """Where the noise is what limits them; below it stands the error of the measuring chain."""
    off = []
    for seed in range(4):
        frfs, truth = survey(40 + seed, n_mode=6, n_response=15, n_line=800, noise=0.2)
        result = identify(frfs)
        order = np.argsort(truth.frequencies_hz)
        off += list(
            (result.modes.frequencies_hz - truth.frequencies_hz[order]) / result.frequency_std
        )
        off += list((result.modes.damping - truth.damping[order]) / result.damping_std)
        for k, j in enumerate(order):
            t = truth.shapes[:, j].real
            phi, std = result.real_modes.shapes[:, k], result.shape_std[:, k]
            t = t * (phi @ t) / (t @ t)
            off += list((phi - t) / std)
    assert 0.85 < np.sqrt(np.mean(np.square(off))) < 1.2


def test_functions_without_noise_are_no_better_than_a_measuring_chain(survey):
    """Computed functions give small errors, not none, and are called what they are."""
    frfs, truth = survey(11, n_mode=6, n_response=20, n_line=1000, noise=0.0)
    result = identify(frfs)
    order = np.argsort(truth.frequencies_hz)
    best = UNCERTAINTY.chain * truth.damping[order]
    assert (result.frequency_std >= 0.99 * best * truth.frequencies_hz[order]).all()
    assert (result.damping_std >= 0.99 * best).all()
    assert result.frequency_std.max() < 1e-4 * truth.frequencies_hz.max()
    assert result.shape_std.min() >= UNCERTAINTY.chain
    assert any("seem computed" in w for w in result.warnings)
    noisy = identify(survey(11, n_mode=6, n_response=20, n_line=1000, noise=0.001)[0])
    assert not any("seem computed" in w for w in noisy.warnings)


def windowed(frfs, kernel):
    """Functions as random excitation with a window gives them: blurred over the lines beside."""
    kernel = np.asarray(kernel) / np.sum(kernel)
    blurred = np.apply_along_axis(np.convolve, 2, frfs.values, kernel, "same")
    return replace(
        frfs, values=blurred[..., 1:-1], frequencies_hz=np.array(frfs.frequencies_hz[1:-1])
    )


def test_leakage_splits_no_mode_and_is_named(survey):
    """Modes about as narrow as two lines, a Hann window's kernel, noise of its own.

    The damping comes out too high, which nothing can undo; its standard error must say so.
    """
    frfs, truth = survey(31, n_mode=6, n_response=30, n_line=800, damping=(0.002, 0.003), noise=0.0)
    blurred = windowed(frfs, [1, 4, 1])
    rng = np.random.default_rng(3)
    rms = np.sqrt(np.mean(np.abs(blurred.values) ** 2))
    e = rng.standard_normal(blurred.values.shape) + 1j * rng.standard_normal(blurred.values.shape)
    result = identify(replace(blurred, values=blurred.values + 0.005 * rms * e))
    order = np.argsort(truth.frequencies_hz)
    assert result.modes.frequencies_hz == pytest.approx(truth.frequencies_hz[order], rel=2e-4)
    assert any("leakage" in w for w in result.warnings)
    off = (result.modes.damping - truth.damping[order]) / result.damping_std
    assert np.abs(off).max() < 6.0
    assert (result.damping_std < result.modes.damping).all()


def test_what_one_sharp_function_hardly_shows_is_no_mode(survey):
    """A clean single function with ripples of 2 % between its modes, as hammer tests have."""
    frfs, truth = survey(
        5, frequencies=[30.0, 50.0, 80.0], n_response=1, n_reference=1, n_line=1600, noise=1e-4
    )
    f = frfs.frequencies_hz
    ripple = 1.0 + 0.02 * np.exp(-(((f - 64.0) / 0.4) ** 2)) * np.exp(1j * f)
    result = identify(replace(frfs, values=frfs.values * ripple))
    assert result.modes.frequencies_hz == pytest.approx(truth.frequencies_hz, rel=1e-3)


def test_a_permuted_result_is_another_result(survey):
    """Guards the tests above: shapes in another order must not pass for the truth."""
    frfs, truth = survey(11, n_mode=6, n_response=20, n_line=1000)
    result = identify(frfs)
    wrong = replace(truth, shapes=truth.shapes[::-1])
    with pytest.raises(AssertionError):
        assert_found(result, wrong)


def test_chart_and_indicator_fit_together(survey):
    frfs, truth = survey(11, n_mode=6, n_response=20, n_line=1000)
    result = identify(frfs)
    chart = result.chart
    assert len(chart.order) == len(chart.frequency_hz) == len(chart.damping) == len(chart.stable)
    for f in truth.frequencies_hz:
        near = np.abs(chart.frequency_hz - f) < 0.002 * f
        assert np.count_nonzero(near & chart.stable) > 5
    assert result.cmif.values.shape == (1000, 2)
    assert result.cmif.values[:, 0] == pytest.approx(
        np.linalg.norm(frfs.values, 2, axis=(0, 1)), rel=1e-6
    )
