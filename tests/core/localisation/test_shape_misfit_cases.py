"""Noise and misfit on the project's measured cases (2 % sensor noise, 1 % gain scatter)."""

from pathlib import Path

import numpy as np
import pytest

from trueup.adapters.nastran import build_model, read_deck
from trueup.adapters.universal import read_universal
from trueup.core.correlation.mode_pairing import correlate
from trueup.core.eigen.normal_modes import modes_of, solve
from trueup.core.localisation.first_order_maps import linearise, mass_evidence, stiffness_evidence
from trueup.core.localisation.shape_misfit import misfit, paired_shapes, spread
from trueup.core.localisation.shape_noise import estimate_noise
from trueup.core.sensors.measured_directions import measured_directions
from trueup.core.sensors.rigid_transform import Transform
from trueup.core.sensors.sensor_map import observe

CASES = Path(__file__).parents[4] / "shared" / "data" / "cases"
pytestmark = pytest.mark.skipif(not CASES.is_dir(), reason="the cases in ../shared/data are absent")


def at_sensors(name):
    folder = CASES / name
    model = build_model(read_deck(folder / f"{name.split('_')[0]}.bdf"))
    solution = solve(model, n_modes=40)
    modes = modes_of(model, solution)
    content = read_universal(next(folder.glob("*_test.unv")))
    test = measured_directions(content.modes)[0]
    obs = observe(
        model.geometry,
        model.dofs,
        content.geometry,
        test.dofs,
        Transform(np.eye(3), np.zeros(3), 1000.0),
    )
    return model, solution.rigid_body_modes, modes, obs, test


@pytest.mark.parametrize("name", ["tower_joint", "panel_spring", "panel_stiffness", "wheel_mass"])
def test_noise_is_told_from_what_the_model_lacks(name):
    _, rigid, modes, obs, test = at_sensors(name)
    noise = estimate_noise(
        modes.frequencies_hz, obs.matrix @ modes.shapes, test.frequencies_hz, test.shapes, rigid
    )
    assert 0.018 < noise.relative < 0.032


def test_faulty_sensors_of_the_wheel_are_among_the_outliers():
    _, rigid, modes, obs, test = at_sensors("wheel_faults")
    noise = estimate_noise(
        modes.frequencies_hz, obs.matrix @ modes.shapes, test.frequencies_hz, test.shapes, rigid
    )
    outliers = set(test.dofs.node[noise.outlier])
    assert {109, 119, 129} <= outliers
    assert noise.gain[test.dofs.node == 109][0] == pytest.approx(-1.0, abs=0.05)
    assert noise.relative < 0.03


def compared(name):
    model, rigid, modes, obs, test = at_sensors(name)
    shapes = obs.matrix @ modes.shapes
    hz, test_hz = modes.frequencies_hz, test.frequencies_hz
    found = correlate(hz, shapes, test_hz, test.shapes, rigid_body_modes=rigid)
    noise = estimate_noise(hz, shapes, test_hz, test.shapes, rigid)
    return model, modes, obs, shapes, test, found, noise


def linearised(name):
    model, modes, _, shapes, test, found, noise = compared(name)
    pairs = paired_shapes(found, shapes, test.shapes)
    return model, modes, linearise(found, pairs, noise, modes.frequencies_hz, shapes)


def test_maps_of_the_soft_panel_cover_the_structure():
    model, _, obs, shapes, test, found, noise = compared("panel_stiffness")
    got = misfit(found, paired_shapes(found, shapes, test.shapes), noise)
    assert np.mean(got.by_mode**2) > 3.0
    # The close pair near 62 and 64 Hz mixes; the others are changed little.
    assert set(np.argsort(got.by_mode)[-2:]) == {3, 4}
    assert np.median(got.by_mode) < 2.0
    assert np.isfinite(spread(got.by_sensor, obs.xyz, model.geometry.xyz)).all()


def test_hidden_ground_spring_is_where_the_map_of_springs_peaks():
    model, modes, lin = linearised("panel_spring")
    n = len(model.geometry.ids)
    got = stiffness_evidence(lin, modes.shapes.reshape(n, 6, -1)[:, 2:3])
    peak = np.argmax(got.explained)
    np.testing.assert_allclose(model.geometry.xyz[peak], [750, 450, 0], atol=31)
    assert got.explained[peak] > 0.9 * got.total
    assert got.size[peak] == pytest.approx(15.0, rel=0.3)  # N/mm, first order
    assert (
        mass_evidence(lin, modes.shapes.reshape(n, 6, -1)[:, :3]).explained.max() < got.total / 10
    )


def test_hidden_mass_on_the_wheel_is_near_the_peak_of_the_map_of_masses():
    model, modes, lin = linearised("wheel_mass")
    got = mass_evidence(lin, modes.shapes.reshape(len(model.geometry.ids), 6, -1)[:, :3])
    peak = np.argmax(got.explained)
    assert np.linalg.norm(model.geometry.xyz[peak] - [172.5, 338.6, 0]) < 40.0
    assert got.explained[peak] > 0.6 * got.total
    assert 0.0004 < got.size[peak] < 0.0010  # 0.8 kg, first order


def test_a_wheel_with_faulty_sensors_only_shows_no_place():
    model, modes, lin = linearised("wheel_faults")
    got = mass_evidence(lin, modes.shapes.reshape(len(model.geometry.ids), 6, -1)[:, :3])
    assert got.explained.max() < 0.03 * got.total
