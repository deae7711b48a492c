"""Supports that give, where the known parameters are no longer the deck's; a bar is off them."""

from dataclasses import replace

import numpy as np
import pytest
import scipy.linalg as la

from trueup.adapters.nastran import read_deck
from trueup.adapters.nastran.discovery.build_structure import build_structure
from trueup.adapters.nastran.fields.parameter_references import parse_parameter
from trueup.core.discovery.effects.effect_kind import Scale
from trueup.core.discovery.effects.support_flexibility import (
    KIND,
    at_parameters,
    carried,
    given,
)

DECK = """CEND
BEGIN BULK
{grids}{shells}PSHELL,1,1,{thickness},1,,1
GRID,13,,60.,50.,30.
CBAR,99,2,12,13,1.,0.,0.
PBAR,2,1,20.,30.,30.,60.
MAT1,1,70000.,,0.3,2.7-9
ENDDATA
"""
GRIDS = "".join(
    f"GRID,{1 + i + 4 * j},,{20.0 * i},{25.0 * j},0.,,{'123456' if j == 0 else ''}\n"
    for j in range(3)
    for i in range(4)
)
SHELLS = "".join(
    f"CQUAD4,{1 + i + 3 * j},1,{a},{a + 1},{a + 5},{a + 4}\n"
    for j in range(2)
    for i in range(3)
    for a in [1 + i + 4 * j]
)


@pytest.fixture
def held(tmp_path):
    """Return a plate held along an edge, at a thickness, and the places of what may give."""

    def at(thickness):
        path = tmp_path / f"{thickness}.bdf"
        path.write_text(DECK.format(grids=GRIDS, shells=SHELLS, thickness=thickness))
        made = build_structure(read_deck(path), [parse_parameter("PSHELL 1 T [0.5, 2.]")])
        return made, KIND.places(made, Scale(1e-4, 80.0, 1e6, (100.0, 900.0)))

    return at


@pytest.mark.parametrize("theta", [-3.0, 4.0, 12.0])
def test_a_support_at_other_parameters_is_that_of_a_deck_which_has_them(held, theta):
    (structure, here), (_, there) = held(3.0), held(3.6)
    assert len(here) == len(there)
    for c, d in zip(here, there, strict=True):
        row, last = len(c) - 1, np.zeros(1, int)
        moved = at_parameters(structure, c, row, np.log([1.2]))
        released = []
        for one, at, p in ((moved, 0, np.log([1.2])), (d, row, np.zeros(1))):
            law = one.law.on_basis(np.array([at]), None, p, 0.0)
            root = one.root[at * one.rows_each : (at + 1) * one.rows_each].toarray()
            released.append(root.T * law.value(np.array([[theta]]), last)[0] @ root)
        assert released[0] == pytest.approx(
            released[1], rel=1e-3, abs=1e-3 * abs(released[1]).max()
        )


@pytest.mark.parametrize("further", [-0.03, 0.03])
def test_from_there_what_a_support_holds_follows_the_parameters(held, further):
    """A release leaves a thousandth of it; slopes of the deck as it is are off by 2 %."""
    thickness = 3.6 * np.exp(further)
    (structure, here), (_, there) = held(3.0), held(thickness)
    for c, d in zip(here, there, strict=True):
        row, last = len(c) - 1, np.zeros(1, int)
        moved = at_parameters(structure, c, row, np.log([1.2]))
        law = moved.law.on_basis(last, None, np.log([thickness / 3.0]), 0.0)
        other = d.law.on_basis(np.array([row]), None, np.zeros(1), 0.0)
        held_there = other.own[other.own != 1.0]
        assert (law.factor(last) * law.own)[0] == pytest.approx(held_there, rel=2e-3)


ROD = """CEND
SPC=1
BEGIN BULK
GRID,1,,0.,0.,0.,,23456
GRID,2,,50.,0.,0.,,23456
GRID,3,,150.,0.,0.,,23456
CROD,1,1,1,2
CROD,2,1,2,3
PROD,1,1,10.
MAT1,1,70000.,,0.3,2.7-6
CONM2,9,3,,.002
PARAM,COUPMASS,1
SPC1,1,{components},1
{spring}ENDDATA
"""


@pytest.mark.parametrize("stiffness", [300.0, 3000.0])
def test_a_support_that_sinks_has_its_mass_with_it(stiffness, tmp_path):
    """Without it the square of the lowest frequency is 8 to 15 % too high."""
    decks = {"deck": ("1", ""), "truth": ("2", f"CELAS2,7,{stiffness},1,1\n")}
    made = {}
    for name, (components, spring) in decks.items():
        path = tmp_path / f"{name}.bdf"
        path.write_text(ROD.format(components=components, spring=spring))
        made[name] = build_structure(read_deck(path))
    structure = made["deck"]
    (place,) = (
        c for c in KIND.places(structure, Scale(0.02, 150.0, 1e6, (100.0, 900.0))) if len(c)
    )
    place = replace(place, law=place.law.on_basis(np.zeros(1, int), None, np.zeros(0), 0.0))
    theta, free = (np.log(stiffness),), np.eye(2)
    give = given(place, theta, place.root.toarray())
    softer = place.law.value(np.array([theta]), np.zeros(1, int))[0]
    K = structure.model.K().toarray() + place.root.toarray().T * softer @ place.root.toarray()
    M = structure.model.M().toarray()
    whole = [made["truth"].model.K().toarray(), made["truth"].model.M().toarray()]
    exact = la.eigh(*whole, eigvals_only=True)[0]
    assert la.eigh(K, M, eigvals_only=True)[0] > 1.05 * exact
    carrying = M + carried(structure.supports, free, give)
    assert la.eigh(K, carrying, eigvals_only=True)[0] == pytest.approx(exact, rel=2e-3)
    own = structure.supports.motion @ give
    assert own[0] @ np.ones(2) == pytest.approx(1.0, abs=stiffness / 14000.0)
