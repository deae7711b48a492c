"""Assembly against closed forms, invariants, and MSC and NX Nastran."""

import re

import numpy as np
import pytest

from trueup.adapters.nastran import build_model, read_deck, weight
from trueup.core.eigen.normal_modes import solve
from trueup.core.errors import InputError

# Elastic frequencies [Hz] that the decks' own Nastran runs gave, and the tolerance asked for.
NASTRAN = {
    "truss_72/modes.dat": [
        25.4556972, 25.4556972, 38.9408873, 68.5553469, 73.7051961, 73.7051961, 111.0226695,
        127.6246758, 136.6591031, 136.6591031,
    ],
    "ten_bar/modes.dat": [8.9495006, 26.956565, 27.2502208, 49.9307098],
    "cantilever/noReduction.dat": [349.7287883, 2167.3241495, 6007.8033593],
    "plate/plate_py.dat": [6333.012, 7495.461, 16238.46, 17161.51],
    "mast/pn_mwe_s-solution_1.dat": [89.56075, 89.56075, 1044.7596],
    "space_truss/full.dat": [
        1.69880, 1.76749, 1.85772, 3.41961, 7.02421, 7.02541, 10.7236, 10.9825, 13.8668, 14.3899,
    ],
}  # fmt: skip


@pytest.mark.parametrize(("deck", "expected"), NASTRAN.items(), ids=NASTRAN)
def test_frequencies_are_nastrans(data, frequencies, deck, expected):
    model = build_model(read_deck(data / "nastran" / deck))
    found = frequencies(model)
    elastic = found[found > 0.01 * expected[0]][: len(expected)]
    np.testing.assert_allclose(elastic, expected, rtol=1e-4)


def _weighed(f06):
    """Mass and centre of gravity of the grid point weight generator's table, 7 digits."""
    text = f06.read_text(errors="replace")
    table = text[text.index("MASS AXIS SYSTEM (S)") :].splitlines()[1:4]
    rows = [[float(x) for x in re.findall(r"[-+]?\d\.\d+E[-+]\d+", line)] for line in table]
    x, y, _ = rows
    return x[0], np.array([y[1], x[2], x[3]])


@pytest.mark.parametrize(
    ("deck", "f06"), [("truss_72/modes.dat", "modes.f06"), ("ten_bar/modes.dat", "modes.f06")]
)
def test_weight_is_that_of_the_grid_point_weight_generator(data, deck, f06):
    path = data / "nastran" / deck
    found = weight(read_deck(path))
    mass, centre = _weighed(path.parent / f06)
    assert found.mass == pytest.approx(mass, rel=1e-6)
    np.testing.assert_allclose(found.centre_of_gravity, centre, rtol=1e-6, atol=1e-9)


class TestClosedForms:
    def test_mass_on_a_spring(self, model, frequencies):
        found = model(
            "GRID,1,,0.,0.,0.,,23456\nCELAS2,1,900.,1,1\nCMASS2,2,4.,1,1\nPARAM,WTMASS,0.25"
        )
        np.testing.assert_allclose(frequencies(found), [np.sqrt(900.0 / 1.0) / (2 * np.pi)])

    def test_two_masses_on_scalar_points(self, model, frequencies):
        found = model("SPOINT,1,2\nCELAS4,1,5.,1,2\nCMASS4,2,2.,1\nCMASS4,3,2.,2")
        np.testing.assert_allclose(frequencies(found), [0.0, np.sqrt(5.0) / (2 * np.pi)], atol=1e-4)

    @pytest.mark.parametrize("skew", [False, True])
    def test_pinned_bar_bends_as_euler_says(self, model, frequencies, skew):
        n, L, EI, m = 24, 3.0, 7.0, 2.0
        axis = np.array([0.6, 0.48, 0.64]) if skew else np.array([1.0, 0.0, 0.0])
        side = np.array([-0.8, 0.36, 0.48]) if skew else np.array([0.0, 1.0, 0.0])
        grids = "\n".join(
            f"GRID,{k + 1},2,0.,0.,{k * L / n!r},2,{'12346' if k in (0, n) else '2346'}"
            for k in range(n + 1)
        )
        A, B, C = np.zeros(3), axis, axis + side
        system = "CORD2R,2,0," + ",".join(f"{x:.10f}" for x in (*A, *B)) + "\n,"
        system += ",".join(f"{x:.10f}" for x in C)
        bars = "\n".join(f"CBAR,{k + 1},1,{k + 1},{k + 2},1.,0.,0." for k in range(n))
        found = model(
            f"{system}\n{grids}\n{bars}\nPBAR,1,1,1.,0.5,{EI},1.\nMAT1,1,1.,,.3,{m}\n"
            "PARAM,COUPMASS,1\nSPC1,4,2,1,THRU,40",
            case="SPC = 4",
        )
        exact = (np.arange(1, 4) * np.pi / L) ** 2 * np.sqrt(0.5 / m) / (2 * np.pi)
        np.testing.assert_allclose(frequencies(found)[:3], exact, rtol=2e-4)

    def test_offset_mass_turns_with_its_arm(self, model, frequencies):
        found = model("GRID,1,,0.,0.,0.,,12345\nCELAS2,1,12.,1,6\nCONM2,2,1,,3.,2.,0.,0.\n,,,,,,1.")
        np.testing.assert_allclose(frequencies(found), [np.sqrt(12.0 / 13.0) / (2 * np.pi)])


STRUCTURE = """\
CORD2C,5,0,0.,0.,0.,0.3,0.4,1.
,1.,0.2,0.
GRID,1,,0.,0.,0.
GRID,2,,30.,0.,2.,5
GRID,3,,31.,25.,0.,5
GRID,4,,0.,20.,1.
GRID,5,,60.,0.,0.,5
GRID,6,,60.,10.,30.
GRID,7,,30.,10.,40.,5
CQUAD4,1,1,1,2,3,4
CTRIA3,2,1,2,5,3
CBAR,3,2,1,5,0.,0.,1.,GOO
,,4,0.,1.,2.,0.,-1.,1.
CROD,5,4,1,3
CONROD,9,2,4,1,7.,11.
CONM2,8,6,5,2.5-6,0.,1.,3.
,1.-4,,2.-4,,,3.-4
RBE2,20,5,123456,6,7
PSHELL,1,1,2.,1,1.1,1,0.8,2.-10
PBAR,2,1,40.,500.,300.,600.
,,,,,,,,
,0.6,0.7
PROD,4,1,20.,30.,,1.-9
MAT1,1,7.+4,,.3,2.7-9
"""


class TestInvariants:
    def test_a_free_structure_resists_no_rigid_motion(self, model):
        found = model(STRUCTURE)
        K = found.K().toarray()
        values = np.linalg.eigvalsh(K / np.sqrt(np.outer(K.diagonal(), K.diagonal())))
        assert np.sum(np.abs(values) < 1e-10) == 6
        rigid = np.zeros((len(found.dofs), 6))
        for k in range(7):
            rigid[6 * k : 6 * k + 6] = np.eye(6)
            x, y, z = found.geometry.xyz[k]
            rigid[6 * k : 6 * k + 3, 3:] = [[0, z, -y], [-z, 0, x], [y, -x, 0]]
        q = np.linalg.lstsq(found.expansion.toarray(), rigid, rcond=None)[0]
        np.testing.assert_allclose(found.expansion @ q, rigid, atol=1e-9)
        assert np.abs(K @ q).max() < 1e-10 * np.abs(K).max() * np.abs(q).max()

    def test_displacement_systems_change_nothing(self, model, frequencies):
        plain = STRUCTURE.replace(",5\n", "\n").replace("CONM2,8,6,,", "CONM2,8,6,5,")
        assert plain.count(",5\n") == 0
        np.testing.assert_allclose(
            frequencies(model(STRUCTURE))[6:12], frequencies(model(plain))[6:12], rtol=1e-7
        )

    @pytest.mark.parametrize("vector", ["4.,-2.,1.5", "1.9,4.,-2."])
    def test_massless_rotations_in_an_oblique_system_are_massless(self, model, vector):
        bars = "".join(f"GRID,{k},,{k}.,0.,0.\n" for k in range(1, 9))
        bars += "".join(f"CBEAM,{k},1,{k},{k + 1},0.,1.,0.\n" for k in range(1, 8))
        bars += "PBEAM,1,1,.1,.003,.002,,.001\nMAT1,1,2.1+5,,.3,7.85-9\n"
        oblique = f"GRDSET,,7,,,,7\nCORD2R,7,,3.,-2.,1.,3.5,-1.2,1.9\n,{vector}\n"
        plain, turned = solve(model(bars), 12), solve(model(bars + oblique), 12)
        np.testing.assert_allclose(turned.eigenvalues[6:], plain.eigenvalues[6:], rtol=1e-8)

    def test_mass_is_that_of_the_cards(self, deck):
        found = weight(deck(STRUCTURE.replace("\nMAT1", "\nPARAM,GRDPNT,5\nMAT1")))
        np.testing.assert_allclose(found.masses, found.mass, rtol=1e-12)
        np.testing.assert_allclose(found.reference, [60.0, 0.0, 0.0])
        moved = weight(deck(STRUCTURE))
        np.testing.assert_allclose(found.centre_of_gravity, moved.centre_of_gravity, rtol=1e-10)
        np.testing.assert_allclose(found.matrix, found.matrix.T, atol=1e-12)

    def test_systems_by_grids_and_chains_of_systems(self, model):
        other = (
            "CORD2S,7,5,1.,20.,3.,4.,40.,7.\n,9.,80.,2.\nGRID,90,7,2.,30.,40.\nCONM2,91,90,,1.\n"
        )
        other += "CELAS2,92,1.,90,1,6,1\nCORD1R,8,1,5,7\nGRID,93,8,1.,2.,3.\nCONROD,94,93,90,1,1.\n"
        found = model(STRUCTURE + other)
        z = np.array([1.0, 0.0, 0.0])  # from grid 1 to grid 5
        y = np.cross(z, [30.0, 10.0, 40.0])
        y /= np.linalg.norm(y)
        expected = 1.0 * np.cross(y, z) + 2.0 * y + 3.0 * z
        np.testing.assert_allclose(found.geometry.xyz[-1], expected, atol=1e-12)


class TestDrawing:
    def test_elements_are_handed_on_with_their_grids(self, model):
        geometry = model(STRUCTURE).geometry
        assert set(geometry.elements) == {"quad", "tria", "line", "point"}
        ids = geometry.ids[geometry.elements["quad"][0]]
        assert ids.tolist() == [1, 2, 3, 4]
        assert geometry.element_ids["line"].tolist() == [3, 5, 9]


class TestSingularities:
    def test_what_has_no_stiffness_is_fixed_and_named(self, model):
        found = model("GRID,1,,0.,0.,0.,,123456\nGRID,2,,1.\n" + "CROD,1,1,1,2\nPROD,1,1,1.\n"
                      "MAT1,1,1.,,.3,1.")  # fmt: skip
        assert found.free_labels == ("2:1",)
        assert "component 2 of 1 grids (2)" in found.warnings[-1]

    def test_a_skew_rod_leaves_its_one_stiff_direction(self, model):
        found = model(
            "GRID,1,,0.,0.,0.,,123456\nGRID,2,,1.,2.,2.\nCROD,1,1,1,2\nPROD,1,1,9.\nMAT1,1,1.,,.3,1."
        )
        assert found.n_free == 1
        assert found.K()[0, 0] > 0.0

    def test_without_autospc_what_moves_freely_with_mass_stays(self, model):
        found = model(
            "GRID,1,,0.,0.,0.,,123456\nGRID,2,,1.\nCROD,1,1,1,2\nPROD,1,1,1.\nMAT1,1,1.,,.3,1.\n"
            "PARAM,AUTOSPC,NO"
        )
        assert found.free_labels == ("2:1", "2:2", "2:3")


BAD = [
    ("CROD,5,4,1,33", "", r"CROD 5 \(.*deck.bdf line 18\) refers to grid 33, which does not exist"),
    ("PROD,4,9,20.", "", r"PROD 4 \(.*deck.bdf line \d+\) refers to material 9, but there is no"),
    ("CROD,5,44,1,3", "", r"CROD 5 .* refers to property 44, but there is no PROD 44"),
    ("GRID,7,77,30.,10.,40.", "", r"GRID 7 .* refers to coordinate system 77, which does not"),
    ("CORD2C,5,5,0.,0.,0.,0.3,0.4,1.\n,1.,0.2,0.", "", r"CORD2C 5 .* is defined by itself"),
    ("CORD2C,5,0,0.,0.,0.,0.3,0.4,1.\n,.6,.8,2.", "", r"CORD2C 5 \(.*line 5\): .* in a line"),
    ("CQUAD4,1,1,1,2,4,3", "", r"CQUAD4 1 .* a corner turned inside out"),
    ("CTRIA3,2,1,2,2,3", "", r"CTRIA3 2 "),
    ("CBAR,3,2,1,5,1.,0.,0.", "", r"CBAR 3 .* orientation vector is zero or runs along"),
    ("RBE2,20,5,123456,6,7,5", "", r"RBE2 20 .* grid 5 is both the independent and a dependent"),
    ("RBE2,21,1,1,6", "", r"6:1 \(grid:component\) is made dependent by RBE2 20 .* and RBE2 21"),
    ("SPC1,4,3,6", "SPC = 4", r"6:3 .* is dependent in RBE2 20 .* and constrained by an SPC"),
    ("SPC1,4,3,66", "SPC = 4", r"SPC1 \(.*deck.bdf line \d+\) refers to grid 66"),
    ("PSHELL,1,1,0.", "", r"PSHELL 1 .*: the thickness T is 0"),
    ("GRID,1,,nan,0.,0.", "", r"GRID 1"),
]  # fmt: skip


@pytest.mark.parametrize(("card", "case", "message"), BAD, ids=[b[0] for b in BAD])
def test_bad_cards_are_named_with_file_and_line(model, card, case, message):
    name, number = card.split(",")[:2]
    lines, cards = STRUCTURE.splitlines(), []
    for line in lines:
        if line[0] == ",":
            cards[-1] += "\n" + line
        else:
            cards.append(line)
    kept = [c for c in cards if c.split(",")[:2] != [name, number]]
    order = [c if c in kept else card for c in cards]
    bulk = "\n".join(order if len(kept) < len(cards) else [*cards, card])
    with pytest.raises(InputError, match=message) as caught:
        model(bulk, case=case)
    assert "\n" not in str(caught.value)


def test_rigid_elements_in_a_circle_are_named(model):
    circle = (
        "GRID,1\nGRID,2,,1.\nGRID,3,,2.\nRBE2,1,1,123456,2\nRBE2,2,2,123456,3\nRBE2,3,3,123456,1"
    )
    with pytest.raises(InputError, match=r"RBE2 1 .*RBE2 2 .*RBE2 3 .*depend on each other"):
        model(f"{circle}\nCELAS2,4,1.,1,1")


def test_chains_of_rigid_elements_are_resolved(model, frequencies):
    grids = "".join(f"GRID,{k},,{k}.,0.,0.\n" for k in range(1, 5))
    chain = "RBE2,12,3,123456,4\nRBE2,11,2,123456,3\nRBE2,10,1,123456,2\n"
    found = model(f"{grids}{chain}CELAS2,4,5.,1,2\nCELAS2,5,7.,1,6\nCONM2,6,4,,2.")
    assert {label.split(":")[0] for label in found.free_labels} == {"1"}
    row = found.expansion.toarray()[18 + 1]  # y of grid 4
    by_label = dict(zip(found.free_labels, row, strict=True))
    assert by_label["1:2"] == pytest.approx(1.0)
    assert by_label["1:6"] == pytest.approx(3.0)
