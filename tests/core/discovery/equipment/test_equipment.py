"""Equipment on beams and plates: offset and inertia as a rigid body has them."""

import numpy as np
import pytest

import trueup
from trueup.adapters.nastran.discovery.build_structure import build_structure
from trueup.core.discovery.effects.candidates import together
from trueup.core.discovery.effects.effect_kind import Scale
from trueup.core.discovery.effects.point_mass import KIND
from trueup.core.discovery.equipment.bodies import Body, ball, equipment
from trueup.core.discovery.equipment.loose_body import body_of, loose, theta_of
from trueup.core.discovery.equipment.stands import stands

BEAM = (
    "CEND\nBEGIN BULK\n"
    + "".join(f"GRID,{k},,{0.1 * k},0.,0.\n" for k in range(1, 6))
    + "".join(f"CBAR,{k},1,{k},{k + 1},0.,0.,1.\n" for k in range(1, 5))
    + ("PBAR,1,1,1.-4,1.-9,2.-9,2.-9\nMAT1,1,7.+10,,.3,2700.\nENDDATA\n")
)
PLATE = (
    "CEND\nBEGIN BULK\n"
    + "".join(f"GRID,{1 + i + 4 * j},,{0.1 * i},{0.1 * j},0.\n" for j in range(4) for i in range(4))
    + "".join(f"CQUAD4,{g},1,{g},{g + 1},{g + 5},{g + 4}\n" for g in (1, 2, 3, 5, 6, 7, 9, 10, 11))
    + "PSHELL,1,1,.003,1,,1\nMAT1,1,7.+10,,.3,2700.\nENDDATA\n"
)


SIZE = 0.5
MIRROR = np.diag([-1.0, 1.0, 1.0])
ROD = Body(np.array([0.02, -0.01, 0.06]), 0.03 * np.outer([0.6, 0.8, 0.0], [0.6, 0.8, 0.0]))
BODIES = (ball(ROD.offset, 0.03), ROD)


def structure_of(folder, deck):
    path = folder / "it.bdf"
    path.write_text(deck)
    return build_structure(trueup.read_deck(path), ())


def masses_of(structure):
    return KIND.places(structure, Scale(1.0, 1.0, 1.0, (1.0, 2.0)))[0]


def rigid(structure, rng):
    """Return a rigid motion: of the origin, turning, and of free degrees of freedom."""
    model = structure.model
    t, w = rng.normal(size=3), rng.normal(size=3)
    x = model.geometry.xyz[model.geometry.index_of(model.dofs.node)]
    moved = np.where((model.dofs.component <= 3)[:, None], t + np.cross(w, x), w)
    u = moved[np.arange(len(x)), (model.dofs.component - 1) % 3]
    return t, w, np.linalg.lstsq(model.expansion.toarray(), u, rcond=None)[0]


@pytest.mark.parametrize("body", BODIES)
@pytest.mark.parametrize(("deck", "grid", "feet"), [(BEAM, 3, [1]), (PLATE, 6, [9, 9])])
def test_a_rigid_motion_gives_the_kinetic_energy_of_a_rigid_body(tmp_path, deck, grid, feet, body):
    structure = structure_of(tmp_path, deck)
    t, w, q = rigid(structure, np.random.default_rng(3))
    places = stands(structure, {"grids": [grid]}, np.eye(3))
    assert [len(p.where["grids"]) for p in places] == feet
    for place in places:
        made = equipment(masses_of(structure), [place], [body])
        centre = t + np.cross(w, place.xyz + body.offset)
        second = body.extent @ body.extent
        turning = np.trace(second) * (w @ w) - w @ second @ w
        assert np.sum((made.acting(0) @ q) ** 2) == pytest.approx(centre @ centre + turning)


def test_what_is_the_same_about_any_axis_has_one_moment_of_inertia_else_those_of_a_card(tmp_path):
    structure = structure_of(tmp_path, BEAM)
    places = stands(structure, {"grids": [3]}, np.eye(3))
    made = equipment(masses_of(structure), places, BODIES)
    told = {"offset": [0.02, -0.01, 0.06], "inertia": pytest.approx(2.0 * 0.03**2)}
    assert made.told(0, {"mass": 2.0}) == told
    x, y = 0.03 * 0.6, 0.03 * 0.8
    said = made.told(1, {"mass": 2.0})
    expected = 2.0 * np.array([y * y, x * y, x * x, 0.0, 0.0, x * x + y * y])
    assert said["inertias"] == pytest.approx(expected.tolist())
    assert said["inertia"] == pytest.approx(2.0 * 2.0 / 3.0 * 0.03**2)


def test_one_grid_of_a_sheet_tilts_as_it_turns_and_spins_as_those_around_it_do(tmp_path):
    structure = structure_of(tmp_path, PLATE)
    model = structure.model
    wide, foot = stands(structure, {"grids": [6]}, np.eye(3))
    assert foot.where["grids"][0] == 6
    assert foot.where["normal"] == pytest.approx([0.0, 0.0, 1.0])
    q = np.random.default_rng(5).normal(size=len(model.M().toarray()))
    u = model.expansion @ q
    own = {int(c): u[i] for i, c in enumerate(model.dofs.component) if model.dofs.node[i] == 6}
    assert foot.motion @ q == pytest.approx([*(own[c] for c in range(1, 6)), (wide.motion @ q)[5]])


def test_a_foot_needs_no_drilling_rotation(tmp_path):
    """AUTOSPC holds that of a flat sheet whose shells have none."""
    structure = structure_of(tmp_path, PLATE.replace("ENDDATA", "PARAM,K6ROT,0.\nENDDATA"))
    assert 6 not in structure.model.dofs.component[structure.model.expansion.getnnz(axis=1) > 0]
    _, foot = stands(structure, {"grids": [6]}, np.eye(3))
    assert foot.where["normal"] == pytest.approx([0.0, 0.0, 1.0])


def test_a_loose_body_is_that_of_its_unknowns_and_moves_by_their_slopes(tmp_path):
    structure = structure_of(tmp_path, PLATE)
    template = masses_of(structure)
    places = [
        stands(structure, {"grids": [6]}, np.eye(3))[1],
        stands(structure, {"grids": [7]}, MIRROR)[1],
    ]
    body = Body(ROD.offset, ROD.extent + 0.01 * np.eye(3))
    theta = theta_of(np.log(2.0), body, SIZE)
    same = body_of(theta, SIZE)
    assert same.offset == pytest.approx(body.offset)
    assert same.extent == pytest.approx(body.extent)
    made, law = loose(template, places, SIZE), loose(template, places, SIZE).law
    rows, first = made.root.toarray(), np.zeros(1, np.int64)

    def matrix(theta):
        return (rows.T * law.value(np.array([theta]), first)[0]) @ rows

    held = equipment(template, places, [body])
    U = held.root.toarray()
    assert matrix(theta) == pytest.approx(2.0 * U.T @ U, abs=1e-12)
    for slope, way in zip(law.slope(np.array([theta]), first)[0], np.eye(10), strict=True):
        by_steps = (matrix(theta + 1e-5 * way) - matrix(theta - 1e-5 * way)) / 2e-5
        assert (rows.T * slope) @ rows == pytest.approx(by_steps, abs=1e-8)


def test_a_body_is_as_likely_beforehand_however_it_is_turned():
    body = Body(ROD.offset, np.array([[3.0, 1.0, 0.5], [1.0, 2.0, -0.7], [0.5, -0.7, 1.0]]))
    turn = np.linalg.qr(np.random.default_rng(2).normal(size=(3, 3)))[0]
    turned = Body(turn @ body.offset, turn @ body.extent @ turn.T)
    one, other = (np.linalg.norm(theta_of(0.0, b, SIZE)) for b in (body, turned))
    assert one == pytest.approx(other)


def test_mirrored_places_have_mirrored_bodies(tmp_path):
    structure = structure_of(tmp_path, PLATE)
    both = [
        stands(structure, {"grids": [6]}, np.eye(3))[0],
        stands(structure, {"grids": [7]}, MIRROR)[0],
    ]
    masses = masses_of(structure)
    twins = together(masses, np.array([[5, 6]]), np.stack([np.eye(3), MIRROR]))
    made = equipment(twins, both, [ROD])
    assert made.copies == ((0, 1),)
    np.testing.assert_allclose(made.maps, twins.maps)
    here, there = made.single.bodies
    assert there.offset == pytest.approx(MIRROR @ here.offset)
    assert there.extent == pytest.approx(MIRROR @ here.extent @ MIRROR)


def test_equipment_stands_up_from_a_sheet_and_on_a_bar_along_the_basic_axes(tmp_path):
    tilted = PLATE
    for j in range(4):
        for i in range(4):
            grid, y = 1 + i + 4 * j, 0.1 * j
            flat = f"GRID,{grid},,{0.1 * i},{y},0.\n"
            tilted = tilted.replace(flat, f"GRID,{grid},,{0.1 * i},{0.8 * y},{0.6 * y}\n")
    for place in stands(structure_of(tmp_path, tilted), {"grids": [6]}, np.eye(3)):
        axes = place.axes
        assert place.sheet
        assert axes[0] == pytest.approx([0.0, -0.6, 0.8])
        assert axes[1] == pytest.approx([1.0, 0.0, 0.0])
        assert axes @ axes.T == pytest.approx(np.eye(3))
    (place,) = stands(structure_of(tmp_path, BEAM), {"grids": [3]}, np.eye(3))
    assert not place.sheet
    assert place.axes == pytest.approx(np.eye(3))
