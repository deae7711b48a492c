"""Functions of dataset 58 become one array of frequency responses, or are told apart."""

import numpy as np
import pytest

from trueup.adapters.universal import read_universal

DATA = [1.0, 2.0, 3.0, 4.0]
PAIR = np.array([1 + 2j, 3 + 4j])


def test_any_order_missing_combinations_and_several_files(uff, write):
    first = uff.function_58(np.multiply(1, DATA), (5, 1), (9, 2))
    first += uff.function_58(np.multiply(2, DATA), (7, 1), (9, 2))
    second = uff.function_58(np.multiply(3, DATA), (7, 1), (8, 3))
    frfs = read_universal([write(first, "a.unv"), write(second, "b.unv")]).frfs
    assert frfs.responses.labels == ["5:X", "7:X"]
    assert frfs.references.labels == ["9:Y", "8:Z"]
    np.testing.assert_array_equal(frfs.values[0, 0], PAIR)
    assert np.isnan(frfs.values[0, 1]).all()
    np.testing.assert_array_equal(frfs.values[1], [2 * PAIR, 3 * PAIR])
    np.testing.assert_array_equal(frfs.frequencies_hz, [1.0, 1.5])
    assert frfs.quantity == "acceleration"


def test_negative_directions_turn_the_axis(uff, write):
    frfs = read_universal(write(uff.function_58(DATA, (5, -1), (9, -3)))).frfs
    np.testing.assert_array_equal(frfs.responses.axis, [[-1, 0, 0]])
    np.testing.assert_array_equal(frfs.references.axis, [[0, 0, -1]])
    assert (frfs.responses.component[0], frfs.references.component[0]) == (1, 3)
    np.testing.assert_array_equal(frfs.values[0, 0], PAIR)


def test_directions_in_a_cylindrical_system_point_along_radius_and_tangent(uff, write):
    text = uff.systems_2420((1, 1, [*np.eye(3), [0, 0, 0]]))
    text += uff.nodes_2411([(5, 0.0, 2.0, 0.0), (9, 3.0, 4.0, 1.0)], displacement=1)
    text += uff.function_58(DATA, (5, 1), (9, -2))
    frfs = read_universal(write(text)).frfs
    np.testing.assert_allclose(frfs.responses.axis, [[0, 1, 0]], atol=1e-15)
    np.testing.assert_allclose(frfs.references.axis, [[0.8, -0.6, 0]], atol=1e-15)


def test_rotational_dofs(uff, write):
    frfs = read_universal(write(uff.function_58(DATA, (5, -6), (9, 4)))).frfs
    assert (frfs.responses.component[0], frfs.references.component[0]) == (6, 4)
    np.testing.assert_array_equal(frfs.responses.axis, [[0, 0, -1]])


def test_function_type_0_is_told_by_its_axes(uff, write):
    text = uff.function_58(DATA, function=0)
    assert read_universal(write(text)).frfs is not None
    text = uff.function_58(DATA, function=0, quantities=(18, 12, 0))
    content = read_universal(write(text))
    assert content.frfs is None
    assert content.functions[0].kind == "general"


@pytest.mark.parametrize(
    ("ids", "names"),
    [
        (("FRF wing:12:+Z/tip:3:-X", *["NONE"] * 4), ("NONE", "NONE")),
        (("12:3/3:-1", *["NONE"] * 4), ("NONE", "NONE")),
        (("NONE", "H1 (12Z+, 3X-)", *["NONE"] * 3), ("NONE", "NONE")),
        (("07-Dec-17 14:38:01", *["NONE"] * 4), ("12+Z", "3-X")),
        (("07-Dec-17 14:38:01", *["NONE"] * 4), ("12Z", "3:-X")),
    ],
)
def test_dof_given_only_in_the_name(uff, write, ids, names):
    content = read_universal(write(uff.function_58(DATA, (0, 0), (0, 0), ids=ids, names=names)))
    assert content.frfs.responses.labels == ["12:Z"]
    assert content.frfs.references.labels == ["3:X"]
    np.testing.assert_array_equal(content.frfs.references.axis, [[-1, 0, 0]])
    assert "taken from there (12:+Z/3:-X first)" in content.warnings[0]


def test_numbers_written_without_regard_to_columns(uff, write):
    lines = uff.function_58(DATA, (5, 1), (9, -2)).split("\n")
    lines[7] = "4 0 1 0 NONE 5 1 NONE 9 -2"
    frfs = read_universal(write("\n".join(lines))).frfs
    assert (frfs.responses.labels, frfs.references.labels) == (["5:X"], ["9:Y"])


def test_numbers_in_columns_win_over_the_name(uff, write):
    text = uff.function_58(DATA, (5, 1), (9, 2), ids=("12:+Z/3:-X", *["NONE"] * 4))
    assert read_universal(write(text)).frfs.responses.labels == ["5:X"]


@pytest.mark.parametrize(
    ("change", "said"),
    [
        ({"response": (5, 0)}, "do not say the direction"),
        ({"quantities": (18, 15, 13)}, "are not a motion per force"),
        ({"quantities": (18, 12, 12)}, "are not a motion per force"),
        ({"ordinate_type": 2}, "are real, not complex"),
    ],
)
def test_responses_that_cannot_be_used_stand_apart_and_are_told(uff, write, change, said):
    content = read_universal(write(uff.function_58(DATA, **change)))
    assert content.frfs is None
    assert len(content.functions) == 1
    assert said in content.warnings[0]


def test_other_functions_keep_their_names(uff, write):
    text = uff.function_58(DATA, function=1, ordinate_type=2, quantities=(17, 12, 0))
    text += uff.function_58(DATA, function=6, ordinate_type=2)
    text += uff.function_58(DATA, function=2, ordinate_type=2)
    content = read_universal(write(text))
    assert [f.kind for f in content.functions] == ["time response", "coherence", "auto spectrum"]
    np.testing.assert_array_equal(content.functions[0].values, DATA)
    np.testing.assert_array_equal(content.functions[0].abscissa, [1, 1.5, 2, 2.5])
    assert content.functions[0].quantity == "acceleration"
    assert content.frfs is None


def test_the_most_common_axis_is_taken_and_the_others_told(uff, write):
    text = uff.function_58(DATA, (5, 1)) + uff.function_58(DATA, (6, 1))
    text += uff.function_58(DATA, (7, 1), step=0.25)
    content = read_universal(write(text))
    assert content.frfs.responses.labels == ["5:X", "6:X"]
    assert len(content.functions) == 1
    assert "1 frequency response(s) have another frequency axis (" in content.warnings[0]
    assert " Hz) than the other 2 (" in content.warnings[0]


def test_uneven_axes_that_differ_are_told(uff, write):
    a, b = [1, 10, 20, 2, 30, 40], [1, 10, 20, 2.5, 30, 40]
    text = uff.function_58(a, (5, 1), even=False, n_point=2)
    text += uff.function_58(b, (6, 1), even=False, n_point=2)
    content = read_universal(write(text))
    assert content.frfs.responses.labels == ["5:X"]
    assert "frequency axis differs" in content.skipped[0].why


def test_frequencies_that_do_not_increase_are_refused(uff, write):
    content = read_universal(write(uff.function_58(DATA, step=0.0)))
    assert content.frfs is None
    assert content.skipped[0].why == "its frequencies do not increase"


def test_the_same_combination_again_is_listed(uff, write):
    content = read_universal(write(uff.function_58(DATA) + uff.function_58(np.multiply(2, DATA))))
    np.testing.assert_array_equal(content.frfs.values[0, 0], PAIR)
    assert "first is kept" in content.skipped[0].why


@pytest.mark.parametrize(
    ("unit", "per", "length", "factor"),
    [
        ("m/s^2", "N", 1.0, 1.0),
        ("g", "N", 1.0, 9.80665),
        ("mm/s2", "N", 1.0, 1e-3),
        ("m/s2", "N", 1000.0, 1000.0),
        ("in/s^2", "lbf", 39.370079, 1 / 4.4482216152605),
        ("(m/s^2)/N", "NONE", 1.0, 1.0),
        ("g/lbf", "NONE", 1.0, 9.80665 / 4.4482216152605),
        ("m/s/s", "kN", 1.0, 1e-3),
    ],
)
def test_labelled_units_are_brought_to_that_of_the_test(uff, write, unit, per, length, factor):
    text = uff.units(length, 9) + uff.function_58(DATA, units_=("Hz", unit, per))
    content = read_universal(write(text))
    np.testing.assert_allclose(content.frfs.values[0, 0], factor * PAIR, rtol=1e-12)
    assert bool(content.warnings) == (factor != 1.0)


def test_unlabelled_units_are_those_of_the_test(uff, write):
    content = read_universal(write(uff.units(1000.0, 10) + uff.function_58(DATA)))
    np.testing.assert_array_equal(content.frfs.values[0, 0], PAIR)
    assert content.warnings == ()


def test_quantity_by_its_unit_where_the_type_is_general(uff, write):
    text = uff.function_58(DATA, quantities=(18, 1, 0), units_=("Hz", "mm/s", "N"))
    assert read_universal(write(text)).frfs.quantity == "velocity"


def test_unknown_quantity_is_told(uff, write):
    content = read_universal(write(uff.function_58(DATA, quantities=(18, 0, 0))))
    assert content.frfs.quantity == "acceleration"
    assert "taken as acceleration" in content.warnings[0]


def test_mixed_quantities_are_brought_to_the_highest(uff, write):
    """Velocity times i omega is acceleration."""
    text = uff.function_58(DATA, (5, 1))
    text += uff.function_58(DATA, (6, 1), quantities=(18, 11, 13))
    text += uff.function_58(DATA, (7, 1), quantities=(18, 8, 13))
    content = read_universal(write(text))
    s = 2j * np.pi * np.array([1.0, 1.5])
    np.testing.assert_allclose(content.frfs.values[:, 0], [PAIR, s * PAIR, s**2 * PAIR])
    assert "2 response(s) are not acceleration" in content.warnings[0]


def test_only_some_references_or_no_values(uff, write):
    text = uff.function_58(DATA, (5, 1), (9, 2)) + uff.function_58(DATA, (5, 1), (8, 2))
    path = write(text)
    assert read_universal(path, references=[8]).frfs.references.labels == ["8:Y"]
    content = read_universal(path, values=False)
    assert content.frfs is None
    assert content.skipped == ()
    assert [d.count for d in content.datasets] == [2, 2]
