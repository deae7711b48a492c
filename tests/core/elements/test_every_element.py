"""What is promised of every element in the list."""

import numpy as np
import pytest
from tests.core.elements.plates_and_volumes import isotropic_section

from trueup.core.elements import ELEMENTS, register_element
from trueup.core.elements.volumes.solid import isotropic_solid
from trueup.core.errors import InputError

CORNERS = {
    "tria": [[0, 0, 0], [1.0, 0, 0], [0.2, 0.9, 0]],
    "quad": [[0, 0, 0], [1.0, 0, 0], [1.1, 0.9, 0], [0, 1, 0]],
    "tetra": [[0, 0, 0], [1.0, 0, 0], [0, 1, 0], [0, 0, 1]],
    "pyramid": [[0, 0, 0], [1.0, 0, 0], [1, 1, 0], [0, 1, 0], [0.4, 0.6, 1]],
    "penta": [[0, 0, 0], [1.0, 0, 0], [0, 1, 0], [0, 0, 1], [1, 0, 1], [0, 1, 1]],
    "hexa": [
        *([0, 0, 0], [1.0, 0, 0], [1, 1, 0], [0, 1, 0]),
        *([0, 0, 1], [1, 0, 1], [1, 1, 1], [0, 1, 1]),
    ],
}
WITH_AXES_OR_RULES = [e for e in ELEMENTS.values() if e.dimension > 1]


def nodes(element):
    corner = np.array(CORNERS[element.shape.name], float)
    return np.concatenate([corner, *(0.5 * (corner[[i]] + corner[[j]]) for i, j in element.edges)])


@pytest.mark.parametrize("element", ELEMENTS.values(), ids=lambda e: e.name)
def test_is_listed_by_its_own_name_and_says_how_many_nodes_it_has(element):
    assert ELEMENTS[element.name] is element
    assert element.freedoms in (1, 3, 6)
    assert element.nodes == element.corners + len(element.edges)
    assert element.edges.size == 0 or element.edges.max() < element.corners


@pytest.mark.parametrize("element", WITH_AXES_OR_RULES, ids=lambda e: e.name)
def test_a_surface_or_solid_carries_its_mass_and_knows_when_it_is_folded(element):
    xyz = nodes(element)[None]
    M = element.mass(xyz, np.array([2.0]), False)[0]
    assert M.shape == (element.nodes * element.freedoms,) * 2
    assert element.sound(xyz).all()
    assert not element.sound(np.zeros_like(xyz)).any()
    f = element.freedoms
    lumped, consistent = (
        np.trace(element.mass(xyz, np.array([2.0]), way)[0][::f, ::f]) for way in (False, True)
    )
    assert lumped > consistent > 0.0


@pytest.mark.parametrize("element", WITH_AXES_OR_RULES, ids=lambda e: e.name)
def test_a_rigid_motion_costs_nothing(structure, element):
    xyz = nodes(element)
    if element.freedoms == 3:
        constants = (isotropic_solid(2e5, 0.3),)
    elif element.name == "shear_panel":
        constants = (np.array([2e5]), np.array([8e4]), np.array([0.1]))
    else:
        constants = (isotropic_section(2e5, 0.3, 8e4, 0.1),)
    K = element.stiffness(xyz[None], *constants)[0]
    R = structure.rigid_motions(xyz, rotations=element.freedoms == 6)
    assert np.abs(K @ R).max() < 1e-9 * np.abs(K).max()


def test_a_name_is_given_once_and_to_an_element():
    with pytest.raises(InputError, match="what is registered is given as int; it must be Element"):
        register_element(3)
    with pytest.raises(InputError, match="an element 'quad4' already"):
        register_element(ELEMENTS["quad4"])
