"""Rigid plates, joints and splines beside what they are, each on springs."""

import numpy as np
import pytest

from trueup.core.eigen.normal_modes import solve

GRIDS = "GRID,1,,0.,0.,0.\nGRID,2,,2.,0.,0.\nGRID,3,,0.,1.5,0.3\n"
GRIDS += "".join(
    f"CBUSH,{k},1,{k},,,,,0\nCONM2,{k + 10},{k},,2.5\n,.1,,.2,,,.3\n" for k in (1, 2, 3)
)
GRIDS += "PBUSH,1,K,5.,6.,7.,2.,3.,4.\n"


@pytest.mark.parametrize(
    ("card", "same"),
    [
        ("RTRPLT,9,1,2,3,123456", "RBE2,9,1,123456,2,3"),
        (
            "RTRPLT,9,1,2,3,123,23,3,456\n,1456,12456",
            "RBE1,9,1,123,2,23,3,3\n,UM,1,456,2,1456,3,12456",
        ),
        ("RTRPLT1,9,1,2,3", "RBE2,9,1,123456,2,3"),
        ("RTRPLT1,9,1,2,3,123,3", "RBE2,9,1,123,2\nRBE2,8,1,3,3"),
        ("RJOINT,9,1,2,12345", "RBE2,9,1,12345,2"),
    ],
)  # fmt: skip
def test_rigid_plates_and_joints_are_rigid_bodies(model, card, same):
    found, expected = (solve(model(GRIDS + text), 8).eigenvalues for text in (card, same))
    np.testing.assert_allclose(found, expected, rtol=1e-9)


def test_a_straight_spline_bends_as_a_cubic(model):
    """Of a beam that ends move and turn: Hermite's polynomials; stretch and twist are linear."""
    grids = "".join(
        f"GRID,{k},,{x},{0.5 * x},0.\n" for k, x in ((1, 0.0), (2, 1.0), (3, 3.0), (4, 4.0))
    )
    ends = "".join(f"CBUSH,{k},1,{k},,,,,0\nCONM2,{k + 10},{k},,2.5\n" for k in (1, 4))
    ends += "PBUSH,1,K,5.,6.,7.,2.,3.,4.\n"
    spline = model(grids + ends + "RSPLINE,9,.2,1,2,123456,3,123456,4\n")
    assert spline.n_free == 12
    T = spline.expansion.toarray()
    rows = {
        (n, c): k
        for k, (n, c) in enumerate(zip(spline.dofs.node, spline.dofs.component, strict=True))
    }
    at = [rows[2, c] for c in range(1, 7)]
    length, s = 4.0 * np.sqrt(1.25), 0.25
    along = np.array([2.0, 1.0, 0.0]) / np.sqrt(5.0)
    moved = dict(zip(spline.free_labels, T[at].T, strict=True))
    cubic, slope = 3 * s**2 - 2 * s**3, (6 * s - 6 * s**2) / length
    np.testing.assert_allclose(moved["4:3"][2], cubic, atol=1e-12)
    across = np.array([-along[1], along[0], 0.0])
    np.testing.assert_allclose(moved["4:3"][3:], -slope * across, atol=1e-12)
    axial = sum(along[k] * moved[f"4:{k + 1}"][:3] for k in range(2))
    np.testing.assert_allclose(axial, s * along, atol=1e-12)
    twist = sum(along[k] * moved[f"4:{k + 4}"] for k in range(2))
    np.testing.assert_allclose(twist, [*np.zeros(3), *(s * along)], atol=1e-12)


@pytest.mark.parametrize("card", ["RSPLINE,9,.1,1,2,123,3", "RSPLINE,9,.1,1,2,123456,3,123456"])
def test_splines_that_are_not_read_say_so(model, card):
    with pytest.raises(Exception, match=r"RSPLINE 9 .*: (a grid must follow|its first and last)"):
        model(GRIDS + card)
