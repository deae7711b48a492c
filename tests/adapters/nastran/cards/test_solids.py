"""Solids as decks give them: either way round, properties that are known and not supported."""

import numpy as np
import pytest

from trueup.adapters.nastran import build_model, read_deck
from trueup.core.errors import InputError

GRIDS = "".join(
    f"GRID,{8 * z + n},,{x},{y},{float(z)}\n"
    for z in (0, 1)
    for n, x, y in ((1, 0.0, 0.0), (2, 1.2, 0.1), (3, 1.4, 0.9), (4, 0.2, 0.7))
)
RINGS = ((1, 2), (2, 3), (3, 4), (4, 1)), ((1, 9), (2, 10), (3, 11), (4, 12))
RINGS += (((9, 10), (10, 11), (11, 12), (12, 9)),)
MIDDLE = {(a, b): 100 * a + b for ring in RINGS for a, b in ring}
MATERIAL = "MAT1,1,7.E4,,.3,2.7-9\n"
PROPERTY = "PSOLID,1,1\n"


@pytest.fixture
def solve(tmp_path):
    def matrices(elements, grids=GRIDS, properties=PROPERTY + MATERIAL):
        path = tmp_path / "solid.bdf"
        path.write_text("BEGIN BULK\n" + grids + elements + properties + "ENDDATA\n")
        model = build_model(read_deck(path))
        return model.K().toarray(), model.M().toarray(), model.warnings

    return matrices


@pytest.mark.parametrize(
    ("right", "turned"),
    [
        ("CHEXA,7,1,1,2,3,4,9,10\n,11,12\n", "CHEXA,7,1,9,10,11,12,1,2\n,3,4\n"),
        ("CHEXA,7,1,1,2,3,4,9,10\n,11,12\n", "CHEXA,7,1,1,4,3,2,9,12\n,11,10\n"),
        ("CPENTA,7,1,1,2,3,9,10,11\n", "CPENTA,7,1,9,10,11,1,2,3\n"),
        ("CPENTA,7,1,1,2,3,9,10,11\n", "CPENTA,7,1,1,3,2,9,11,10\n"),
    ],
)
def test_either_way_round_is_the_same_solid(solve, right, turned):
    """Nastran asks for consecutive grids about a face, not for a sense of rotation."""
    K, M, quiet = solve(right)
    K2, M2, said = solve(turned)
    np.testing.assert_allclose(K2, K, atol=1e-12 * K.max())
    np.testing.assert_allclose(M2, M, rtol=1e-12)
    assert not any("other way round" in w for w in quiet)
    assert any("7" in w and "taken the other way round" in w for w in said)


def test_middle_nodes_turn_with_their_faces(solve):
    at = {int(line.split(",")[1]): np.array(line.split(",")[3:], float)
          for line in GRIDS.splitlines()}  # fmt: skip
    grids = GRIDS + "".join(
        f"GRID,{n},," + ",".join(f"{v:.4f}" for v in (at[a] + at[b]) / 2 + 0.01) + "\n"
        for (a, b), n in MIDDLE.items()
    )
    low, up, top = ([*MIDDLE.values()][k : k + 4] for k in (0, 4, 8))

    def card(*nodes):
        texts = [str(n) for n in nodes]
        lines = [texts[:6], texts[6:14], texts[14:]]
        return "CHEXA,7,1," + "\n,".join(",".join(line) for line in lines) + "\n"

    K, *_ = solve(card(1, 2, 3, 4, 9, 10, 11, 12, *low, *up, *top), grids)
    K2, *_ = solve(card(9, 10, 11, 12, 1, 2, 3, 4, *top, *up, *low), grids)
    np.testing.assert_allclose(K2, K, atol=1e-12 * K.max())


def test_a_solid_that_is_none_either_way_is_refused(solve):
    with pytest.raises(InputError, match=r"CHEXA 7 .* is flat or turned inside out"):
        solve("CHEXA,7,1,1,3,2,4,9,11\n,10,12\n")


def test_properties_that_are_not_supported_are_named(solve):
    with pytest.raises(InputError, match=r"PLSOLID 1 \(.*line 11\): .*not supported: give CPENTA"):
        solve("CPENTA,7,1,1,2,3,9,10,11\n", properties="PLSOLID,1,1\n" + MATERIAL)


ORTHOTROPIC = "MAT11,1,9.E4,4.E4,2.E4,.3,.25,.2,1.E4\n,8.E3,6.E3,2.7-9\n"
BRICK = "CHEXA,7,1,1,2,3,4,9,10\n,11,12\n"


def test_orthotropic_material_that_is_the_same_in_all_directions_is_isotropic(solve):
    G = 7e4 / 2.6
    same = f"MAT11,1,7.E4,7.E4,7.E4,.3,.3,.3,{G:.10g}\n,{G:.10g},{G:.10g},2.7-9\n"
    K, M, _ = solve(BRICK, properties=PROPERTY + same)
    expected, mass, _ = solve(BRICK)
    np.testing.assert_allclose(K, expected, atol=1e-9 * expected.max())
    np.testing.assert_allclose(M, mass)


def test_plies_of_a_solid_laminate_lie_as_psdir_and_theta_say(solve):
    """Plies along y turned by 30 degrees about z, which the stack follows: x at 120 degrees."""
    plies = "PCOMPS,1,0,23\n,1,1,.5,30.,,,YES,ABS\n,2,1,.5,30.,,,YES,ABS\n"
    K, M, said = solve(BRICK, properties=plies + ORTHOTROPIC)
    c, s = np.cos(np.pi / 1.5), np.sin(np.pi / 1.5)
    turned = f"PSOLID,1,1,5\nCORD2R,5,,0.,0.,0.,0.,0.,1.\n,{c:.9f},{s:.9f},0.\n"
    expected, mass, _ = solve(BRICK, properties=turned + ORTHOTROPIC)
    np.testing.assert_allclose(K, expected, atol=1e-7 * expected.max())
    np.testing.assert_allclose(M, mass)
    assert any("PCOMPS 1" in w and "is not known" in w for w in said)


@pytest.mark.parametrize(("coupling", "possible"), [(6.9999e4, True), (7.5e4, False)])
def test_a_mat9_that_gives_energy_back_is_refused(solve, coupling, possible):
    stiff = ",,,,7.E4\n,0.,,,,7.E4,,,\n,2.E4,,,2.E4,,2.E4,2.7-9\n"
    properties = PROPERTY + f"MAT9,1,7.E4,{coupling!r},0." + stiff
    if possible:
        solve(BRICK, properties=properties)
        return
    with pytest.raises(InputError, match=r"MAT9 1 \(.*G11 to G66 are those of no material"):
        solve(BRICK, properties=properties)


def test_orthotropic_material_that_cannot_be_is_refused(solve):
    with pytest.raises(InputError, match=r"MAT11 1 .*NU12, NU13 and NU23 are not possible"):
        solve(BRICK, properties=PROPERTY + ORTHOTROPIC.replace(",.3,", ",2.,"))


def test_element_axes_are_the_basic_ones_of_a_pyramid_and_not_known_of_others(solve):
    stiff = "MAT9,1,9.E4,2.E4,2.E4,,,,5.E4\n,2.E4,,,,6.E4,,,\n,2.E4,,,1.E4,,3.E4\n"
    own, basic = (
        solve("CPYRAM,7,1,1,2,3,4,9\n", properties=f"PSOLID,1,1,{cordm}\n{stiff}")[0]
        for cordm in (-1, 0)
    )
    np.testing.assert_array_equal(own, basic)
    with pytest.raises(InputError, match="CORDM = -1"):
        solve("CTETRA,7,1,1,2,3,9\n", properties=f"PSOLID,1,1,-1\n{stiff}")
