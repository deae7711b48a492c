"""Edges along which shells are held, and stretches of them that give."""

import numpy as np
import pytest

from trueup.adapters.nastran import read_deck
from trueup.adapters.nastran.discovery.build_structure import build_structure
from trueup.core.discovery.effects import KINDS
from trueup.core.discovery.effects.candidates import Suspect, beside
from trueup.core.discovery.effects.effect_kind import Scale
from trueup.core.discovery.effects.shell_edges import edges_of

N = 4
DECK = """CEND
BEGIN BULK
{cards}PSHELL,1,1,3.,1,,1
MAT1,1,70000.,,0.3,2.7-9
ENDDATA
"""


@pytest.fixture(scope="module")
def structure(tmp_path_factory):
    """A plate of four by two shells, held along y = 0, with a web on its middle line x = 40."""
    cards = ""
    for j in range(3):
        for i in range(N + 1):
            held = ",,123456" if j == 0 else ""
            cards += f"GRID,{1 + i + 5 * j},,{20.0 * i},{25.0 * j},0.{held}\n"
    cards += "GRID,21,,40.,0.,15.,,123456\nGRID,22,,40.,25.,15.\n"
    for j in range(2):
        for i in range(N):
            a = 1 + i + 5 * j
            cards += f"CQUAD4,{1 + i + N * j},1,{a},{a + 1},{a + 6},{a + 5}\n"
    cards += "CQUAD4,30,1,3,8,22,21\n"
    path = tmp_path_factory.mktemp("edge") / "deck.bdf"
    path.write_text(DECK.format(cards=cards))
    return build_structure(read_deck(path))


def test_an_edge_goes_on_without_a_bend_and_knows_its_direction_and_normal(structure):
    edges = sorted(edges_of(structure, structure.supports), key=lambda e: -len(e.grids))
    along, web = edges
    assert sorted([along.grids[0], along.grids[-1]]) == [1, 5]
    np.testing.assert_allclose(np.abs(np.diff(along.xyz[:, 0])), 20.0)
    np.testing.assert_allclose(np.abs(along.along), np.tile([1.0, 0, 0], (5, 1)))
    np.testing.assert_allclose(np.abs(along.normal), np.tile([0, 0, 1.0], (5, 1)))
    assert sorted(web.grids.tolist()) == [3, 21]
    np.testing.assert_allclose(np.abs(web.normal), np.tile([1.0, 0, 0], (2, 1)))


def _kinds(structure):
    size = structure.model.geometry.size
    return KINDS["support_flexibility"].places(structure, Scale(1e-3, size, 1e6, (100.0, 900.0)))


def _row(kinds, grids, components, free=None):
    for c in kinds:
        for row, w in enumerate(c.where):
            same = (w["grids"], w["components"], w.get("free_components"))
            if same == (grids, components, free):
                return c, row
    raise AssertionError(f"no candidate {grids} {components} {free}")


@pytest.mark.parametrize(
    ("components", "free"), [([3], None), ([4], None), ([3], [4]), ([3], [4, 5, 6])]
)
def test_a_stretch_takes_from_the_stiffness_what_springs_there_would(structure, components, free):
    c, row = _row(_kinds(structure), [2, 3, 4], components, free)
    s, k = structure.supports, 50.0
    sprung = np.flatnonzero(np.isin(s.grid, [2, 3, 4]) & np.isin(s.component, components))
    loose = np.flatnonzero(np.isin(s.grid, [2, 3, 4]) & np.isin(s.component, free or []))
    rows = np.r_[loose, sprung]
    R = s.root[rows].toarray()
    C = s.coupling[rows][:, rows].toarray()
    C += np.diag([0.0] * len(loose) + [k / 3] * len(sprung))
    value = c.law.value(np.log([[k]]), np.array([row]))[0]
    root = c.root[row * c.rows_each : (row + 1) * c.rows_each].toarray()
    expected = -R.T @ np.linalg.solve(C, R)
    np.testing.assert_allclose((root.T * value) @ root, expected, atol=1e-9 * abs(expected).max())


def test_beside_a_stretch_are_longer_and_shorter_ones_and_its_other_ways_to_give(
    structure,
):
    kinds = _kinds(structure)
    c, row = _row(kinds, [2, 3, 4], [3], [4])
    number = next(k for k, other in enumerate(kinds) if other is c)
    own, others = set(), set()
    for s in beside(kinds, Suspect(number, row, (1.0,))):
        w = kinds[s.kind].where[s.row]
        if s.kind == number:
            own.add(tuple(w["grids"]))
        else:
            assert w["grids"] == [2, 3, 4]
            others.add((*w["components"], *w.get("free_components", ())))
    assert own == {(2, 3), (3, 4), (1, 2, 3), (3, 4, 5), (1, 2, 3, 4), (2, 3, 4, 5)}
    assert others == {(1,), (2,), (3,), (4,), (3, 4, 5, 6)}
