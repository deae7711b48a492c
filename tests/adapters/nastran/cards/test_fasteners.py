"""CWELD and CFAST against closed forms: rigid motions, uniform strains, the beam they stand for."""

import numpy as np
import pytest

from trueup.adapters.nastran import build_model, read_deck
from trueup.core.elements.connectors.patches import foot
from trueup.core.errors import InputError

SHELLS = """GRID,1,,0.,0.,0.
GRID,2,,20.,0.,0.
GRID,3,,22.,18.,0.
GRID,4,,-1.,20.,0.
GRID,5,,30.,0.,0.
GRID,6,,30.,20.,0.
GRID,11,,1.,1.,3.
GRID,12,,21.,1.,3.
GRID,13,,9.,22.,3.
GRID,50,,9.,7.,1.
CQUAD4,1,1,1,2,3,4
CQUAD4,2,1,2,5,6,3
CTRIA3,3,2,11,12,13
PSHELL,1,1,1.2
PSHELL,2,1,2.0
MAT1,1,2.1E5,,.3
CONM2,900,50,,1.
"""
E, G = 2.1e5, 2.1e5 / 2.6


@pytest.fixture
def stiffness(tmp_path):
    """K of a connector alone: with it less without it, basic axes, six a grid."""

    def of(card, shells=SHELLS):
        def whole(more):
            (tmp_path / "a.bdf").write_text(
                f"BEGIN BULK\nPARAM,AUTOSPC,NO\n{shells}{more}ENDDATA\n"
            )
            model = build_model(read_deck(tmp_path / "a.bdf"))
            T = model.expansion.toarray()
            return T @ model.K().toarray() @ T.T, model.geometry

        (K, geometry), (K0, _) = whole(card), whole("")
        return K - K0, geometry

    return of


def rigid(geometry):
    R = np.zeros((len(geometry.ids), 6, 6))
    for k in range(3):
        R[:, k, k] = R[:, 3 + k, 3 + k] = 1.0
        R[:, :3, 3 + k] = np.cross(np.eye(3)[k], geometry.xyz)
    return R.reshape(-1, 6)


FORMS = {
    "elements": "CWELD,7,5,50,ELEMID\n,1,3\n",
    "grids": "CWELD,7,5,50,GRIDID,,,,QT\n,1,2,3,4\n,11,12,13\n",
    "patches of elements": "CWELD,7,5,50,ELPAT\n,1,3\n",
    "patches of properties": "CWELD,7,5,50,PARTPAT\n,1,2\n",
    "a place": "CWELD,7,5,,PARTPAT\n,1,2\n,9.,7.,1.\n",
}


@pytest.mark.parametrize("card", [*FORMS.values(), "CFAST,7,6,PROP,1,2,50\n"])
def test_rigid_motions_cost_nothing(stiffness, card):
    K, geometry = stiffness(card + "PWELD,5,1,4.\nPFAST,6,4.,,,1.+5,2.+4,3.+4,1.+6\n,2.+6,3.+6\n")
    assert np.abs(K @ rigid(geometry)).max() < 1e-9 * K.max() * 30.0
    assert np.linalg.matrix_rank(K, tol=1e-7 * K.max()) == 6


def test_every_form_is_one_weld_where_the_patch_is_one_element(stiffness):
    found = [stiffness(card + "PWELD,5,1,4.\n")[0] for card in FORMS.values()]
    for K in found[1:]:
        np.testing.assert_allclose(K, found[0], atol=1e-9 * found[0].max())


def test_uniform_separation_is_that_of_the_bar(stiffness):
    """Plates 3 apart, diameter 4: E A / L; sideways bending and shear of 0.9 of the area."""
    K, geometry = stiffness("CWELD,7,5,50,ELEMID\n,1,3\nPWELD,5,1,4.\n")
    upper = np.zeros((len(geometry.ids), 6))
    upper[geometry.xyz[:, 2] == 3.0, 2] = 1.0
    assert upper.ravel() @ K @ upper.ravel() == pytest.approx(E * np.pi * 4.0 / 3.0)
    sideways = np.roll(upper, -2, axis=1).ravel()
    inertia, area = np.pi * 4.0, np.pi * 4.0
    held = 12 * E * inertia / 27.0 / (1.0 + 12 * E * inertia / (0.9 * G * area * 9.0))
    assert sideways @ K @ sideways == pytest.approx(held)


@pytest.mark.parametrize(
    ("weld", "length"),
    [
        ("PWELD,5,1,4.", 3.0),
        ("PWELD,5,1,20.", 4.0),  # no shorter than a fifth of its diameter
        ("PWELD,5,1,.5", 2.5),  # no longer than five
        ("PWELD,5,1,.5,,,,,SPOT", 1.6),  # mean of both sheets
        ("PWELD,5,1,20.,,,,,\n,.01", 3.0),
    ],
)
def test_effective_length(stiffness, weld, length):
    K, geometry = stiffness(f"CWELD,7,5,50,ELEMID\n,1,3\n{weld}\n")
    upper = np.zeros((len(geometry.ids), 6))
    upper[geometry.xyz[:, 2] == 3.0, 2] = 1.0
    d = float(weld.split(",")[3])
    expected = E * np.pi * d**2 / 4.0 / length
    assert upper.ravel() @ K @ upper.ravel() == pytest.approx(expected)


def test_a_weld_from_grid_to_grid_is_a_bar(stiffness):
    K, _ = stiffness("CWELD,7,5,,ALIGN,2,12\nPWELD,5,1,4.\n")
    rod = f"PBAR,5,1,{np.pi * 4!r},{np.pi * 4!r},{np.pi * 4!r},{np.pi * 8!r}\n,,,,,,,,\n,.9,.9\n"
    bar, _ = stiffness("CBAR,7,5,2,12,0.,1.,0.\n" + rod)
    np.testing.assert_allclose(K, bar, atol=1e-9 * bar.max())


def test_a_fastener_is_six_springs_along_its_axes(stiffness):
    K, geometry = stiffness("CFAST,7,6,ELEM,1,3,50\nPFAST,6,4.,,,1.+5,2.+4,3.+4\n")
    upper = np.zeros((len(geometry.ids), 6, 3))
    upper[geometry.xyz[:, 2] == 3.0, :3] = np.eye(3)
    upper = upper.reshape(-1, 3)
    np.testing.assert_allclose(upper.T @ K @ upper, np.diag([2e4, 3e4, 1e5]), atol=1e-6)
    system = "CORD2R,9,,0.,0.,0.,1.,0.,0.\n,0.,1.,0.\n"  # its x, y, z are y, z, x of the basic one
    K, _ = stiffness("CFAST,7,6,ELEM,1,3,50\nPFAST,6,4.,9,,1.+5,2.+4,3.+4\n" + system)
    np.testing.assert_allclose(upper.T @ K @ upper, np.diag([3e4, 1e5, 2e4]), atol=1e-6)


@pytest.mark.parametrize(
    ("card", "message"),
    [
        ("CWELD,7,5,50,ELEMID\n,1,99\n", "refers to shell element 99"),
        ("CWELD,7,5,50,PARTPAT\n,1,99\n", "refers to shell property 99"),
        ("CWELD,7,5,50,ELEMID\n,2,3\n", "does not pierce both"),
        ("CWELD,7,5,,ELEMID\n,1,3\n", "neither GS nor GA"),
        ("CWELD,7,5,50,GRIDID\n,1,2\n,11,12,13\n", "three or four grids"),
        ("CWELD,7,5,50,WHAT\n,1,3\n", "format WHAT is not supported"),
        ("CWELD,7,5,,ALIGN,2,2\n", "its grids coincide"),
        ("CWELD,7,55,50,ELEMID\n,1,3\n", "there is no PWELD 55"),
    ],
)
def test_what_a_connector_lacks_is_named(stiffness, card, message):
    with pytest.raises(InputError, match=rf"CWELD 7.*line \d+.*{message}"):
        stiffness(card + "PWELD,5,1,4.\n")


def test_a_foot_follows_what_a_patch_can_do():
    """Linear motions are followed exactly, on a skewed and warped patch as well."""
    rng = np.random.default_rng(1)
    xyz = np.array([[0.0, 0, 0], [4, 1, 0.2], [5, 5, -0.3], [-1, 4, 0.1]])
    for corners in (3, 4):
        at = foot(xyz[:corners], np.array([1.5, 2.0, 3.0]))
        assert at.outside < 0.0
        t = rng.standard_normal(3)
        spin = rng.standard_normal(3)
        u = t + np.cross(spin, xyz[:corners])
        moved = at.motion @ u.ravel()
        np.testing.assert_allclose(moved, [*(t + np.cross(spin, at.point)), *spin], atol=1e-12)
        away = np.array([1.5, 2.0, 3.0]) - at.point
        np.testing.assert_allclose(np.cross(away, at.normal), 0.0, atol=1e-9)
