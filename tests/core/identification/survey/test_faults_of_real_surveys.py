"""Faults put into a real roving-hammer survey are named; on surveys in order nothing is."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from benchmarks.imperfect_surveys import KINDS, survey

from trueup.adapters.universal import read_universal
from trueup.core.identification.survey.check_survey import checked
from trueup.core.identification.survey.survey_data import prepare

DATA = Path(__file__).resolve().parents[5] / "shared" / "data"
AEROPLANE = DATA / "measured" / "aeroplane" / "survey.uff"
GARTEUR = [DATA / "uff" / "garteur_frf_1995.uff", DATA / "uff" / "garteur_geometry.unv"]
DUCT = [DATA / "cases" / "duct" / "duct_frf.unv"]
needs_data = pytest.mark.skipif(not AEROPLANE.exists(), reason="real data absent")


@pytest.fixture(scope="module")
def aeroplane():
    return read_universal([AEROPLANE])


def in_band(content, frfs=None, geometry=True):
    given = prepare(content.frfs if frfs is None else frfs, [(15.0, 180.0)])
    return checked(given, content.geometry if geometry else None)


def changed(content, change, references=(0, 1, 2), geometry=True):
    """Return the survey with its values (3 accelerometers, 74 hammer points, lines) changed."""
    values = np.array(content.frfs.values)
    change(values)
    frfs = replace(content.frfs, values=values).at(np.array(references))
    return in_band(content, frfs, geometry)


def turn(*places):
    def change(values):
        for place in places:
            values[place] *= -1.0

    return change


@needs_data
@pytest.mark.parametrize("files", [[AEROPLANE], GARTEUR, GARTEUR[:1], DUCT], ids=str)
def test_real_surveys_and_those_of_cases_have_no_fault(files):
    content = read_universal(files)
    assert checked(prepare(content.frfs), content.geometry).faults == ()


@needs_data
@pytest.mark.parametrize("references", [(0,), (1,), (2,), (0, 1), (0, 2), (1, 2)])
def test_a_part_of_the_survey_has_no_fault(aeroplane, references):
    assert changed(aeroplane, lambda v: None, references).faults == ()


@needs_data
@pytest.mark.parametrize("ranges", [
    [(80.0, 140.0)], [(15.0, 60.0)], [(60.0, 150.0)], [(100.0, 170.0)],
    [(10.0, 45.0), (80.0, 180.0)],
])  # fmt: skip
def test_a_part_of_the_range_has_no_fault(aeroplane, ranges):
    assert checked(prepare(aeroplane.frfs, ranges), aeroplane.geometry).faults == ()


@pytest.mark.parametrize("kind", [k for k in KINDS if k != "flipped"])
def test_imperfect_surveys_have_no_fault(kind):
    assert checked(prepare(survey(7, kind)[0])).faults == ()


@needs_data
@pytest.mark.parametrize("place", [(0, 39), (0, 0), (1, 20), (2, 73), (2, 30), (1, 60)])
@pytest.mark.parametrize("references", [(0, 1, 2), (0, 1), (1, 2), (0, 2)])
def test_one_function_of_the_wrong_sign(aeroplane, place, references):
    if place[0] not in references:
        pytest.skip("not among these references")
    mended = changed(aeroplane, turn(place), references)
    (fault,) = mended.faults
    label = aeroplane.frfs.responses.labels[place[0]], aeroplane.frfs.references.labels[place[1]]
    assert (fault.kind, fault.functions, fault.done) == ("wrong_sign", ("/".join(label),), "turned")
    assert mended.values == pytest.approx(changed(aeroplane, lambda v: None, references).values)


@needs_data
def test_a_driving_point_that_contradicts_its_other_function(aeroplane):
    """Point 74 moves along Y, which accelerometer 102:Z hardly sees."""
    (fault,) = changed(aeroplane, turn((2, 73)), (1, 2)).faults
    assert (fault.kind, fault.functions, fault.done) == ("wrong_sign", ("74:Y/74:Y",), "turned")


@needs_data
def test_the_driving_point_of_one_reference_is_told_by_its_neighbours(aeroplane):
    (fault,) = changed(aeroplane, turn((0, 39)), (0,)).faults
    assert (fault.kind, fault.functions, fault.done) == ("wrong_sign", ("40:Z/40:Z",), "turned")


@needs_data
def test_the_driving_point_of_one_reference_is_said_where_there_are_no_positions(aeroplane):
    (fault,) = changed(aeroplane, turn((0, 39)), (0,), geometry=False).faults
    assert (fault.kind, fault.functions, fault.done) == ("wrong_sign", ("40:Z/40:Z",), "")


@needs_data
@pytest.mark.parametrize("pair", [[0, 1], [0, 2], [1, 2]])
def test_two_accelerometers_under_each_others_name(aeroplane, pair):
    def exchange(values):
        values[pair] = values[pair[::-1]]

    mended = changed(aeroplane, exchange)
    (fault,) = mended.faults
    assert (fault.kind, fault.done) == ("swapped_references", "exchanged")
    assert mended.values == pytest.approx(in_band(aeroplane).values)


@needs_data
@pytest.mark.parametrize("pair", [[0, 1], [0, 2]])
@pytest.mark.parametrize("points", [[11], [30, 31, 32], list(range(29, 39)), list(range(20))])
def test_two_accelerometers_under_each_others_name_at_some_points(aeroplane, pair, points):
    """Many that are exchanged alike pull aside what the others are held against."""

    def exchange(values):
        values[np.ix_(pair, points)] = values[np.ix_(pair[::-1], points)]

    mended = changed(aeroplane, exchange)
    (fault,) = mended.faults
    assert (fault.kind, fault.done) == ("swapped_references", "exchanged")
    assert len(fault.functions) == 2 * len(points)
    assert mended.values == pytest.approx(in_band(aeroplane).values)


@needs_data
@pytest.mark.parametrize("pair", [[2, 39], [0, 20], [8, 57]])
def test_two_hammer_points_under_each_others_name(aeroplane, pair):
    def exchange(values):
        values[:, pair] = values[:, pair[::-1]]

    mended = changed(aeroplane, exchange)
    (fault,) = mended.faults
    assert (fault.kind, fault.done) == ("swapped_points", "exchanged")
    assert mended.values == pytest.approx(in_band(aeroplane).values)


def _times(place, factor):
    def change(values):
        values[place] *= factor

    return change


@needs_data
@pytest.mark.parametrize(("place", "factor"), [
    ((0, 19), 1e3), ((1, 40), 1e-3), ((2, 33), 9.81), ((2, 3), 0.1), ((1, 30), 2.0), ((2, 10), 2.0),
])  # fmt: skip
def test_a_function_of_the_wrong_size_is_left_out(aeroplane, place, factor):
    mended = changed(aeroplane, _times(place, factor))
    (fault,) = mended.faults
    label = aeroplane.frfs.responses.labels[place[0]], aeroplane.frfs.references.labels[place[1]]
    assert (fault.kind, fault.functions) == ("wrong_gain", ("/".join(label),))
    assert fault.done == "left out"
    assert not mended.measured[mended.outputs.labels.index(label[1])].all()


@needs_data
@pytest.mark.parametrize(("point", "factor"), [(5, 1e-3), (10, 9.81), (19, 1e3), (39, 1e3)])
def test_a_hammer_point_of_the_wrong_size_is_left_out(aeroplane, point, factor):
    """Its functions agree among themselves; the neighbours do not."""
    mended = changed(aeroplane, _times((slice(None), point), factor))
    (fault,) = mended.faults
    label = aeroplane.frfs.references.labels[point]
    assert (fault.kind, fault.done) == ("wrong_gain", "left out")
    assert f"all functions of {label} are about" in fault.sentence
    assert label not in mended.outputs.labels


@needs_data
@pytest.mark.parametrize("reference", [0, 2])
def test_a_reference_of_the_wrong_size_is_not_reciprocal(aeroplane, reference):
    (fault,) = changed(aeroplane, _times(reference, 10.0)).faults
    assert (fault.kind, fault.done) == ("wrong_gain", "")
    assert fault.functions == ("74:Y/40:Z", "40:Z/74:Y")


@needs_data
def test_a_factor_that_all_functions_have_cannot_be_seen(aeroplane):
    assert changed(aeroplane, _times(slice(None), 1e3)).faults == ()


def _noise(rng, shape):
    return rng.standard_normal(shape) + 1j * rng.standard_normal(shape)


def _dead(values, rng):
    values[1, 20] = 1e-3 * np.convolve(_noise(rng, values.shape[2]), np.hanning(7), "same")


def _zero(values, rng):
    values[1, 20] = 0.0


def _constant(values, rng):
    values[1, 20] = 2.5


def _noisy(values, rng):
    values[1, 20] += 0.05 * np.abs(values[1, 20]).std() * _noise(rng, values.shape[2])


def _cut(values, rng):
    h = values[1, 20]
    values[1, 20] = h / np.maximum(np.abs(h) / (0.3 * np.abs(h).max()), 1.0)


def _cut_in_time(values, rng):
    h = np.fft.irfft(values[1, 20])
    values[1, 20] = np.fft.rfft(np.clip(h, -0.4 * h.max(), 0.4 * h.max()))


def _hit_twice(values, rng):
    values[:, 20] *= 1.0 + 0.5 * np.exp(-2j * np.pi * 0.125 * np.arange(values.shape[2]) * 0.02)


@needs_data
@pytest.mark.parametrize(("fault", "kind", "done"), [
    (_dead, "dead_channel", "left out"), (_zero, "dead_channel", "left out"),
    (_constant, "dead_channel", "left out"), (_noisy, "noise_floor", "left out"),
    (_cut, "overload", "left out"), (_cut_in_time, "overload", "left out"),
    (_hit_twice, "double_hit", "left out"),
])  # fmt: skip
@pytest.mark.parametrize("seed", range(2))
def test_a_function_that_is_worth_less(aeroplane, fault, kind, done, seed):
    found = changed(aeroplane, lambda v: fault(v, np.random.default_rng(seed))).faults
    assert [(f.kind, f.done) for f in found] == [(kind, done)]
    assert all(name.endswith("/21:Z") for name in found[0].functions)
    assert "21:Z" in found[0].sentence


@needs_data
def test_a_dead_accelerometer_is_named_and_the_others_are_enough(aeroplane):
    def dead(values):
        noise = _noise(np.random.default_rng(0), values[1].shape)
        values[1] = np.apply_along_axis(np.convolve, 1, noise, np.hanning(7), "same")

    mended = changed(aeroplane, dead)
    assert {f.kind for f in mended.faults} == {"dead_channel"}
    assert mended.inputs.labels == ["40:Z", "74:Y"]
