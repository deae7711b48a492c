"""PCOMPS of several plies against uniform strains, laminate theory, the brick of one material."""

import numpy as np
import pytest

from trueup.adapters.nastran import build_model, read_deck
from trueup.core.errors import InputError

E, SOFT = 2.0e5, 4.0e4
BOX = np.array([[0, 0, 0], [7, 0, 0], [7, 5, 0], [0, 5, 0]], float)
BOX = np.concatenate([BOX, BOX + np.array([0.0, 0.0, 3.0])])
ORDERS = {
    "z": (0, 1, 2, 3, 4, 5, 6, 7),
    "-z": (4, 7, 6, 5, 0, 3, 2, 1),
    "x": (0, 4, 5, 1, 3, 7, 6, 2),
    "y": (0, 3, 7, 4, 1, 2, 6, 5),
}
"""Ways to number the same box; the stack then runs along another natural axis."""


def materials(nu):
    return f"MAT1,1,{E},,{nu},4.-9\nMAT1,2,{SOFT},,{nu},2.-9\n"


PLIES = "PCOMPS,7\n,1,1,1.\n,2,2,.5\n,3,1,1.5\n"
SHARE = np.array([1.0, 0.5, 1.5]) / 3.0


@pytest.fixture
def model(tmp_path):
    def of(text):
        (tmp_path / "a.bdf").write_text("BEGIN BULK\nPARAM,AUTOSPC,NO\n" + text + "ENDDATA\n")
        return build_model(read_deck(tmp_path / "a.bdf"))

    return of


def grids(xyz):
    return "".join(f"GRID,{k},,{x},{y},{z}\n" for k, (x, y, z) in enumerate(xyz.tolist(), 1))


def box(order="z"):
    nodes = [k + 1 for k in ORDERS[order]]
    line = ",".join(map(str, nodes[:6])) + "\n," + ",".join(map(str, nodes[6:]))
    return grids(BOX) + f"CHEXA,1,7,{line}\n"


def strain_energy(K, strain):
    """Twice the energy by volume of a uniform strain xx, yy, zz, xy, yz, zx."""
    xx, yy, zz, xy, yz, zx = strain
    e = np.array([[xx, xy / 2, zx / 2], [xy / 2, yy, yz / 2], [zx / 2, yz / 2, zz]])
    u = (BOX @ e).ravel()
    return u @ K @ u / 105.0


@pytest.mark.parametrize("order", ORDERS)
def test_uniform_strains_meet_plies_side_by_side_and_in_series(model, order):
    K = model(box(order) + materials(0.0) + PLIES).K().toarray()
    beside = SHARE @ [E, SOFT, E]
    series = 1.0 / (SHARE @ [1.0 / E, 1.0 / SOFT, 1.0 / E])
    for k, expected in enumerate([beside, beside, series, beside / 2, series / 2, series / 2]):
        assert strain_energy(K, np.eye(6)[k]) == pytest.approx(expected, rel=1e-9), k


@pytest.mark.parametrize("order", ORDERS)
def test_rigid_motions_cost_nothing_and_nothing_else_does(model, order):
    K = model(box(order) + materials(0.3) + PLIES).K().toarray()
    values = np.linalg.eigvalsh(K)
    assert abs(values[:6]).max() < 1e-9 * values[-1]
    assert values[6] > 1e-4 * values[-1]


def test_the_order_of_plies_counts_from_the_bottom_however_grids_are_numbered(model):
    plies = PLIES.replace("3,1,1.5", "3,2,1.5")
    found = [model(box(o) + materials(0.3) + plies).K().toarray() for o in ORDERS]
    for K in found[1:]:
        np.testing.assert_allclose(K, found[0], atol=1e-9 * found[0].max())
    lower = plies.replace("1,1,1.", "1,2,1.5").replace("3,2,1.5", "3,1,1.")
    assert abs(model(box() + materials(0.3) + lower).K().toarray() - found[0]).max() > 1.0


def test_plies_of_one_material_are_the_brick_in_all_that_plates_do(model):
    """Stretching, bending and twisting; only the highest hourglass motions have another law."""
    same = "PCOMPS,7\n,1,1,1.,0.\n,2,1,.5,90.\n,3,1,1.5,0.\n"
    K = model(box() + materials(0.3) + same).K().toarray()
    brick = model(box() + materials(0.3) + "PSOLID,7,1\n").K().toarray()
    values = np.linalg.eigvalsh(K)[6:] / np.linalg.eigvalsh(brick)[6:]
    np.testing.assert_allclose(values, 1.0, atol=0.05)
    x, y, z = (BOX - BOX.mean(axis=0)).T
    bent = np.stack([x * z, -0.3 * y * z, -0.5 * x**2 + 0.15 * y**2], axis=1).ravel()
    assert bent @ K @ bent == pytest.approx(bent @ brick @ bent, rel=1e-3)


@pytest.mark.parametrize("kind", ["CHEXA", "CHEXA20", "CPENTA"])
def test_a_cantilever_bends_as_laminate_theory_has_it(model, kind):
    """Equal layers outside, soft inside: E I of the plies, at a slenderness of 1 to 40."""
    n, length, width, height = 12, 60.0, 3.0, 1.5
    xyz, cards = [], ""
    for i in range(n + 1):
        for z in (0.0, height):
            xyz += [(length * i / n, y, z) for y in (0.0, width)]
    for i in range(n):
        a, b = 4 * i + 1, 4 * i + 5
        brick = [a, b, b + 1, a + 1, a + 2, b + 2, b + 3, a + 3]
        if kind == "CPENTA":
            for k, (p, q, r) in enumerate(((0, 1, 2), (0, 2, 3))):
                nodes = [brick[m] for m in (p, q, r, p + 4, q + 4, r + 4)]
                cards += f"CPENTA,{10 * i + k + 1},7," + ",".join(map(str, nodes)) + "\n"
            continue
        more = []
        if kind == "CHEXA20":
            ends = [(j, (j + 1) % 4) for j in range(4)]
            ends += [(j, j + 4) for j in range(4)] + [(p + 4, q + 4) for p, q in ends]
            for p, q in ends:
                middle = tuple(np.mean([xyz[brick[p] - 1], xyz[brick[q] - 1]], axis=0).tolist())
                if middle not in xyz:
                    xyz.append(middle)
                more.append(xyz.index(middle) + 1)
        every = [i + 1, 7, *brick, *more]
        lines = [",".join(map(str, every[k : k + 8])) for k in range(0, len(every), 8)]
        cards += "CHEXA," + "\n,".join(lines) + "\n"
    held = ",".join(str(k + 1) for k, x in enumerate(xyz) if x[0] == 0.0)
    held = "".join(f"SPC1,1,123,{k}\n" for k in held.split(","))
    plies = "PCOMPS,7\n,1,1,.5\n,2,2,.5\n,3,1,.5\n"
    found = model("".join([grids(np.array(xyz)), cards, held, plies, materials(0.0)]))
    load = np.zeros((len(xyz), 3))
    tip = [k for k, x in enumerate(xyz) if x[0] == length and x[2] in (0.0, height)][:4]
    load[tip, 2] = 0.25
    free = [k for k, x in enumerate(xyz) if x[0] > 0.0]
    K = found.K().toarray().reshape(len(xyz), 3, len(xyz), 3)[free][:, :, free]
    f = load[free].ravel()
    moved = f @ np.linalg.solve(K.reshape(len(f), len(f)), f)
    EI = width * (E * (height**3 - 0.5**3) + SOFT * 0.5**3) / 12.0
    tolerance = 0.08 if kind == "CPENTA" else 0.01
    assert moved == pytest.approx(length**3 / (3.0 * EI), rel=tolerance)


def test_mass_is_that_of_the_plies(model):
    found = model(box() + materials(0.3) + PLIES)
    mass = found.M().toarray().sum() / 3.0
    assert mass == pytest.approx(105.0 * (SHARE @ [4e-9, 2e-9, 4e-9]))
    (said,) = (w for w in found.warnings if "laminates is not known" in w)
    assert "one stress across" in said


def test_elements_with_and_without_plies_stand_beside_each_other(model):
    """Two boxes apart: each has the matrix that it has alone."""
    other = BOX + np.array([20.0, 0.0, 0.0])
    shifted = "".join(f"GRID,{k},,{x},{y},{z}\n" for k, (x, y, z) in enumerate(other.tolist(), 11))
    text = box() + shifted + "CHEXA,2,8,11,12,13,14,15,16\n,17,18\nPSOLID,8,1\n"
    both = model(text + materials(0.3) + PLIES)
    plies = model(box() + materials(0.3) + PLIES)
    solid = model(box() + materials(0.3) + "PSOLID,7,1\n")
    K = both.K().toarray()
    np.testing.assert_allclose(K[:24, :24], plies.K().toarray(), atol=1e-9 * K.max())
    np.testing.assert_allclose(K[24:, 24:], solid.K().toarray(), atol=1e-9 * K.max())
    assert len([w for w in both.warnings if "PCOMPS" in w]) == 1


@pytest.mark.parametrize(
    ("text", "said"),
    [
        (box() + materials(0.3) + PLIES.replace(",.5\n", ",\n"), "every ply needs a positive"),
        (box() + materials(0.3) + PLIES.replace("PCOMPS,7", "PCOMPS,7,,11"), "PSDIR 11 is not"),
        (box() + materials(0.3) + "PCOMPS,7\n", "no plies"),
        (
            grids(BOX) + materials(0.3) + "CPENTA,1,7,1,2,3,5,6,7\n"
            + PLIES.replace("PCOMPS,7", "PCOMPS,7,,31"),
            r"CPENTA 1 .*the axis of a CPENTA",
        ),
        (grids(BOX) + materials(0.3) + "CTETRA,1,7,1,2,3,5\n" + PLIES, "CTETRA 1 .*cannot have"),
    ],
)  # fmt: skip
def test_what_is_wrong_is_said(model, text, said):
    with pytest.raises(InputError, match=said):
        model(text)
