"""Every effect written into a deck, read back and solved: the frequencies of a closed form.

Decks of one or two masses whose bars are so stiff that only the effect gives.
"""

import numpy as np
import pytest

from trueup.adapters.nastran import build_model, read_deck, read_deck_text, weight, write_deck
from trueup.adapters.nastran.discovery.write_effect import adopt
from trueup.core.discovery.findings import Finding, Where
from trueup.core.eigen import normal_modes
from trueup.core.errors import InputError

WTMASS = 0.00259

MASS = """CEND
BEGIN BULK
PARAM,WTMASS,{wtmass}
CORD2R,7,,0.,0.,0.,0.,1.,1.
,1.,0.,0.
GRID,1,,10.,20.,30.,{cd},456
CELAS2,1,4.0E4,1,1
CELAS2,2,6.0E4,1,2
CELAS2,3,9.0E4,1,3
CONM2,4,1,,0.01
ENDDATA
"""

TWO_MASSES = """CEND
BEGIN BULK
GRID,1,,0.,0.,0.,,456
GRID,2,,30.,40.,0.,,3456
CELAS2,1,4.0E4,1,1
CELAS2,2,6.0E4,1,2
CELAS2,3,9.0E4,1,3
CELAS2,5,1.0E4,2,1
CELAS2,6,2.0E4,2,2
CONM2,4,1,,0.01
CONM2,7,2,,0.01
ENDDATA
"""

THREE_POINTS = """CEND
BEGIN BULK
GRID,1,,0.,-10.,0.,,23456
GRID,2,,0.,10.,0.,,23456
GRID,3,,100.,0.,0.,,123456
CELAS2,1,4.0E4,1,1
CELAS2,2,6.0E4,2,1
CONM2,4,1,,0.01
CONM2,7,2,,0.01
ENDDATA
"""

STIFF_ARMS = """CEND
BEGIN BULK
GRID,1,,0.,0.,0.,,123456
GRID,2,,100.,0.,0.
GRID,3,,100.,200.,0.
CBAR,1,1,1,2,0.,0.,1.
CBAR,2,1,2,3,0.,0.,1.
PBAR,1,1,1.+4,1.+8,1.+8,1.+8
MAT1,1,2.+7,,.3
CONM2,9,3,,0.02
ENDDATA
"""

ROD = """CEND
BEGIN BULK
GRID,1,,0.,0.,0.,,123456
GRID,2,,50.,0.,0.,,23456
GRID,3,,100.,0.,0.,,23456
CROD,1,1,1,2
CROD,2,1,2,3
PROD,1,1,2.
MAT1,1,70000.,,.3
CONM2,9,3,,0.02
ENDDATA
"""

PLATE = """CEND
BEGIN BULK
PARAM,WTMASS,{wtmass}
GRID,1,,0.,0.,0.
GRID,2,,40.,0.,0.
GRID,3,,80.,0.,0.
GRID,4,,0.,30.,0.
GRID,5,,40.,30.,0.
GRID,6,,80.,30.,0.
CQUAD4,1,1,1,2,5,4
CQUAD4,2,1,2,3,6,5
PSHELL,1,1,2.,1
MAT1,1,70000.,,0.3,2.7-6
ENDDATA
"""


def finding(kind, magnitude, **where):
    place = Where.of(where, np.zeros(3), region="near grid 1")
    return Finding("model", kind, place, magnitude, (0.9, 1.1), (), 0.9, "Something is missing.")


def completed(folder, text, what):
    """Return the completed deck and its frequencies [Hz], of a mode with stiffness."""
    (folder / "deck.bdf").write_text(text)
    read = read_deck_text(folder / "deck.bdf")
    done = adopt(read, read_deck(folder / "deck.bdf"), what)
    deck = read_deck(write_deck(done.deck, folder / "out"))
    model = build_model(deck)
    found = normal_modes.solve(model, n_modes=min(3, model.n_free))
    return deck, np.sqrt(np.abs(found.eigenvalues)) / (2.0 * np.pi)


def hz(k, m):
    return np.sqrt(k / m) / (2.0 * np.pi)


@pytest.mark.parametrize("wtmass", [1.0, WTMASS])
def test_a_mass_counts_as_cards_count_masses(tmp_path, wtmass):
    what = finding("point_mass", {"mass": 0.004}, grids=[1])
    _, found = completed(tmp_path, MASS.format(cd="", wtmass=wtmass), what)
    np.testing.assert_allclose(found, hz(np.array([4e4, 6e4, 9e4]), 0.014 * wtmass), rtol=1e-9)


@pytest.mark.parametrize("cd", ["", "7"])
@pytest.mark.parametrize("c", [1, 2, 3])
def test_a_spring_acts_along_the_basic_axis_whatever_the_grids_own_axes(tmp_path, cd, c):
    what = finding("ground_spring", {"stiffness": 3e4, "components": [c]}, grids=[1])
    _, found = completed(tmp_path, MASS.format(cd=cd, wtmass=1.0), what)
    z = np.array([0.0, 1.0, 1.0]) / np.sqrt(2.0)
    x = np.array([1.0, 0.0, 0.0])
    T = np.column_stack([x, np.cross(z, x), z]) if cd else np.eye(3)
    K = T @ np.diag([4e4, 6e4, 9e4]) @ T.T
    K[c - 1, c - 1] += 3e4
    np.testing.assert_allclose(found, hz(np.linalg.eigvalsh(K), 0.01), rtol=1e-6)


def test_a_spring_between_two_masses_acts_along_the_line_through_them(tmp_path):
    what = finding("link_spring", {"stiffness": 3e4, "components": [1]}, grids=[1, 2])
    _, found = completed(tmp_path, TWO_MASSES, what)
    n = np.array([-0.6, -0.8, 0.0, 0.6, 0.8])
    K = np.diag([4e4, 6e4, 9e4, 1e4, 2e4]) + 3e4 * np.outer(n, n)
    np.testing.assert_allclose(found, hz(np.linalg.eigvalsh(K)[:3], 0.01), rtol=1e-6)


def test_a_spring_that_ends_between_two_grids_pulls_at_both(tmp_path):
    ends = ((1, 2), (3,))
    what = finding("link_spring", {"stiffness": 3e4, "components": [1]}, grids=[1, 2, 3], ends=ends)
    _, found = completed(tmp_path, THREE_POINTS, what)
    K = np.diag([4e4, 6e4]) + 3e4 / 4.0
    np.testing.assert_allclose(found, hz(np.linalg.eigvalsh(K), 0.01), rtol=1e-6)


BEAM = """CEND
BEGIN BULK
GRID,1,,0.,0.,0.,,123456
GRID,2,,100.,0.,0.,{cd},
CORD2R,7,,0.,0.,0.,0.,1.,1.
,1.,0.,0.
CBAR,1,1,1,2,0.,0.,1.
PBAR,1,1,1.+4,100.,200.,1.+6
MAT1,1,2.+5,,.3
CONM2,9,2,,1.-4
ENDDATA
"""


def cantilever(root, m, k=0.0):
    """Return frequencies [Hz] of a tip mass, m at the point that `root` (3, 6) moves, k on it."""
    length, area, iy, iz, E, J = 100.0, 1e4, 100.0, 200.0, 2e5, 1e6
    K = np.diag([E * area / length, 0.0, 0.0, E / 2.6 * J / length, 0.0, 0.0])
    for (u, t), inertia, sign in (((1, 5), iz, -1.0), ((2, 4), iy, 1.0)):
        K[np.ix_((u, t), (u, t))] = (
            E * inertia / length**3
            * np.array([[12.0, 6.0 * sign * length], [6.0 * sign * length, 4.0 * length**2]])
        )  # fmt: skip
    M = np.diag([1e-4] * 3 + [0.0] * 3) + m * root.T @ root
    K = K + k * np.outer(root[2], root[2])
    C = np.linalg.solve(K, M)
    values = np.sort(np.linalg.eigvals(C).real)[::-1][:3]
    return 1.0 / np.sqrt(values) / (2.0 * np.pi)


SHEET = (
    "SOL 103\nCEND\nSPC = 1\nBEGIN BULK\nCORD2R,7,,0.,0.,0.,0.,1.,1.\n,1.,0.,0.\nPARAM,K6ROT,1.-6\n"
    + "".join(
        f"GRID,{1 + i + 3 * j},,{20.0 * i},{20.0 * j},0.,{{cd}}\n"
        for j in range(3)
        for i in range(3)
    )
    + "".join(f"CQUAD4,{g},1,{g},{g + 1},{g + 4},{g + 3}\n" for g in (1, 2, 4, 5))
    + "SPC1,1,123456,1,2,3\nPSHELL,1,1,1.,1,,1\nMAT1,1,7.+4,,.3,2.7-9\nENDDATA\n"
)

BEYOND = np.array([[1.0, 0, 0, 0, 0, 0], [0, 1.0, 0, 0, 0, -25.0], [0, 0, 1.0, 0, 25.0, 0]])


@pytest.mark.parametrize("cd", ["", "7"])
def test_a_mass_between_grids_of_a_bar_is_an_arm_off_the_grid_that_carries_it(tmp_path, cd):
    """A mass that turns with a tip a quarter of the bar's length from it."""
    what = finding("point_mass", {"mass": 3e-4}, grids=[2], arms=((-25.0, 0.0, 0.0),))
    _, found = completed(tmp_path, BEAM.format(cd=cd), what)
    np.testing.assert_allclose(found, cantilever(BEYOND, 3e-4), rtol=1e-6)


@pytest.mark.parametrize("cd", ["", "7"])
def test_a_spring_between_grids_of_a_bar_pulls_where_it_is(tmp_path, cd):
    what = finding(
        "ground_spring",
        {"stiffness": 500.0, "components": [3]},
        grids=[2],
        arms=((-25.0, 0.0, 0.0),),
    )
    _, found = completed(tmp_path, BEAM.format(cd=cd), what)
    np.testing.assert_allclose(found, cantilever(BEYOND, 0.0, 500.0), rtol=1e-6)


def test_equipment_between_grids_is_off_by_its_arm_and_its_offset(tmp_path):
    size = {"mass": 3e-4, "offset": [5.0, 0.0, 0.0], "inertia": 0.0}
    what = finding("point_mass", size, grids=[2], arms=((-30.0, 0.0, 0.0),))
    _, found = completed(tmp_path, BEAM.format(cd=""), what)
    np.testing.assert_allclose(found, cantilever(BEYOND, 3e-4), rtol=1e-6)


def carrying(folder, text, cards):
    """Return the lowest frequencies [Hz] of a deck with cards more."""
    (folder / "carrying.bdf").write_text(text.replace("ENDDATA", cards + "ENDDATA"))
    found = normal_modes.solve(build_model(read_deck(folder / "carrying.bdf")), n_modes=3)
    return np.sqrt(found.eigenvalues) / (2.0 * np.pi)


def test_equipment_has_moments_and_products_of_inertia_about_its_centre(tmp_path):
    """A rod from corner to corner in x and y, as heavy halves at its ends are."""
    half = np.array([6.0, 8.0, 0.0])
    J = 3e-4 * (half @ half * np.eye(3) - np.outer(half, half))
    told = [J[0, 0], -J[1, 0], J[1, 1], -J[2, 0], -J[2, 1], J[2, 2]]
    size = {"mass": 3e-4, "inertia": np.trace(J) / 3.0, "inertias": told}
    beam = BEAM.format(cd="")
    _, found = completed(tmp_path, beam, finding("point_mass", size, grids=[2]))
    ends = "CONM2,10,2,,1.5-4,6.,8.,0.\nCONM2,11,2,,1.5-4,-6.,-8.,0.\n"
    np.testing.assert_allclose(found, carrying(tmp_path, beam, ends), rtol=1e-5)


FOOT = {"grids": [5, 1, 2, 3, 4, 6, 7, 8, 9], "normal": (0.0, 0.0, 1.0)}
UPRIGHT = {"mass": 3e-5, "inertia": 2e-3, "inertias": (3e-3, 0.0, 3e-3, 0.0, 0.0, 0.0)}
CARD = "CONM2,90,5,0,3.-5,{off}\n,3.-3,,3.-3\n"
"""A rod that stands up from a sheet: about itself it resists nothing."""


@pytest.mark.parametrize("cd", ["", "7"])
def test_equipment_on_one_grid_of_a_sheet_tilts_with_it(tmp_path, cd):
    sheet = SHEET.format(cd=cd)
    above = {**UPRIGHT, "offset": [0.0, 0.0, 12.0]}
    _, found = completed(tmp_path, sheet, finding("point_mass", above, **FOOT))
    expected = carrying(tmp_path, sheet, CARD.format(off="0.,0.,12."))
    np.testing.assert_allclose(found, expected, rtol=1e-5)


def test_equipment_beside_one_grid_of_a_sheet_does_not_swing_on_its_drilling_rotation(tmp_path):
    """Which has next to no stiffness where it is none of the grid's own axes that AUTOSPC holds."""
    sheet = SHEET.format(cd="7")
    beside = {**UPRIGHT, "offset": [12.0, 0.0, 0.0]}
    _, found = completed(tmp_path, sheet, finding("point_mass", beside, **FOOT))
    assert found[0] > 5.0 * carrying(tmp_path, sheet, CARD.format(off="12.,0.,0."))[0]


def test_a_foot_that_turns_swings_the_whole_arm(tmp_path):
    what = finding("support_flexibility", {"stiffness": 5e5, "components": [4, 5, 6]}, grids=[1])
    _, found = completed(tmp_path, STIFF_ARMS, what)
    r = np.array([100.0, 200.0, 0.0])
    J = 0.02 * (r @ r * np.eye(3) - np.outer(r, r))
    expected = hz(5e5, np.linalg.eigvalsh(J)[1:][::-1])
    np.testing.assert_allclose(found[:2], expected, rtol=1e-3)


def test_a_foot_that_sinks_moves_the_mass_straight(tmp_path):
    what = finding("support_flexibility", {"stiffness": 300.0, "components": [3]}, grids=[1])
    _, found = completed(tmp_path, STIFF_ARMS, what)
    assert found[0] == pytest.approx(hz(300.0, 0.02), rel=1e-3)


def test_a_soft_joint_swings_what_is_beyond_it(tmp_path):
    what = finding(
        "joint_flexibility",
        {"stiffness": 5e5, "components": [4, 5, 6]},
        grids=[2],
        elements=[2],
    )
    _, found = completed(tmp_path, STIFF_ARMS, what)
    np.testing.assert_allclose(found[:2], hz(5e5, 0.02 * 200.0**2), rtol=1e-3)


def test_a_soft_half_of_a_rod_is_two_springs_in_series(tmp_path):
    what = finding("local_stiffness", {"factor": 0.25}, elements=[1])
    _, found = completed(tmp_path, ROD, what)
    k = 70000.0 * 2.0 / 50.0
    assert found[0] == pytest.approx(hz(1.0 / (1.0 / (0.25 * k) + 1.0 / k), 0.02), rel=1e-6)


@pytest.mark.parametrize("wtmass", [1.0, WTMASS])
def test_a_spread_mass_lies_on_its_elements_alone(tmp_path, wtmass):
    what = finding("distributed_mass", {"mass": 0.012, "mass_per_area": 1e-5}, elements=[2])
    deck, _ = completed(tmp_path, PLATE.format(wtmass=wtmass), what)
    each = 1200.0 * 2.0 * 2.7e-6
    w = weight(deck)
    assert w.mass == pytest.approx(wtmass * (2.0 * each + 0.012), rel=1e-9)
    x = (20.0 * each + 60.0 * (each + 0.012)) / (2.0 * each + 0.012)
    assert w.centre_of_gravity[0] == pytest.approx(x, rel=1e-9)


HELD_BY_MORE = STIFF_ARMS.replace("ENDDATA", "{card}\nENDDATA")


@pytest.mark.parametrize(
    "card", ["RBE2,50,1,123456,4\nGRID,4,,0.,0.,9.", "CELAS2,50,9.,1,1,3,1", "CONM2,50,1,,.1"]
)
def test_a_support_with_more_on_it_than_elements_is_not_taken_apart(tmp_path, card):
    (tmp_path / "deck.bdf").write_text(HELD_BY_MORE.format(card=card))
    what = finding("support_flexibility", {"stiffness": 300.0, "components": [3]}, grids=[1])
    text = read_deck_text(tmp_path / "deck.bdf")
    with pytest.raises(InputError, match=f"grid 1 .*{card.split(',')[0]} 50"):
        adopt(text, read_deck(tmp_path / "deck.bdf"), what)


def test_a_support_that_gives_already_is_not_taken_apart_again(tmp_path):
    (tmp_path / "deck.bdf").write_text(STIFF_ARMS)
    deck = read_deck(tmp_path / "deck.bdf")
    one, other = (
        finding("support_flexibility", {"stiffness": 300.0, "components": [c]}, grids=[1])
        for c in (3, 5)
    )
    text = adopt(read_deck_text(tmp_path / "deck.bdf"), deck, one).deck
    with pytest.raises(InputError, match="detached from grid 1 already"):
        adopt(text, deck, other)


def test_an_edge_of_eight_noded_shells_gives_as_one(tmp_path):
    """A stiff shell on two feet that sink alike: a mass on one spring."""
    deck = """CEND
BEGIN BULK
GRID,1,,0.,0.,0.,,123456
GRID,2,,0.,40.,0.,,123456
GRID,3,,40.,0.,0.,,12456
GRID,4,,40.,40.,0.,,12456
GRID,5,,0.,20.,0.,,123456
GRID,6,,20.,0.,0.,,12456
GRID,7,,40.,20.,0.,,12456
GRID,8,,20.,40.,0.,,12456
CQUAD8,1,1,1,3,4,2,6,7
,8,5
PSHELL,1,1,20.,1,,1
MAT1,1,7.+9,,0.3
CONM2,9,3,,0.01
CONM2,10,4,,0.01
ENDDATA
"""
    what = finding("support_flexibility", {"stiffness": 600.0, "components": [3]}, grids=[1, 2, 5])
    _, found = completed(tmp_path, deck, what)
    assert found[0] == pytest.approx(hz(600.0, 0.02), rel=1e-3)


def test_an_edge_that_sinks_and_turns_freely_lets_a_stiff_shell_swing(tmp_path):
    """A rigid plate, its other edge on springs: it bounces and rocks on two springs in line."""
    deck = """CEND
BEGIN BULK
GRID,1,,0.,0.,0.,,123456
GRID,2,,0.,40.,0.,,123456
GRID,3,,40.,0.,0.,,1246
GRID,4,,40.,40.,0.,,1246
GRID,5,,20.,0.,0.,,1246
GRID,6,,20.,40.,0.,,1246
CQUAD4,1,1,1,5,6,2
CQUAD4,2,1,5,3,4,6
CELAS2,3,200.,3,3
CELAS2,4,200.,4,3
PSHELL,1,1,20.,1,,1
MAT1,1,7.+9,,0.3
CONM2,9,5,,0.01
CONM2,10,6,,0.01
CONM2,11,3,,0.004
CONM2,12,4,,0.004
ENDDATA
"""
    magnitude = {"stiffness": 600.0, "components": [3], "free_components": [5]}
    what = finding("support_flexibility", magnitude, grids=[1, 2])
    _, found = completed(tmp_path, deck, what)
    x, m = np.array([0.0, 20.0, 40.0]), np.array([0.0, 0.02, 0.008])
    M = np.array([[m.sum(), m @ x], [m @ x, m @ x**2]])
    K = np.array([[1000.0, 400.0 * 40.0], [400.0 * 40.0, 400.0 * 40.0**2]])
    expected = np.sqrt(np.sort(np.linalg.eigvals(np.linalg.solve(M, K)).real)) / (2.0 * np.pi)
    np.testing.assert_allclose(found[:2], expected, rtol=1e-3)
