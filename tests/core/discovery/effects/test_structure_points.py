"""Points between the grids of a structure, and how they move."""

import numpy as np

from trueup.adapters.nastran import read_deck
from trueup.adapters.nastran.discovery.build_structure import build_structure
from trueup.core.discovery.effects.structure_points import points_of

DECK = """CEND
BEGIN BULK
GRID,1,,0.,0.,0.
GRID,2,,20.,0.,0.
GRID,3,,40.,0.,0.
GRID,4,,0.,25.,0.
GRID,5,,20.,25.,0.
GRID,6,,40.,25.,0.
GRID,7,,60.,25.,8.
CQUAD4,1,1,1,2,5,4
CQUAD4,2,1,2,3,6,5
CBAR,3,2,6,7,0.,0.,1.
PSHELL,1,1,3.,1,,1
PBAR,2,1,10.,10.,10.,10.
MAT1,1,70000.,,0.3,2.7-9
ENDDATA
"""


def test_a_bent_shell_lies_between_its_grids_where_their_rotations_say(tmp_path):
    """Bent to w = x² + 2xy + 3y², it is there at the middles of its elements and edges, too.

    Points of a rigid rotation about any axis move with it, the bar's middle and quarters as well.
    """
    (tmp_path / "deck.bdf").write_text(DECK)
    structure = build_structure(read_deck(tmp_path / "deck.bdf"))
    g, dofs = structure.model.geometry, structure.model.dofs
    points = points_of(structure)
    assert len(points.xyz) == 7 + 2 + 7 + 1 + 2

    def seen(moves, turns):
        every = np.hstack([moves, turns])[g.index_of(dofs.node), dofs.component - 1]
        free = np.linalg.lstsq(structure.model.expansion.toarray(), every, rcond=None)[0]
        return (points.moves @ free).reshape(-1, 3)

    def bent(at):
        x, y, _ = at.T
        return np.column_stack([0.0 * x, 0.0 * x, x**2 + 2.0 * x * y + 3.0 * y**2])

    x, y, _ = g.xyz.T
    turned = np.column_stack([2.0 * x + 6.0 * y, -2.0 * x - 2.0 * y, 0.0 * x])
    on_shell = [7 not in w["grids"] and "arms" not in w for w in points.where]
    found, expected = seen(bent(g.xyz), turned), bent(points.xyz)
    np.testing.assert_allclose(found[on_shell], expected[on_shell], rtol=1e-9, atol=1e-6)
    axis = np.array([0.3, -0.5, 0.7])
    found = seen(np.cross(axis, g.xyz), np.tile(axis, (7, 1)))
    np.testing.assert_allclose(found, np.cross(axis, points.xyz), atol=1e-9)


def test_the_quarters_of_a_bar_are_carried_by_the_grid_next_to_them(tmp_path):
    (tmp_path / "deck.bdf").write_text(DECK)
    structure = build_structure(read_deck(tmp_path / "deck.bdf"))
    points = points_of(structure)
    carried = {
        w["grids"][0]: (w["arms"], x)
        for w, x in zip(points.where, points.xyz, strict=True)
        if "arms" in w
    }
    assert carried.keys() == {6, 7}
    assert carried[6][0] == [(5.0, 0.0, 2.0)]
    np.testing.assert_allclose(carried[6][1], [45.0, 25.0, 2.0])
    assert carried[7][0] == [(-5.0, 0.0, -2.0)]
    np.testing.assert_allclose(carried[7][1], [55.0, 25.0, 6.0])


def test_no_point_hangs_on_a_grid_that_is_held(tmp_path):
    (tmp_path / "deck.bdf").write_text(
        DECK.replace("GRID,7,,60.,25.,8.", "GRID,7,,60.,25.,8.,,123456")
    )
    points = points_of(build_structure(read_deck(tmp_path / "deck.bdf")))
    assert [w["grids"] for w in points.where if "arms" in w] == [[6]]
