"""A parameter is written as the analyst reads the deck; what is wrong with it is said."""

import pytest

from trueup.adapters.nastran.fields.parameter_references import (
    FieldRef,
    ParameterSpec,
    moved_as_known,
    parse_parameter,
)
from trueup.core.data.parameter import Parameter
from trueup.core.errors import InputError


@pytest.mark.parametrize(
    ("text", "card", "number", "field"),
    [
        ("PBAR 11 I1", "PBAR", 11, "I1"),
        ("PSHELL 3 T", "PSHELL", 3, "T"),
        ("mat1 1 e", "MAT1", 1, "E"),
        ("  PELAS   4 K ", "PELAS", 4, "K"),
        ("CONM2 900 M", "CONM2", 900, "M"),
        ("PCOMP 7 THETA12", "PCOMP", 7, "THETA12"),
        ("PBUSH 5 K3", "PBUSH", 5, "K3"),
        ("PSHELL 3 12I/T**3", "PSHELL", 3, "12I/T**3"),
    ],
)
def test_one_value_with_default_name_and_bounds(text, card, number, field):
    spec = parse_parameter(text)
    assert spec == ParameterSpec(
        f"{card} {number} {field}", (FieldRef(card, number, field),), 0.2, 5.0, 1.0
    )


def test_several_cards_name_and_bounds():
    spec = parse_parameter("front flange = PBAR 11 I1, PBAR 11 I2 [0.5, 2e0]")
    assert spec.name == "front flange"
    assert spec.fields == (FieldRef("PBAR", 11, "I1"), FieldRef("PBAR", 11, "I2"))
    assert (spec.lower, spec.upper) == (0.5, 2.0)


def test_the_default_name_of_several_cards_lists_them():
    assert parse_parameter("pbar 1 i1,pbar 2 i1").name == "PBAR 1 I1, PBAR 2 I1"


@pytest.mark.parametrize(
    ("written", "canonical"),
    [
        ("PBAR 1 I11", "PBAR 1 I1"),
        ("PSHELL 1 12I/T3", "PSHELL 1 12I/T**3"),
        ("PBEAM 1 I1", "PBEAM 1 I1(A)"),
        ("PBEAML 1 DIM2", "PBEAML 1 DIM2(A)"),
        ("CONM2 1 I13", "CONM2 1 I31"),
        ("PELAS 1 K1", "PELAS 1 K"),
        ("MAT8 1 G13", "MAT8 1 G1Z"),
    ],
)
def test_a_field_has_one_name_however_it_is_written(written, canonical):
    assert str(parse_parameter(written).fields[0]) == canonical


@pytest.mark.parametrize(
    ("text", "says"),
    [
        ("", "cannot be understood"),
        ("PSHELL", "lacks a number, a field"),
        ("PSHELL 3", "lacks a field"),
        ("PSHELL 3 T 5", "too many words"),
        ("PSHELL three T", "'three' is not the number"),
        ("PSHELL 0 T", "'0' is not the number"),
        ("PSHEL 3 T", "did you mean PSHELL"),
        ("EIGRL 3 V1", "cards with values to move are"),
        ("PSOLID 3 E", "name the material"),
        ("PBAR 3 I3", "did you mean I"),
        ("PSHELL 3 MID1", "not a value"),
        ("PBAR 1 I1, ", "comma with no card"),
        ("= PBAR 1 I1", "no name"),
        ("x = y = PBAR 1 I1", "cannot be understood"),
        ("PBAR 1 I1 [0.2]", "not two numbers"),
        ("PBAR 1 I1 [a, b]", "not two numbers"),
        ("PBAR 1 I1 [0.2, 5", "cannot be understood"),
        ("PBAR 1 I1 [0, 5]", "must be positive"),
        ("PBAR 1 I1 [2, 5]", "with 1 (the deck) between"),
        ("PBAR 1 I1 [1, 1]", "with 1 (the deck) between"),
        ("PBAR 1 I1 [0.2, inf]", "finite"),
        ("PBAR 1 I1 [nan, 2]", "finite"),
        ("PBAR 1 I1, PBAR 1 I11", "PBAR 1 I1 twice"),
    ],
)
def test_malformed_parameters_are_one_clear_sentence(text, says):
    with pytest.raises(InputError) as error:
        parse_parameter(text)
    assert says in str(error.value)
    assert "\n" not in str(error.value)


def test_a_weight_must_be_positive():
    with pytest.raises(InputError, match="weight"):
        ParameterSpec("t", (FieldRef("PSHELL", 1, "T"),), weight=0.0)


def test_values_that_move_together_stay_so_in_eight_columns():
    """One value is rounded by its error, of several the factor."""
    specs = [parse_parameter(t) for t in ("MAT1 1 E", "PBAR 11 I1, PBAR 11 I2", "PSHELL 3 T")]
    values = ((71234.5,), (3.3333, 6.6666), (1.0,))
    parameters = [
        Parameter(s.name, tuple(map(str, s.fields)), v) for s, v in zip(specs, values, strict=True)
    ]
    found = moved_as_known(specs, parameters, [1.23456789, 0.87654, 1.0], [0.01, 0.1, 0.1])
    assert {str(k): v for k, v in found.items()} == {
        "MAT1 1 E": 87940.0,
        "PBAR 11 I1": 2.923304,
        "PBAR 11 I2": 5.846608,
    }
