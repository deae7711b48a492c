"""Equipment on a beam: offset and inertia as a rigid body has them."""

import numpy as np
import pytest

import trueup
from trueup.adapters.nastran.discovery.build_structure import build_structure
from trueup.core.discovery.effects.effect_kind import Scale
from trueup.core.discovery.effects.equipment import Body, equipment, further, stand
from trueup.core.discovery.effects.point_mass import KIND

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


@pytest.mark.parametrize(("deck", "grid", "footprint"), [(BEAM, 3, 1), (PLATE, 6, 9)])
def test_a_rigid_motion_gives_the_kinetic_energy_of_a_rigid_body(tmp_path, deck, grid, footprint):
    path = tmp_path / "it.bdf"
    path.write_text(deck)
    structure = build_structure(trueup.read_deck(path), ())
    model = structure.model
    (masses, *_) = KIND.places(structure, Scale(1.0, 1.0, 1.0, (1.0, 2.0)))
    place = stand(structure, {"grids": [grid]}, np.eye(3))
    assert len(place.where["grids"]) == footprint
    body = Body((0.02, -0.01, 0.06), 0.03)
    made = equipment(masses, [place], [body])
    rng = np.random.default_rng(3)
    t, w = rng.normal(size=3), rng.normal(size=3)
    x = model.geometry.xyz[model.geometry.index_of(model.dofs.node)]
    moved = np.where((model.dofs.component <= 3)[:, None], t + np.cross(w, x), w)
    u = moved[np.arange(len(x)), (model.dofs.component - 1) % 3]
    q = np.linalg.lstsq(model.expansion.toarray(), u, rcond=None)[0]
    centre = t + np.cross(w, place.xyz + np.array(body.offset))
    assert q @ (made.full(0) @ q) == pytest.approx(centre @ centre + 0.03**2 * (w @ w))
    assert further(made, 0, {"mass": 2.0}) == {
        "offset": [0.02, -0.01, 0.06],
        "inertia": pytest.approx(2.0 * 0.03**2),
    }


def test_mirrored_places_have_mirrored_offsets(tmp_path):
    path = tmp_path / "it.bdf"
    path.write_text(PLATE)
    structure = build_structure(trueup.read_deck(path), ())
    (masses, *_) = KIND.places(structure, Scale(1.0, 1.0, 1.0, (1.0, 2.0)))
    both = [
        stand(structure, {"grids": [6]}, np.eye(3)),
        stand(structure, {"grids": [7]}, np.diag([-1.0, 1.0, 1.0])),
    ]
    made = equipment(masses, both, [Body((0.02, 0.01, 0.0), 0.0)])
    assert made.copies == ((0, 1),)
    assert [b.offset for b in made.single.bodies] == [(0.02, 0.01, 0.0), (-0.02, 0.01, 0.0)]


def test_equipment_stands_up_from_a_sheet_and_on_a_bar_along_the_basic_axes(tmp_path):
    path = tmp_path / "it.bdf"
    tilted = PLATE.replace(",0.\nGRID", ",0.\nGRID")
    for j in range(4):
        for i in range(4):
            grid, y = 1 + i + 4 * j, 0.1 * j
            flat = f"GRID,{grid},,{0.1 * i},{y},0.\n"
            tilted = tilted.replace(flat, f"GRID,{grid},,{0.1 * i},{0.8 * y},{0.6 * y}\n")
    path.write_text(tilted)
    structure = build_structure(trueup.read_deck(path), ())
    place = stand(structure, {"grids": [6]}, np.eye(3))
    axes = place.axes
    assert place.sheet
    assert axes[0] == pytest.approx([0.0, -0.6, 0.8])
    assert axes[1] == pytest.approx([1.0, 0.0, 0.0])
    assert axes @ axes.T == pytest.approx(np.eye(3))
    path.write_text(BEAM)
    structure = build_structure(trueup.read_deck(path), ())
    place = stand(structure, {"grids": [3]}, np.eye(3))
    assert not place.sheet
    assert place.axes == pytest.approx(np.eye(3))
