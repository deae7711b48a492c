"""CGAP as it stands at the start, GENEL by stiffness and by flexibility."""

import numpy as np
import pytest

from trueup.adapters.nastran import build_model, read_deck
from trueup.core.errors import InputError

GRIDS = "GRID,1,,0.,0.,0.,,456\nGRID,2,,3.,4.,0.,,456\nGRID,3,,3.,4.,0.,,456\n"
MASS = "CONM2,91,1,,1.\nCONM2,92,2,,1.\nCONM2,93,3,,1.\n"


@pytest.fixture
def model(tmp_path):
    def of(text):
        (tmp_path / "a.bdf").write_text("BEGIN BULK\nPARAM,AUTOSPC,NO\n" + text + "ENDDATA\n")
        return build_model(read_deck(tmp_path / "a.bdf"))

    return of


def pair(k, axis):
    """Springs between grids 1 and 2, (9, 9)."""
    axis = np.asarray(axis)
    block = k[0] * np.outer(axis, axis) + k[1] * (np.eye(3) - np.outer(axis, axis))
    return np.kron(np.array([[1.0, -1.0, 0.0], [-1.0, 1.0, 0.0], [0.0, 0.0, 0.0]]), block)


@pytest.mark.parametrize(
    ("gap", "k", "said"),
    [
        ("PGAP,5,0.,,1.+6,1.+2", (1e6, 0.0), "1 properties (PGAP) closed, 0 open"),
        ("PGAP,5,-.1,,1.+6,1.+2,3.+4", (1e6, 3e4), "1 properties (PGAP) closed"),
        ("PGAP,5,0.,,1.+6,,,.2", (1e6, 2e5), "1 properties (PGAP) closed"),
        ("PGAP,5,.1,,1.+6,1.+2,3.+4", (1e2, 0.0), "0 properties (PGAP) closed, 1 open"),
        ("PGAP,5,.1,,1.+6", (1e-8, 0.0), "0 properties (PGAP) closed, 1 open"),
    ],
)
def test_a_gap_is_a_spring_along_the_line_of_its_grids(model, gap, k, said):
    found = model(GRIDS + MASS + f"CGAP,7,5,1,2,0.,0.,1.\n{gap}\n")
    np.testing.assert_allclose(found.K().toarray(), pair(k, (0.6, 0.8, 0.0)), atol=1e-9 * k[0])
    assert any(said in w for w in found.warnings)


def test_a_gap_between_grids_in_one_place_needs_a_system(model):
    system = "CORD2R,9,,0.,0.,0.,1.,0.,0.\n,0.,1.,0.\n"  # z along x, x along y
    found = model(GRIDS + MASS + system + "CGAP,7,5,2,3,,,,9\nPGAP,5,,,1.+6\n")
    expected = np.zeros((9, 9))
    expected[np.ix_([4, 7], [4, 7])] = 1e6 * np.array([[1.0, -1.0], [-1.0, 1.0]])
    np.testing.assert_allclose(found.K().toarray(), expected, atol=1e-6)
    with pytest.raises(InputError, match=r"CGAP 7 .*needs CID"):
        model(GRIDS + MASS + "CGAP,7,5,2,3,0.,0.,1.\nPGAP,5,,,1.+6\n")


K3 = np.array([[4.0, -1.0, 0.5], [-1.0, 3.0, 0.25], [0.5, 0.25, 2.0]])
UI = "GENEL,7,,1,1,2,2,3,3\n"


def lower(matrix, word):
    values = [f"{v!r}" for k in range(len(matrix)) for v in matrix[k:, k].tolist()]
    lines = [values[:7], *(values[k : k + 8] for k in range(7, len(values), 8))]
    return f",{word}," + "\n,".join(",".join(line) for line in lines) + "\n"


@pytest.mark.parametrize("word", ["K", "Z"])
def test_stiffness_or_flexibility_between_components(model, word):
    card = UI + lower(K3 if word == "K" else np.linalg.inv(K3), word)
    found = model(GRIDS + MASS + card).K().toarray()[np.ix_([0, 4, 8], [0, 4, 8])]
    np.testing.assert_allclose(found, K3, rtol=1e-12)


def test_motions_of_the_support_are_taken_off(model):
    """f = K (u - S ud), and what holds the element bears S^T f."""
    S = np.array([[1.0, 0.5], [2.0, 0.0], [0.0, -1.0]])
    rows = ",".join(f"{v}" for v in S.ravel())
    card = UI + ",UD,,2,1,2,3\n" + lower(K3, "K") + f",S,{rows}\n"
    found = model(GRIDS + MASS + card).K().toarray()
    at = [0, 4, 8, 3, 5]
    B = np.hstack([np.eye(3), -S])
    np.testing.assert_allclose(found[np.ix_(at, at)], B.T @ K3 @ B, rtol=1e-12)


def test_without_S_the_support_is_that_of_a_rigid_body(model):
    """A beam's tip by its flexibility, held by the six of its foot: rigid motions cost nothing."""
    grids = "GRID,1,,0.,0.,0.\nGRID,2,,3.,4.,2.,9\nCORD2R,9,,0.,0.,0.,1.,0.,0.\n,0.,1.,0.\n"
    Z = np.diag([1e-3, 2e-3, 3e-3, 1e-4, 2e-4, 3e-4]) + 1e-5
    card = "GENEL,7,,2,1,2,2,2,3\n,2,4,2,5,2,6\n,UD,,1,1,1,2,1,3\n,1,4,1,5,1,6\n" + lower(Z, "Z")
    found = model(grids + "CONM2,91,1,,1.\nCONM2,92,2,,1.\n" + card)
    K = found.K().toarray()
    np.testing.assert_allclose(K[6:, 6:], np.linalg.inv(Z), rtol=1e-9)
    arm = found.geometry.xyz[1] - found.geometry.xyz[0]
    R = np.zeros((12, 6))
    R[:3, :3] = R[3:6, 3:] = np.eye(3)
    R[6:9, :3] = R[9:, 3:] = np.eye(3)
    R[6:9, 3:] = -np.array([[0, -arm[2], arm[1]], [arm[2], 0, -arm[0]], [-arm[1], arm[0], 0]])
    R = found.expansion.T @ R  # grid 2 has a displacement system of its own
    assert np.abs(K @ R).max() < 1e-9 * K.max()


@pytest.mark.parametrize(
    ("card", "message"),
    [
        (UI, "K or Z"),
        (UI + ",K,1.,2.,3.,4.,5.,6.,7.\n", "7 numbers where 6 fit"),
        (UI + ",Z,1.,1.,1.,1.,1.,1.\n", "singular"),
        (UI + ",UD,,2,1\n" + lower(K3, "K"), "six components"),
        ("GENEL,7,,1,1,88,2\n,K,1.,0.,1.\n", "grid 88, which does not exist"),
    ],
)
def test_what_a_general_element_lacks_is_named(model, card, message):
    with pytest.raises(InputError, match=rf"GENEL 7.*{message}"):
        model(GRIDS + MASS + card)
