"""Inputs and outputs as people write them."""

from __future__ import annotations

import numpy as np
import pytest

from trueup.core.data.dofs import Dofs
from trueup.core.errors import InputError
from trueup.core.statespace.channels import check_names, read_channels, rows_of


def test_channels_are_named_and_have_units() -> None:
    forces = read_channels("1187:+Z, 1187:RZ,tip=40:-x", "input")
    assert [(c.name, c.unit, c.sign) for c in forces] == [
        ("g1187.force.Z", "N", 1.0),
        ("g1187.moment.RZ", "N.m", 1.0),
        ("tip", "N", -1.0),
    ]
    motions = read_channels(["40:X", "40:-RY:vel", "7:Z:acceleration", "@3:+Y:acc"], "output")
    assert [(c.name, c.unit) for c in motions] == [
        ("g40.displacement.X", "m"),
        ("g40.angularVelocity.minusRY", "rad/s"),
        ("g7.acceleration.Z", "m/s2"),
        ("s3.acceleration.Y", "m/s2"),
    ]


@pytest.mark.parametrize(
    ("given", "role", "says"),
    [
        ("", "input", "no input is given"),
        ("1187+Z", "input", "input '1187\\+Z' cannot be read"),
        ("1:Z:acc", "input", "inputs are forces and moments"),
        ("1:Z:mm", "output", "'mm' is no quantity; give disp, vel or acc"),
        ("@1:Z", "input", "is a sensor of the test"),
        ("2nd=1:Z", "output", "'2nd' is no name"),
    ],
)
def test_what_cannot_be_read_is_said_in_a_sentence(given: str, role: str, says: str) -> None:
    with pytest.raises(InputError, match=says):
        read_channels(given, role)  # type: ignore[arg-type]


@pytest.mark.parametrize(
    ("given", "says"),
    [
        ("1:Z,1:+Z", "output 1:\\+Z and output 1:\\+Z are both called 'g1.displacement.Z'"),
        ("a=1:Z,a=2:Z", "both called 'a'"),
        ("time=1:Z", "the time of simulators"),
        ("mode=1:Z", "is called 'mode', which is what the modes of the plant are called"),
        ("mode.x=1:Z", "is called 'mode.x', which is"),
        ("g2=1:Z,2:Z", "'g2.displacement.Z' and output 1:\\+Z 'g2', of which it would be a part"),
    ],
)
def test_names_that_collide_are_refused(given: str, says: str) -> None:
    with pytest.raises(InputError, match=says):
        check_names(read_channels(given, "output"))


def test_rows_follow_the_axes_of_the_node() -> None:
    tilted = np.array([[0.0, 0.6, 0.8], [0.0, -0.8, 0.6], [1.0, 0.0, 0.0]])
    dofs = Dofs(np.array([5, 5, 6]), np.array([1, 2, 1]), tilted)
    motion = np.array([0.3, -1.7])  # along y, z
    read = rows_of(read_channels("5:Y,5:-Z,6:X", "output"), dofs, "the model")
    measured = np.append(tilted[:2, 1:] @ motion, 4.0)
    assert read @ measured == pytest.approx([0.3, 1.7, 4.0])
    for wrong, says in (
        ("7:X", "the model has no grid 7"),
        ("6:Y", "no motion of 6 in that"),
        ("5:RZ", "no rotation of 5"),
    ):
        with pytest.raises(InputError, match=says):
            rows_of(read_channels(wrong, "output"), dofs, "the model")
