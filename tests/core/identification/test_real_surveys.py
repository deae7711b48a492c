"""Surveys that were not made for these tests; skipped where the data are absent."""

import json
import re
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from trueup.adapters.universal import read_universal
from trueup.core.identification.identify import identify

DATA = Path(__file__).resolve().parents[4] / "shared" / "data"
GARTEUR = DATA / "uff" / "garteur_frf_1995.uff"
DUCT = DATA / "cases" / "duct"
AEROPLANE = DATA / "measured" / "aeroplane" / "survey.uff"


def needs(path):
    return pytest.mark.skipif(not path.exists(), reason=f"real data absent: {path.name}")


@pytest.fixture(scope="module")
def garteur():
    content = read_universal([GARTEUR, DATA / "uff" / "garteur_geometry.unv"])
    return identify(content.frfs, geometry=content.geometry)


@pytest.fixture(scope="module")
def duct():
    return identify(read_universal([DUCT / "duct_frf.unv"]).frfs)


@needs(GARTEUR)
def test_garteur_all_nine_roots(garteur):
    """GARTEUR SM-AG19, DLR test of October 1995, one reference, two close pairs."""
    known = [6.5, 16.4, 33.5, 34.0, 36.1, 49.4, 50.2, 55.6, 64.2]
    found = garteur.modes.frequencies_hz
    nearest = [int(np.argmin(np.abs(found - f))) for f in known]
    assert len(set(nearest)) == 9
    assert found[nearest] == pytest.approx(known, rel=5e-3)
    assert len(found) == 10  # and the small one near 9 Hz that the functions do hold
    assert garteur.close_pair_possible.all()
    assert garteur.quality.min() > 0.999
    np.testing.assert_array_equal(garteur.real_modes.doubted, np.abs(found - 9.0) < 0.1)


@needs(GARTEUR)
def test_garteur_modal_masses_by_the_wing_tip(garteur):
    """Reference 12 is the point of response 1012; total mass 44 kg, so modal masses are of that
    order."""
    mass = garteur.real_modes.generalized_mass
    assert np.isfinite(mass).sum() >= 8
    assert 1.0 < np.nanmedian(mass) < 44.0


@needs(DUCT)
def test_duct_every_mode_of_the_truth_and_nothing_else(duct):
    truth = json.loads((DUCT / "truth.json").read_text())
    exact, damping = np.array(truth["exact_hz"]), np.array(truth["damping"])
    inside = (exact > 25.0) & (exact < 260.0)
    found = (duct.modes.frequencies_hz > 25.0) & (duct.modes.frequencies_hz < 260.0)
    assert duct.modes.frequencies_hz[found] == pytest.approx(exact[inside], rel=1e-5)
    assert duct.modes.damping[found] == pytest.approx(damping[inside], rel=1e-2)
    assert len(duct.modes) == len(exact)
    assert duct.remarks == ("",) * len(exact)
    assert np.isfinite(duct.real_modes.generalized_mass).all()


@needs(DUCT)
def test_duct_shapes_span_those_of_the_modal_test(duct):
    """The modal test is itself 2 % noisy; clusters are modes closer than 1 %.

    Three nodes carry two sensors of one direction: the FRF file holds both, of which the first is
    taken, and the modal test the reading of one.
    """
    test = read_universal([DUCT / "duct_test.unv"]).modes
    again = read_universal([DUCT / "duct_frf.unv"]).skipped
    dofs = duct.real_modes.dofs
    measured = np.zeros((len(dofs), len(test)))
    for row in range(len(dofs)):
        here = np.flatnonzero(test.dofs.node == dofs.node[row])
        measured[row] = dofs.axis[row] @ (test.dofs.axis[here].T @ test.shapes[here])
    twice = np.isin(dofs.node, [int(re.search(r"response (\d+):", s.what)[1]) for s in again])
    assert twice.sum() == 3
    for k in range(len(test)):
        near = np.abs(duct.modes.frequencies_hz / duct.modes.frequencies_hz[k] - 1.0) < 0.01
        shapes, t = duct.real_modes.shapes[:, near], measured[:, k]
        c, left, _, _ = np.linalg.lstsq(shapes[~twice], t[~twice], rcond=None)
        assert 1.0 - left[0] / np.sum(t[~twice] ** 2) > 0.99
        assert t[twice] == pytest.approx(shapes[twice] @ c, abs=0.05 * np.abs(t).max())


@pytest.fixture(scope="module")
def aeroplane():
    content = read_universal([AEROPLANE])
    return identify(content.frfs, fmin=15.0, fmax=180.0, geometry=content.geometry)


@needs(AEROPLANE)
def test_a_roving_hammer_survey_gives_each_mode_once(aeroplane):
    """Thirteen modes that two teams found with tools of their own."""
    known = [18.84, 40.18, 87.74, 89.63, 97.53, 105.19, 117.91, 125.20, 125.69, 129.74, 135.12,
             143.37, 166.27]  # fmt: skip
    found = aeroplane.modes.frequencies_hz
    nearest = [int(np.argmin(np.abs(found - f))) for f in known]
    assert len(set(nearest)) == 13
    assert found[nearest] == pytest.approx(known, abs=0.3)
    more = [r for k, r in enumerate(aeroplane.remarks) if k not in nearest]
    assert len(more) <= 2
    assert all(more)
    assert aeroplane.mpc[nearest].min() > 0.9
    assert not aeroplane.modes.doubted[nearest].any()


@needs(AEROPLANE)
def test_what_a_survey_holds_besides_is_rejected_with_its_reason(aeroplane):
    """The resonances of the pair at 125 Hz come again; the valley at 29 Hz holds errors only."""
    rejected = aeroplane.rejected
    assert len(rejected) > 10
    again = [r for r in rejected if 125.0 < r.frequency_hz < 126.5]
    assert len(again) >= 2
    assert all("no second direction beside the resonance" in r.reason for r in again)
    assert any("errors of the survey" in r.reason for r in rejected if r.frequency_hz < 35.0)


@needs(AEROPLANE)
def test_a_root_of_the_chart_is_held_where_the_functions_would_draw_it_away():
    frfs = read_universal([AEROPLANE]).frfs
    found = identify(frfs, fmin=15.0, fmax=60.0)
    never = [r.frequency_hz for r in found.rejected if "explains no more" in r.reason]
    taken = identify(frfs, fmin=15.0, fmax=60.0, take=never[:1])
    assert np.abs(taken.modes.frequencies_hz / never[0] - 1.0).min() < 5e-3
    assert len(taken.modes) == len(found.modes) + 1
    assert any("is held where the stabilisation chart has it" in w for w in taken.warnings)


@needs(AEROPLANE)
def test_roots_that_another_range_lists_as_rejected_can_be_taken(aeroplane):
    frfs = read_universal([AEROPLANE]).frfs
    listed = [r.frequency_hz for r in aeroplane.rejected if 84.5 < r.frequency_hz < 124.0]
    taken = identify(frfs, fmin=80.0, fmax=130.0, take=listed)
    for hz in listed:
        assert np.abs(taken.modes.frequencies_hz / hz - 1.0).min() < 5e-3


@pytest.mark.slow
@needs(AEROPLANE)
def test_halves_of_a_survey_agree_within_their_errors(aeroplane):
    """Every other point, and the rest: modes of both halves differ by what their errors say."""
    frfs = read_universal([AEROPLANE]).frfs
    halves = [
        identify(
            replace(
                frfs,
                values=frfs.values[:, first::2],
                references=frfs.references.take(np.arange(first, len(frfs.references), 2)),
            ),
            fmin=15.0,
            fmax=180.0,
        )
        for first in (0, 1)
    ]
    off = []
    for hz in aeroplane.modes.frequencies_hz:
        a, b = (int(np.argmin(np.abs(h.modes.frequencies_hz - hz))) for h in halves)
        one, two = halves
        pair = one.modes.frequencies_hz[a] - two.modes.frequencies_hz[b]
        if abs(pair) < 0.5:
            z = one.modes.damping[a] - two.modes.damping[b]
            f_std = np.hypot(one.frequency_std[a], two.frequency_std[b])
            z_std = np.hypot(one.damping_std[a], two.damping_std[b])
            off.append((pair / f_std, z / z_std))
    assert len(off) == 13
    assert np.mean(np.abs(off) < 2.0) > 0.9


def _file_cut_in_half(values):
    """All functions of the first response, those of the second to half of the points."""
    values[1, 36:] = values[2] = np.nan


def _part_of_the_range(values):
    values.reshape(-1, values.shape[2])[:25, 200:897] = np.nan  # 25 to 112 Hz


def _functions_that_end_early(values):
    values.reshape(-1, values.shape[2])[:50] = np.nan


@pytest.mark.slow
@needs(AEROPLANE)
@pytest.mark.parametrize("lose", [_file_cut_in_half, _part_of_the_range, _functions_that_end_early])
def test_what_a_real_survey_lacks_doubles_and_invents_nothing(aeroplane, lose):
    content = read_universal([AEROPLANE])
    values = np.array(content.frfs.values)
    lose(values)
    found = identify(
        replace(content.frfs, values=values), fmin=15.0, fmax=180.0, geometry=content.geometry
    )
    known = aeroplane.modes.frequencies_hz
    assert found.modes.frequencies_hz == pytest.approx(known, abs=0.3)
    said = [w for w in found.warnings if "combinations of response" in w or "no value" in w]
    assert len(said) == 1


@pytest.mark.slow
@needs(AEROPLANE)
def test_a_real_survey_as_receptance_gives_the_same_modes(aeroplane):
    content = read_universal([AEROPLANE])
    frfs = content.frfs
    s = 2j * np.pi * np.maximum(frfs.frequencies_hz, 1e-9)
    receptance = replace(frfs, values=frfs.values / s**2, quantity="displacement")
    found = identify(receptance, fmin=15.0, fmax=180.0, geometry=content.geometry)
    assert found.modes.frequencies_hz == pytest.approx(aeroplane.modes.frequencies_hz, rel=1e-6)
    assert found.modes.damping == pytest.approx(aeroplane.modes.damping, rel=1e-4)
    assert found.frac == pytest.approx(aeroplane.frac, abs=1e-5)


@pytest.mark.slow
@needs(AEROPLANE)
def test_a_narrow_band_of_a_real_survey_holds_its_three_modes():
    content = read_universal([AEROPLANE])
    found = identify(content.frfs, fmin=120.0, fmax=131.0, geometry=content.geometry)
    assert found.modes.frequencies_hz == pytest.approx([125.20, 125.69, 129.74], abs=0.3)
