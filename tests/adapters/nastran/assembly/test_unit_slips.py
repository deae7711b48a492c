"""Slips of units: each is named with its factor, and nothing is said of what makes sense."""

import numpy as np
import pytest

from trueup.adapters.nastran import describe_deck


@pytest.fixture
def said(model):
    """What is said of the units of a rod of one material."""

    def of(E, rho, size, more=""):
        bulk = (
            f"GRID,1,,0.,0.,0.,,123456\nGRID,2,,{size!r},0.,0.,,23456\nCROD,1,1,1,2\n"
            f"PROD,1,1,1.\nMAT1,1,{E!r},,.3,{rho!r}\n{more}"
        )
        words = ("units of", "its coordinates", "length unit")
        return [w for w in model(bulk).warnings if any(word in w for word in words)]

    return of


@pytest.mark.parametrize(
    ("E", "rho", "size", "more"),
    [
        (2.1e5, 7.85e-9, 800.0, ""), (7e4, 2.7e-9, 300.0, ""), (1.1e5, 4.43e-9, 2500.0, ""),
        (2.1e11, 7850.0, 40.0, ""), (7e10, 2700.0, 0.05, ""), (3e10, 2400.0, 300.0, ""),
        (1.07e7, 2.59e-4, 60.0, ""), (2.9e7, 0.283, 60.0, "PARAM,WTMASS,.00259\n"),
        (1.44e9, 5.37, 9.0, ""), (2.1e8, 7.85e-6, 800.0, ""),
        (2.1e11, 7.85, 8.0, "PARAM,WTMASS,1E3\n"), (4.3e9, 490.0, 9.0, "PARAM,WTMASS,.0311\n"),
        (2e9, 8.02e-9, 300.0, ""), (1.0, 1.0, 1.0, ""), (5.0, 1.2e-9, 80.0, ""),
        (2.1e8, 7.85, 20.0, ""), (1.5e5, 1.6e-9, 4e4, ""),
    ],
)  # fmt: skip
def test_consistent_and_unknown_materials_are_left_alone(said, E, rho, size, more):
    assert said(E, rho, size, more) == []


@pytest.mark.parametrize(
    ("E", "rho", "size", "words"),
    [
        (2.1e5, 7850.0, 800.0, ["steel in MPa and kg/m³", "its density", "by 1e-12", "1e+06"]),
        (
            2.1e5,
            7850.0,
            0.8,
            ["steel in MPa and kg/m³", "its E", "by 1e+06", "1e+03 times"],
        ),
        (2.1e5, 7.85e-6, 800.0, ["kg/mm³", "its density", "by 0.001", "31.6 times too low"]),
        (7e4, 2.7, 800.0, ["aluminium in MPa and g/cm³", "by 1e-09"]),
        (210.0, 7.85e-9, 800.0, ["steel in GPa and t/mm³", "its E", "by 1e+03", "31.6"]),
        (110.0, 4430.0, 2.0, ["titanium in GPa and kg/m³", "its E", "by 1e+09"]),
        (2.1e11, 7.85e-9, 800.0, ["steel in Pa and t/mm³", "its E", "by 1e-06", "too high"]),
        (2.9e7, 0.283, 30.0, ["WTMASS,0.00259", "19.6 times too low"]),
        (2.1e5, 7.7e-5, 800.0, ["a weight", "WTMASS,1.02E-4"]),
        (3e4, 7.34e-4, 30.0, ["steel in ksi", "by 1e+03"]),
        (2.9e7, 7.85e-9, 30.0, ["steel in psi and t/mm³"]),
    ],
)
def test_slips_are_named_with_their_factor(said, E, rho, size, words):
    (sentence,) = said(E, rho, size)
    for word in words:
        assert word in sentence


@pytest.mark.parametrize(
    ("E", "rho", "size", "more", "words"),
    [
        (2.1e5, 7.85e-9, 0.8, "", ["0.0008 m long", "mm, t, N", "in m;", "by 1e+03"]),
        (2.1e11, 7850.0, 800.0, "", ["800 m long", "m, kg, N", "in mm;", "by 0.001"]),
        (2.1e5, 7.85e-9, 8.0, "PARAM,UNITSYS,LBF-IN", ["length unit in", "mm, t, N", "by 25.4"]),
    ],
)
def test_lengths_that_the_materials_contradict(said, E, rho, size, more, words):
    (sentence,) = said(E, rho, size, more)
    for word in words:
        assert word in sentence


@pytest.mark.parametrize(
    ("E", "rho", "wtmass", "words"),
    [
        (3e7, 7.34e-4, 0.00259, ["one too many", "in, lbf s²/in, lbf", "19.6 times too high"]),
        (2.1e11, 7850.0, 0.00259, ["one too many", "m, kg, N"]),
        (3e7, 0.283, 386.0, ["psi and lb/in³", "to be 0.00259", "386 times too low"]),
        (30.0, 0.283, 0.00259, ["steel in Msi", "by 1e+06"]),
        (4.3e9, 490.0, 1.0, ["psf and lb/ft³", "WTMASS,0.0311"]),
    ],
)
def test_masses_by_a_wrong_gravity(said, E, rho, wtmass, words):
    (sentence,) = said(E, rho, 30.0, f"PARAM,WTMASS,{wtmass!r}\n")
    for word in words:
        assert word in sentence


@pytest.mark.parametrize(
    ("E", "rho", "words"),
    [
        (
            210.0,
            7.85e-6,
            ["mm, kg, kN, ms", "in kHz", "E is to be multiplied by 1e+03", "by 0.001"],
        ),
        (7e4, 2.7e-3, ["mm, g, N, ms", "in kHz", "E is to be multiplied by 1,", "by 1e-06"]),
    ],
)
def test_frequencies_by_the_millisecond_are_not_in_hertz(said, E, rho, words):
    (sentence,) = said(E, rho, 800.0)
    for word in words:
        assert word in sentence


@pytest.mark.parametrize(
    ("E", "rho", "words"),
    [
        (2.1e5, 7.85e-8, ["steel in mm, t, N", "10 times too large", "3.16 times too low"]),
        (7e10, 270.0, ["aluminium in m, kg, N", "0.1 times too large", "3.16 times too high"]),
        (1.05e7, 2.59e-3, ["aluminium in in,", "10 times too large"]),
        (2.1e5, 4e-8, []),
    ],
)
def test_a_slip_of_the_exponent_of_a_density(said, E, rho, words):
    told = said(E, rho, 2.0 if rho > 1.0 else 80.0)
    assert len(told) == bool(words)
    assert all(word in told[0] for word in words)


@pytest.mark.parametrize(
    ("card", "words"),
    [
        ("MAT8,7,1.3+5,9.+3,.3,5.+3,,,1600.", ["fibre laminate in MPa and kg/m³", "by 1e-12"]),
        ("MAT8,7,130.,9.,.3,5.,,,1.6-9", ["in GPa and t/mm³", "its E", "by 1e+03"]),
        (
            "MAT9,7,2.8+5,1.2+5,1.2+5,,,,2.8+5\n,1.2+5,,,,2.8+5\n,8.+4,,,8.+4,,8.+4,7850.",
            ["MAT9 7", "by 1e-12"],
        ),
        ("MAT8,7,1.3+5,9.+3,.3,5.+3,,,1.6-9", []),
        ("MAT8,7,6.+10,6.+10,.05,4.+9,,,1900.", []),
        ("MAT8,7,1.,1.,.3,60.,,,4.8-11", []),
    ],
)
def test_orthotropic_materials_alone(model, card, words):
    plate = "GRID,1,,0.,0.,0.,,123456\nGRID,2,,500.,0.,0.\nCELAS2,1,1.,2,1\nCONM2,2,2,,1.\n"
    told = [w for w in model(plate + card).warnings if "units of" in w]
    assert len(told) == bool(words)
    assert all(word in told[0] for word in words)


@pytest.mark.parametrize(
    ("E", "rho", "mass", "size", "write"),
    [
        (2.1e5, 7.85e-9, 2.5, 500.0, "write 0.0025"),
        (1.07e7, 2.59e-4, 55.0, 20.0, "write 0.1425"),
        (2.1e5, 7.85e-9, 0.4, 500.0, None),
        (2.1e5, 7.85e-9, 1e6, 500.0, None),
        (2.1e5, 7.85e-9, 100.0, 500.0, None),
        (2.1e5, 7.85e-9, 3.3e5, 500.0, None),
        (2.1e11, 7850.0, 900.0, 0.3, None),
    ],
)
def test_a_mass_in_another_unit_does_not_fit_into_the_structure(said, E, rho, mass, size, write):
    told = said(E, rho, size, f"CONM2,5,2,,{mass}\n")
    assert len(told) == bool(write)
    assert all(write in sentence for sentence in told)


def test_a_gravity_of_the_wrong_exponent(said):
    (sentence,) = said(2.9e7, 0.283, 60.0, "PARAM,WTMASS,.0259\n")
    assert "to be 0.00259" in sentence


@pytest.mark.parametrize(("thickness", "told"), [(5.0, 1), (0.5, 0)])
def test_a_shell_thicker_than_the_structure_is_large(said, thickness, told):
    shell = f"PSHELL,9,1,{thickness!r}\n"
    assert len(said(2.1e11, 7850.0, 0.8, shell)) == told


def test_declared_units_that_agree_are_not_mentioned(said):
    assert said(2.1e5, 7.85e-9, 800.0, "PARAM,UNITSYS,N-MM") == []


def test_magnitudes_are_told_at_first_sight(tmp_path):
    """A rod of two materials: E A / L and half of the mass at its free end make the frequency."""
    (tmp_path / "rod.bdf").write_text(
        "GRID,1,,0.,0.,0.,,123456\nGRID,2,,500.,0.,0.,,23456\nCROD,1,1,1,2\nPROD,1,1,30.\n"
        "MAT1,1,2.1E5,,.3,7.85E-9\nMAT1,2,7.E4,,.3,2.7E-9\n"
    )
    told = describe_deck(tmp_path / "rod.bdf")
    found = told["contents"]["magnitudes"]
    mass = 7.85e-9 * 30.0 * 500.0
    assert found["mass"] == pytest.approx(mass, rel=1e-3)
    assert (found["size"], found["E"], found["density"]) == (
        500.0, "70000 to 210000", "2.7e-09 to 7.85e-09",
    )  # fmt: skip
    hz = np.sqrt(2.1e5 * 30.0 / 500.0 / (mass / 2.0)) / (2.0 * np.pi)
    assert found["first_frequency_hz"] == pytest.approx(hz, rel=1e-3)
    assert told["warnings"] == []


def test_slips_are_told_at_first_sight_even_of_what_cannot_be_assembled(tmp_path):
    (tmp_path / "part.bdf").write_text(
        "GRID,1,,0.,0.,0.\nGRID,2,,500.,0.,0.\nCSEAM,1,1,1,2\nMAT1,1,2.1E5,,.3,7850.\n"
    )
    told = describe_deck(tmp_path / "part.bdf")
    assert set(told["contents"]["magnitudes"]) == {"size", "E", "density"}
    assert any("its density is to be multiplied by 1e-12" in w for w in told["warnings"])
