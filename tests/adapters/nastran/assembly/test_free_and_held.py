"""What holds, what moves freely and what is a mechanism: linkages, gears, hinges, loose parts."""

import numpy as np
import pytest
import scipy.linalg as sl

from trueup.core.eigen.normal_modes import solve
from trueup.core.errors import InputError

RODS = "PROD,1,1,1.\nMAT1,1,1.,,.3,1.\nPARAM,AUTOSPC,NO\n"


def test_a_linkage_is_not_a_rigid_body(model):
    """Two cranks and a bar between them: the bar goes sideways, the cranks turn."""
    found = model(
        "GRDSET,,,,,,,3456\nGRID,1,,,,,,123456\nGRID,2,,0.,1.\nGRID,3,,2.,1.\n"
        "GRID,4,,2.,0.,0.,,123456\nCROD,1,1,1,2\nCROD,2,1,2,3\nCROD,3,1,3,4\n" + RODS
    )
    with pytest.raises(InputError, match=r"mechanism: a motion .* at 2:1, 3:1;"):
        solve(found, 3)


def test_a_deck_that_is_held_everywhere_is_told_so(model):
    with pytest.raises(InputError, match="constraints leave no free degree of freedom"):
        model("SPOINT,1\nCELAS4,1,1.,1,0\nCMASS4,2,1.,1,0\nSPC1,3,,1\n", case="SPC = 3")


def test_shafts_of_scalar_points_turn_freely_through_gears(model):
    masses = "".join(f"CMASS4,{k},1.,{k},0\n" for k in (1, 2, 3, 4))
    shafts = "SPOINT,1,2,3,4\nCELAS4,11,100.,1,2\nCELAS4,12,50.,3,4\nMPC,5,3,,1.,2,,-2.\n"
    found = solve(model(masses + shafts, case="MPC = 5"), 3)
    assert found.rigid_body_modes == 1
    shape = found.vectors[:, 0] / found.vectors[0, 0]
    np.testing.assert_allclose(shape, [1.0, 1.0, 2.0], rtol=1e-9)
    T = np.array([[1.0, 0, 0], [0, 1, 0], [0, 2, 0], [0, 0, 1]])
    K = np.array([[100.0, -100, 0], [-100, 300, -100], [0, -100, 50]])
    exact = np.sqrt(sl.eigh(K, T.T @ T, eigvals_only=True)[1:]) / (2 * np.pi)
    np.testing.assert_allclose(found.frequencies_hz[1:], exact, rtol=1e-9)


def test_a_pendulum_is_a_rigid_body(model):
    found = model("GRID,1,,,,,,123456\nGRID,2,,1.,,,,3456\nCROD,1,1,1,2\n" + RODS)
    assert solve(found, 2).rigid_body_modes == 1


def test_a_door_turns_on_its_hinges(model):
    found = model(
        "GRID,1,,0.,0.,0.,,123\nGRID,2,,2.,0.,0.,,123\nGRID,3,,2.,1.,0.\nGRID,4,,0.,1.,0.\n"
        "CQUAD4,1,1,1,2,3,4\nPSHELL,1,1,.1,1,,1\nMAT1,1,7.+4,,.3,1.\n"
    )
    assert solve(found, 3).rigid_body_modes == 1


PLATE = (
    "GRID,1,,0.,0.,0.,,123456\nGRID,2,,1.,0.,0.\nGRID,3,,1.,1.,0.\nGRID,4,,0.,1.,0.,,123456\n"
    "CQUAD4,1,1,1,2,3,4\nPSHELL,1,1,.01,1,,1\nMAT1,1,7.+10,,.3,2700.\n"
)


def test_a_part_that_is_not_connected_is_named(model):
    """A bar that floats beside a clamped plate, and a clamped plate alone."""
    bar = "GRID,81,,0.,0.,2.\nGRID,82,,1.,0.,2.\nCBAR,9,9,81,82,0.,0.,1.\nPBAR,9,1,1.,1.,1.,1.\n"
    found = solve(model(PLATE + bar), 12)
    assert any("not connected to the rest" in w and "81, 82" in w for w in found.warnings)
    assert not solve(model(PLATE), 4).warnings


def test_elements_of_different_cards_with_one_number_are_said(model):
    bar = "CBAR,1,9,2,3,0.,0.,1.\nPBAR,9,1,1.,1.,1.,1.\n"
    found = model(PLATE + bar)
    assert any("share the number 1" in w for w in found.warnings)
