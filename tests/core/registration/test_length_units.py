"""Length units: converted as declared, inferred aloud, refused when impossible."""

from dataclasses import replace

import numpy as np
import pytest

from trueup.core.data.dofs import Dofs
from trueup.core.data.geometry import Geometry
from trueup.core.data.length_units import METRES, length_factor, to_length_unit
from trueup.core.data.modes import Modes
from trueup.core.errors import InputError
from trueup.core.registration.length_units import reconcile_units


def plate(unit=None, side=900.0, n=10):
    """A square plate of `side` in its own unit, away from the origin."""
    x = 200 + side * np.linspace(0, 1, n + 1)
    xyz = np.array([[a, b, 50.0] for a in x for b in x])
    k = np.arange((n + 1) ** 2).reshape(n + 1, n + 1)
    quads = np.stack([k[:-1, :-1], k[1:, :-1], k[1:, 1:], k[:-1, 1:]], axis=-1).reshape(-1, 4)
    return Geometry(np.arange(len(xyz)) + 1, xyz, unit, {"quad": quads})


def sensors(scale, unit, share=1.0, shift=0.0):
    x = 200 + 900 * share * np.array([0.02, 0.3, 0.7, 0.98])
    xyz = np.array([[a, b, 50.0] for a in x for b in x])
    return Geometry(np.arange(16) + 1, xyz * scale + shift, unit)


@pytest.mark.parametrize(
    ("one", "other", "factor"),
    [("m", "mm", 1000), ("in", "mm", 25.4), ("m", "in", 39.3700787), ("ft", "m", 0.3048)],
)
def test_factors(one, other, factor):
    assert length_factor(one, other) == pytest.approx(factor)
    assert length_factor(one, one) == 1.0
    with pytest.raises(InputError, match="'cm' is not known; use m, mm, in or ft"):
        length_factor("cm", "m")


def test_conversion_scales_positions_and_displacements_but_not_rotations():
    shapes = np.arange(1.0, 13).reshape(6, 2)
    modes = Modes([1, 2], shapes, Dofs([1] * 6, range(1, 7)), generalized_mass=[1.0, np.nan])
    geometry, converted = to_length_unit(Geometry([1], [[1, 2, 3]], "m"), modes, "m", "mm")
    assert geometry.length_unit == "mm"
    np.testing.assert_array_equal(geometry.xyz, [[1000, 2000, 3000]])
    np.testing.assert_array_equal(converted.shapes[:3], 1000 * shapes[:3])
    np.testing.assert_array_equal(converted.shapes[3:], shapes[3:])
    assert converted.generalized_mass[0] == pytest.approx(1e6)
    assert np.isnan(converted.generalized_mass[1])
    assert to_length_unit(geometry, None, "mm", "m")[1] is None


@pytest.mark.parametrize("deck", METRES)
@pytest.mark.parametrize("measured", METRES)
def test_declared_units_that_agree_are_taken_silently(deck, measured):
    factor = METRES[deck] / METRES[measured]  # test numbers of the same plate
    units = reconcile_units(plate(deck), sensors(factor, measured))
    assert (units.deck, units.test, units.warnings) == (deck, measured, ())
    assert units.factor == pytest.approx(1 / factor)


@pytest.mark.parametrize(
    ("truth", "declared", "words"),
    [
        ("mm", "m", "1000 times smaller"),
        ("m", "mm", "1000 times larger"),
        ("mm", "in", "26 times smaller"),
        ("in", "mm", "24 times larger"),
        ("in", "m", "41 times smaller"),
        ("ft", "m", "3.4 times smaller"),
        ("m", "ft", "3.1 times larger"),
        ("mm", "ft", "320 times smaller"),
    ],
)
@pytest.mark.parametrize("shift", [0.0, 400.0], ids=["same frame", "other frame"])
def test_wrong_deck_unit_is_named_with_the_right_one(truth, declared, words, shift):
    test = sensors(METRES[truth], "m", shift=shift)
    if truth == "ft" and shift:  # a small test somewhere on a large model cannot be excluded
        units = reconcile_units(plate(declared), test)
        assert "times smaller than the model" in units.warnings[0]
        return
    number, _, way = words.partition(" ")
    with pytest.raises(InputError, match=f"deck_length_unit={truth}") as caught:
        reconcile_units(plate(declared), test)
    message = str(caught.value)
    assert way in message
    found = float(message.split(way)[0].split()[-1])
    assert found == pytest.approx(float(number), rel=0.1)


@pytest.mark.parametrize("declared", ["in", "ft"])
def test_a_test_that_shrinks_to_a_corner_of_the_model_does_not_count_as_lying_on_it(declared):
    """A plate at the origin: by any unit all its sensors are on it; by millimetres all over it."""
    model = plate(declared)
    model = replace(model, xyz=model.xyz - [200.0, 200.0, 50.0])
    test = sensors(1e-3, "m")
    test = replace(test, xyz=test.xyz - [0.2, 0.2, 0.05])
    with pytest.raises(InputError, match="deck_length_unit=mm"):
        reconcile_units(model, test)


def test_option_outranks_the_deck():
    test = sensors(1e-3, "m")
    assert reconcile_units(plate("m"), test, deck_unit="mm").factor == 1000.0


def test_wrong_structure_gets_no_unit_proposed():
    with pytest.raises(InputError, match="same structure") as caught:
        reconcile_units(plate("mm"), sensors(7.0, "mm", shift=1e5))
    assert "--deck" not in str(caught.value)


def test_sizes_that_no_unit_brings_together_are_told():
    with pytest.raises(InputError, match=r"by none of m, mm, in, ft are both of one size \(the "):
        reconcile_units(plate(None), sensors(3.0e7, "m"))


def test_sensors_on_a_small_part_of_the_model_are_no_unit_error():
    units = reconcile_units(plate("mm"), sensors(1e-3, "m", share=0.05))
    assert units.warnings == ()


@pytest.mark.parametrize("truth", METRES)
@pytest.mark.parametrize("shift", [0.0, 50.0], ids=["same frame", "other frame"])
def test_silent_deck_is_inferred_from_the_sizes_and_said(truth, shift):
    units = reconcile_units(plate(None), sensors(METRES[truth], "m", shift=shift))
    assert (units.deck, units.factor) == (truth, pytest.approx(1 / METRES[truth]))
    assert len(units.warnings) == 1
    assert f"taken as {truth}" in units.warnings[0]


def test_silent_deck_with_sensors_on_a_part_is_inferred_by_where_they_lie():
    # By size alone feet would do: the test covers three tenths of a model in metres.
    model = plate(None)
    test = sensors(1.0, "m", share=0.3)
    assert reconcile_units(model, test).deck == "m"


def test_silent_test_is_inferred_too():
    units = reconcile_units(plate("mm"), sensors(1e-3, None))
    assert (units.test, units.factor) == ("m", 1000.0)
    assert "the test does not state" in units.warnings[0]


def test_both_silent_are_taken_alike_or_refused():
    units = reconcile_units(plate(None), sensors(1.0, None))
    assert (units.deck, units.test, units.factor) == (None, None, 1.0)
    assert units.warnings
    with pytest.raises(InputError, match="neither the deck nor the test"):
        reconcile_units(plate(None), sensors(1e-3, None))


def test_nothing_plausible_is_refused():
    with pytest.raises(InputError, match="state it with deck_length_unit"):
        reconcile_units(plate(None), sensors(1e-6, "m"))


def test_nodes_far_from_the_others_are_named():
    test = sensors(1e-3, "m")
    far = Geometry([*test.ids, 99], np.vstack([test.xyz, [[30.0, 0.0, 0.0]]]), "m")
    with pytest.raises(InputError, match="nodes 99 lies far from the others: without that it"):
        reconcile_units(plate("mm"), far)


def test_a_model_of_matrices_spans_its_grids():
    """Its only element is a mass at one of them."""
    bridge = replace(plate("m", side=9.0), elements={"point": np.array([[5]])})
    told = reconcile_units(bridge, replace(bridge, length_unit=None, elements={}))
    assert (told.test, told.factor) == ("m", 1.0)
