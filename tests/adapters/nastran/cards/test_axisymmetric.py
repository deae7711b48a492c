"""Bodies of revolution against closed forms."""

from itertools import pairwise

import numpy as np
import pytest
from scipy.optimize import brentq
from scipy.special import j0, j1

from trueup.adapters.nastran import build_model, read_deck
from trueup.core.eigen.normal_modes import solve
from trueup.core.errors import InputError

SIDES = {3: ((0, 1), (1, 2), (2, 0)), 4: ((0, 1), (1, 2), (2, 3), (3, 0))}
CARDS = {"CTRIAX6": 3, "CTRAX3": 3, "CTRAX6": 3, "CQUADX4": 4, "CQUADX8": 4}
E, RHO = 2e11, 7800.0


def section(card, radii, heights, material, angle=""):
    """A mesh of radii times heights, cut into triangles where the card has three corners."""
    ids, grids, elements = {}, [], []

    def grid(x, z):
        key = (round(x, 9), round(z, 9))
        if key not in ids:
            ids[key] = len(ids) + 1
            grids.append(f"GRID,{ids[key]},,{x:.9f},0.,{z:.9f}")
        return ids[key]

    for a, b in pairwise(radii):
        for c, d in pairwise(heights):
            square = [(a, c), (b, c), (b, d), (a, d)]
            faces = [square] if CARDS[card] == 4 else [square[:3], [square[0], *square[2:]]]
            for face in faces:
                nodes = [grid(*p) for p in face]
                if card[-1] in "68":
                    middle = [
                        grid(*np.mean([face[i], face[j]], axis=0)) for i, j in SIDES[len(face)]
                    ]
                    both = zip(nodes, middle, strict=True)
                    nodes = [n for p in both for n in p] if card == "CTRIAX6" else [*nodes, *middle]
                fields = [card, sum(e[0] == "C" for e in elements) + 1, 1, *nodes, angle]
                elements.append(",".join(map(str, fields[:9])))
                elements += [",".join(map(str, ["", *fields[9:]]))] * (len(fields) > 9)
    return "\n".join([*grids, *elements, "PSOLID,1,1", material, ""])


@pytest.fixture
def frequencies(tmp_path):
    def found(bulk, n):
        path = tmp_path / "ring.bdf"
        path.write_text(f"SPC = 1\nBEGIN BULK\nPARAM,COUPMASS,1\n{bulk}ENDDATA\n")
        model = build_model(read_deck(path))
        assert any("moves alike all round" in w for w in model.warnings)
        return solve(model, n).frequencies_hz

    return found


def isotropic(nu):
    return f"MAT1,1,{E:.1E},,{nu},{RHO:.1f}"


@pytest.mark.parametrize("card", CARDS)
def test_rod_vibrates_along_its_axis(frequencies, card):
    """Without Poisson's ratio, sections stay plane: f = n c / 2 L, free ends.

    Linear elements are off by (k h)**2 / 24, quadratic ones by (k h)**4 / 1440.
    """
    found = frequencies(section(card, [0.0, 0.02], np.linspace(0, 1, 13), isotropic(0.0)), 4)
    expected = np.arange(1, 4) * np.sqrt(E / RHO) / 2.0
    assert found[0] < 1.0
    off = found[1:] / expected - 1.0
    phase = np.pi * np.arange(1, 4) / 12  # wave number times length of an element
    of_mesh = phase**4 / 1440 if card[-1] in "68" else phase**2 / 24
    assert (np.abs(off) < 1.05 * of_mesh + 1e-6).all()


@pytest.mark.parametrize("card", CARDS)
def test_disc_breathes(frequencies, card):
    """Held between two planes: x J0(x) = (1 - 2 nu) / (1 - nu) J1(x), x = omega R / c."""
    nu, radius = 0.3, 0.5
    c = np.sqrt(E * (1 - nu) / ((1 + nu) * (1 - 2 * nu)) / RHO)
    x = brentq(lambda x: x * j0(x) - (1 - 2 * nu) / (1 - nu) * j1(x), 1.0, 3.0)
    bulk = section(card, np.linspace(0, radius, 13), [0.0, 0.05], isotropic(nu))
    grids = [line.split(",")[1] for line in bulk.splitlines() if line.startswith("GRID")]
    found = frequencies(bulk + "".join(f"SPC1,1,3,{g}\n" for g in grids), 1)
    loose = 1e-5 if card[-1] in "68" else 0.01
    np.testing.assert_allclose(found, x * c / radius / (2 * np.pi), rtol=loose)


def test_orthotropic_ring(frequencies):
    """A thin ring turns inside out at E / 2 and breathes at E, the modulus around it."""
    mat = "MAT3,1,3.+10,2.+11,1.+10,.0,.0,.0,7800.\n,,,5.+9"
    found = frequencies(section("CTRIAX6", [0.999, 1.001], [0.0, 0.002], mat), 3)[1:]
    expected = np.sqrt(np.array([1e11, 2e11]) / RHO) / (2.0 * np.pi)
    np.testing.assert_allclose(found, expected, rtol=1e-5)


def test_turned_material(frequencies):
    """By 90 degrees, EX lies along the axis."""
    mat = "MAT3,1,3.+10,2.+11,1.+10,.0,.0,.0,7800.\n,,,5.+9"
    rod = section("CQUADX8", [0.0, 0.02], np.linspace(0, 1, 13), mat, 90.0)
    np.testing.assert_allclose(frequencies(rod, 2)[1], np.sqrt(3e10 / RHO) / 2.0, rtol=1e-4)


def test_mass_is_that_of_the_whole_ring(tmp_path):
    path = tmp_path / "ring.bdf"
    for coupled in ("", "PARAM,COUPMASS,1\n"):
        bulk = section("CTRIAX6", [0.3, 0.5], [0.0, 0.1], isotropic(0.3))
        path.write_text(f"SPC = 1\nBEGIN BULK\n{coupled}{bulk}ENDDATA\n")
        M = build_model(read_deck(path)).M()
        volume = np.pi * (0.5**2 - 0.3**2) * 0.1
        assert M.sum() == pytest.approx(2.0 * RHO * volume)


@pytest.mark.parametrize(
    ("old", "new"), [(",0.,", ",1.,"), ("GRID,1,,0.3", "GRID,1,,-.3")], ids=["off", "beyond"]
)
def test_a_section_that_is_not_in_its_plane_is_refused(frequencies, old, new):
    bulk = section("CTRIAX6", [0.3, 0.5], [0.0, 0.1], isotropic(0.3)).replace(old, new, 1)
    with pytest.raises(InputError, match=r"CTRIAX6 1 .* x-z plane"):
        frequencies(bulk, 1)
