"""Supports that give, where the known parameters are no longer the deck's; a bar is off them."""

import numpy as np
import pytest

from trueup.adapters.nastran import read_deck
from trueup.adapters.nastran.discovery.build_structure import build_structure
from trueup.adapters.nastran.fields.parameter_references import parse_parameter
from trueup.core.discovery.effects.effect_kind import Scale
from trueup.core.discovery.effects.support_flexibility import KIND, at_parameters

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
