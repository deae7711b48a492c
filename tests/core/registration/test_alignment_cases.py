"""Alignment and sensors on the project's measured cases and on GARTEUR SM-AG19.

The cases' tests are in metres with 1 mm position error on every axis; their decks in mm.
"""

import functools
import json
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from scipy.spatial.transform import Rotation
from tests.core.placing import angle_deg, is_identity

from trueup.adapters.nastran import build_model, read_deck
from trueup.adapters.universal import read_universal
from trueup.core.data.dofs import Dofs
from trueup.core.eigen.normal_modes import modes_of, solve
from trueup.core.errors import InputError
from trueup.core.registration.alignment import align
from trueup.core.registration.length_units import reconcile_units
from trueup.core.sensors.measured_directions import measured_directions
from trueup.core.sensors.outer_surface import surface_of
from trueup.core.sensors.sensor_map import observe

DATA = Path(__file__).parents[4] / "shared" / "data"
CASES = DATA / "cases"
NAMES = [
    "duct",
    "panel_parameters",
    "panel_spring",
    "panel_stiffness",
    "tower_frame",
    "tower_joint",
    "wheel_faults",
    "wheel_mass",
]
pytestmark = pytest.mark.skipif(not CASES.is_dir(), reason="the cases in ../shared/data are absent")
TURNED = Rotation.from_euler("xyz", [20.0, 35.0, -60.0], degrees=True).as_matrix()
SHIFT = np.array([0.1, 0.2, -3.0])


@functools.cache
def case(name):
    """Model, analysis modes, test geometry, test modes and the true frame of a case."""
    folder = CASES / name
    model = build_model(read_deck(folder / f"{name.split('_')[0]}.bdf"))
    modes = modes_of(model, solve(model, n_modes=40))
    content = read_universal(next(folder.glob("*_test.unv")))
    test_modes = measured_directions(content.modes)[0]
    frame = json.loads((folder / "truth.json").read_text())["frame"]
    return model, modes, content.geometry, test_modes, frame


def turned(geometry, modes):
    """The same test in a frame of its own."""
    dofs = Dofs(modes.dofs.node, modes.dofs.component, modes.dofs.axis @ TURNED.T)
    moved = replace(geometry, xyz=geometry.xyz @ TURNED.T + SHIFT)
    return moved, replace(modes, dofs=dofs)


def true_positions(geometry, frame):
    """Where the test nodes are on the model, mm."""
    return (1000 * geometry.xyz) @ np.array(frame["rotation"]) + frame["shift"]


def error_of(transform, test_geometry, truth):
    return np.sqrt(((transform.apply(test_geometry.xyz) - truth) ** 2).sum(axis=1).mean())


@pytest.mark.parametrize("name", [n for n in NAMES if n != "tower_frame"])
def test_frames_that_agree_are_kept(name):
    model, modes, geometry, test_modes, _ = case(name)
    assert reconcile_units(model.geometry, geometry, "mm").factor == pytest.approx(1000.0)
    found = align(model.geometry, geometry, modes, test_modes)
    assert is_identity(found)
    assert found.scale == pytest.approx(1000.0)
    assert found.warnings == ()
    # One normal direction of 1 mm noise on shells, two on the beams of the tower.
    assert 0.7 < found.rms < 1.5
    assert found.score > 0.6
    obs = observe(model.geometry, model.dofs, geometry, test_modes.dofs, found)
    assert obs.within.all()
    assert len(np.unique(obs.nearest_grid)) > 0.6 * len(np.unique(test_modes.dofs.node))


def test_rotated_frame_of_the_tower_is_found():
    model, modes, geometry, test_modes, frame = case("tower_frame")
    found = align(model.geometry, geometry, modes, test_modes)
    assert found.method == "fitted"
    assert found.decided
    assert error_of(found, geometry, true_positions(geometry, frame)) < 1.5
    assert "a slide along (0.00, 0.00, 1.00)" in found.ambiguity
    assert found.score > 0.99
    assert found.candidates[1].score < 0.95


def test_a_mirrored_geometry_is_said_where_the_structure_is_symmetric():
    model, modes, geometry, test_modes, _ = case("tower_joint")
    sign = np.array([-1.0, 1.0, 1.0])
    other = replace(geometry, xyz=geometry.xyz * sign)
    (said,) = (
        w for w in align(model.geometry, other, modes, test_modes).warnings if "mirrored" in w
    )
    assert "with x of its positions of the other sign" in said


@pytest.mark.parametrize("name", ["tower_joint", "tower_frame"])
def test_towers_in_any_frame_are_found(name):
    model, modes, geometry, test_modes, frame = case(name)
    moved, moved_modes = turned(geometry, test_modes)
    found = align(model.geometry, moved, modes, moved_modes)
    assert found.decided
    assert error_of(found, moved, true_positions(geometry, frame)) < 1.5


@pytest.mark.parametrize(
    "name",
    [
        "panel_stiffness",
        *(pytest.param(f"panel_{n}", marks=pytest.mark.slow) for n in ("spring", "parameters")),
    ],
)
def test_panels_in_any_frame_are_laid_down_to_a_millimetre_in_one_of_their_positions(name):
    """The deck is alike in all four positions, so none can be preferred: that is said."""
    model, modes, geometry, test_modes, frame = case(name)
    moved, moved_modes = turned(geometry, test_modes)
    found = align(model.geometry, moved, modes, moved_modes)
    truth = true_positions(geometry, frame)
    assert not found.decided
    assert "4 of the positions" in found.ambiguity
    assert min(error_of(c.transform, moved, truth) for c in found.candidates[:4]) < 1.5
    assert angle_deg(found) == min(angle_deg(c.transform) for c in found.candidates[:4])


@pytest.mark.parametrize(
    "name",
    ["wheel_mass", *(pytest.param(n, marks=pytest.mark.slow) for n in ("wheel_faults", "duct"))],
)
def test_round_structures_in_any_frame_fit_and_their_turn_is_left_open(name):
    model, modes, geometry, test_modes, frame = case(name)
    moved, moved_modes = turned(geometry, test_modes)
    found = align(model.geometry, moved, modes, moved_modes)
    assert not found.decided
    assert "does not decide a turn about" in found.ambiguity
    truth = true_positions(geometry, frame)
    here = found.apply(moved.xyz)
    assert found.rms < 1.6
    # Apart from the turn everything is known: height and radius of every sensor.
    side = np.sign(np.dot(here[:, 2] - here[:, 2].mean(), truth[:, 2] - truth[:, 2].mean()))
    if name == "duct":
        np.testing.assert_allclose(here[:, 2], truth[:, 2], atol=8.0)
        assert side > 0  # its two flanges differ
    radius = [np.linalg.norm(p[:, :2], axis=1) for p in (here, truth)]
    np.testing.assert_allclose(*radius, atol=8.0)


def test_unit_confusion_on_a_real_case_is_refused_by_name():
    model, _, geometry, _, _ = case("panel_spring")
    with pytest.raises(InputError, match=r"1000 times smaller.*deck_length_unit=mm"):
        reconcile_units(replace(model.geometry, length_unit="m"), geometry)
    silent = replace(model.geometry, length_unit=None)
    assert reconcile_units(silent, geometry).deck == "mm"


def test_sensors_of_the_duct_lie_on_the_true_radius():
    model, _, geometry, test_modes, _ = case("duct")
    obs = observe(
        model.geometry, model.dofs, geometry, test_modes.dofs, align(model.geometry, geometry)
    )
    assert np.abs(np.linalg.norm(obs.xyz[:, :2], axis=1) - 450.0).max() < 4.0
    radial = obs.xyz * [1, 1, 0] / np.linalg.norm(obs.xyz[:, :2], axis=1)[:, None]
    aligned = np.abs(np.einsum("nx,nx->n", radial, obs.sensors.axis))
    assert np.all((aligned > 0.999) | (aligned < 1e-6))  # along the normal, a few along the axis
    assert np.count_nonzero(aligned > 0.999) > 0.9 * len(aligned)


garteur = pytest.mark.skipif(
    not (DATA / "nastran/garteur/garteur_fem.bdf").exists(), reason="GARTEUR data are absent"
)


@functools.cache
def garteur_pair():
    model = build_model(read_deck(DATA / "nastran/garteur/garteur_fem.bdf"))
    return model.geometry, read_universal(DATA / "uff/garteur_geometry.unv").geometry


@garteur
def test_garteur_test_points_lie_on_the_model_as_they_are():
    model, test = garteur_pair()
    found = align(model, test)
    assert is_identity(found)
    assert found.warnings == ()
    at = surface_of(model)
    assert found.rms < 0.011  # the accelerometers stand 10 mm above the mid-plane of the wings
    assert at.size == pytest.approx(2.54, abs=0.01)


@garteur
@pytest.mark.parametrize(
    "seed", [0, *(pytest.param(k, marks=pytest.mark.slow) for k in range(1, 6))]
)
def test_garteur_in_any_frame_is_brought_back_by_its_geometry(seed):
    model, test = garteur_pair()
    R = Rotation.random(random_state=seed).as_matrix()
    moved = replace(test, xyz=test.xyz @ R.T + [1.0, -2.0, 3.0])
    found = align(model, moved)
    assert found.decided
    assert found.ambiguity == ""
    # Within a little more than what the accelerometers stand off.
    assert error_of(found, moved, test.xyz) < 0.025
    assert 2.0 * np.degrees(np.arcsin(np.linalg.norm(found.rotation - R.T) / 8**0.5)) < 2.0
