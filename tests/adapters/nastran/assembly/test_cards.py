"""Cards in the forms decks in the wild have them, against closed forms and each other."""

from contextlib import nullcontext

import numpy as np
import pytest

from trueup.adapters.nastran import build_model, read_deck, weight
from trueup.adapters.nastran.properties.thermal import read_thermal
from trueup.core.errors import InputError

GRID = "GRID,1,,0.,0.,0.,,23456\n"
MASS = "CONM2,90,1,,2.\n"
SPRING = np.sqrt(900.0 / 2.0) / (2.0 * np.pi)


class TestGroundedAtEitherEnd:
    @pytest.mark.parametrize(
        "spring",
        [
            "CELAS1,1,2,,,1,1\nPELAS,2,900.",
            "CELAS1,1,2,0,0,1,1\nPELAS,2,900.",
            "CELAS1,1,2,1,1\nPELAS,2,900.",
            "CELAS2,1,900.,,,1,1",
            "CELAS2,1,900.,1,1",
        ],
    )
    def test_spring(self, model, frequencies, spring):
        np.testing.assert_allclose(frequencies(model(GRID + MASS + spring)), [SPRING])

    @pytest.mark.parametrize(
        "mass",
        [
            "CMASS1,1,2,,,1,1\nPMASS,2,2.",
            "CMASS1,1,2,1,1\nPMASS,2,2.",
            "CMASS2,1,2.,,,1,1",
        ],
    )
    def test_mass(self, model, frequencies, mass):
        np.testing.assert_allclose(frequencies(model(GRID + "CELAS2,9,900.,1,1\n" + mass)), SPRING)

    @pytest.mark.parametrize(
        "cards",
        [
            "CELAS3,1,2,,7\nPELAS,2,900.\nCMASS3,3,4,,7\nPMASS,4,2.",
            "CELAS4,1,900.,,7\nCMASS4,3,2.,,7",
            "CELAS4,1,900.,7\nCMASS4,3,2.,7\nCDAMP4,5,3.,,7",
        ],
    )
    def test_scalar_points(self, model, frequencies, cards):
        np.testing.assert_allclose(frequencies(model("SPOINT,7\n" + cards)), SPRING)


class TestSets:
    def test_a_set_that_does_not_exist_constrains_nothing_and_is_said(self, model):
        cards = "GRID,1\nGRID,2,,1.\nCBAR,1,1,1,2,0.,0.,1.\nPBAR,1,1,1.,1.,1.,1.\nMAT1,1,1.,,.3,1."
        found = model(cards, case="SPC = 5\nMPC = 6")
        assert found.n_free == 12
        for kind, number in (("SPC", 5), ("MPC", 6)):
            assert any(f"asks for {kind} = {number}, but" in w for w in found.warnings)

    def test_a_set_missing_in_an_spcadd_is_said(self, model):
        cards = "SPC1,1,123456,1\nSPCADD,3,1,2\nGRID,1\nGRID,2,,1.\nCROD,1,1,1,2\n"
        found = model(cards + "PROD,1,1,1.\nMAT1,1,1.,,.3,1.", case="SPC = 3")
        assert any("adds set 2, but the deck has no SPC cards" in w for w in found.warnings)

    def test_added_sets_stand_for_the_cards_of_their_own_number(self, model):
        points = "SPOINT,1,2,3\nCELAS4,4,1.,1,2\nCELAS4,5,1.,2,3\nCMASS4,6,1.,2\n"
        held = points + "SPC1,7,0,1\nSPC1,9,0,3\nMPC,7,1,,1.,2,,-1.\n"
        found = model(held + "SPCADD,9,7\n", case="SPC = 9")
        assert found.free_labels == model(held, case="SPC = 7").free_labels
        assert any("SPCADD 9 takes its place" in w for w in found.warnings)
        found = model(held + "MPC,8,3,,1.,2,,-1.\nMPCADD,7,8\n", case="MPC = 7")
        assert found.free_labels == ("1:0", "2:0")

    def test_a_range_of_dependent_grids(self, model):
        grids = "".join(f"GRID,{k},,{k}.,0.,0.\n" for k in range(1, 6))
        rest = "CELAS2,9,1.,1,1\nCONM2,8,3,,1.\n"
        by_range = model(f"{grids}RBE2,7,1,123456,2,THRU,5\n{rest}")
        listed = model(f"{grids}RBE2,7,1,123456,2,3,4,5\n{rest}")
        assert by_range.free_labels == listed.free_labels


class TestRigidBars:
    @pytest.mark.parametrize(
        "card",
        [
            "RBAR,7,1,2,123456,0,0,123456",
            "RBAR,7,1,2,123456",
            "RBAR,7,1,2",
            "RBAR,7,2,1,,123456",
            "RBAR1,7,1,2,123456",
            "RBAR1,7,1,2",
            "RBE1,7,1,123456\n,UM,2,123456",
        ],
    )
    def test_all_ways_to_write_one_are_an_rbe2(self, model, card):
        grids = "GRID,1,,0.,0.,0.\nGRID,2,,1.,2.,3.\nCELAS2,9,1.,1,1\nCONM2,8,2,,1.\n"
        one, other = model(grids + card), model(grids + "RBE2,7,1,123456,2")
        assert one.free_labels == other.free_labels
        np.testing.assert_allclose(one.expansion.toarray(), other.expansion.toarray(), atol=1e-13)


class TestWhatIsLeftOut:
    def test_heat_elements_are_in_the_decks_warnings(self, deck):
        found = deck(GRID + MASS + "CELAS2,1,900.,1,1\nCHBDYG,5,,AREA4\n")
        assert any("CHBDYG (1 card) is left out: it belongs to heat" in w for w in found.warnings)

    def test_mass_that_is_not_selected_is_said(self, model):
        rod = "GRID,1,,,,,,123456\nGRID,2,,1.\nCROD,1,1,1,2\nPROD,1,1,1.\nMAT1,1,1.,,.3,1.\n"
        nsm = "NSM1,4,PROD,2.,1\n"
        assert any("NSM1 cards are not used" in w for w in model(rod + nsm).warnings)
        found = model(rod + nsm, case="NSM = 4")
        assert not any("NSM" in w for w in found.warnings)
        added = model(f"{rod}NSM1,5,PROD,9.,1\nNSMADD,5,4\n{nsm}", case="NSM = 5")
        assert added.M().diagonal() == pytest.approx(found.M().diagonal())

    @pytest.mark.parametrize(
        ("element", "coupled", "said"),
        [("CSHEAR", False, False), ("CQUAD4", True, False), ("CQUADR", True, True)],
    )
    def test_coupled_mass_is_of_the_elements_that_have_it(self, model, element, coupled, said):
        grids = "GRID,1\nGRID,2,,1.\nGRID,3,,1.,1.\nGRID,4,,0.,1.\nMAT1,1,1.,,.3,1.\n"
        properties = "PSHELL,1,1,.1,1\n" if element != "CSHEAR" else "PSHEAR,1,1,.1\n"
        found = model(f"{grids}{element},1,1,1,2,3,4\n{properties}PARAM,COUPMASS,1\n")
        M = found.M().toarray()
        assert bool(np.any(M - np.diag(np.diag(M)))) is coupled
        assert any("MSC's guide" in w for w in found.warnings) is said

    @pytest.mark.parametrize("kind", ["PSHELL", "PCOMP", "PCOMPG"])
    @pytest.mark.parametrize("ids", ["ALL", "1,2", "1,THRU,9"])
    def test_mass_named_by_one_kind_of_shell_property_goes_to_all(self, model, kind, ids):
        grids = "GRID,1\nGRID,2,,1.\nGRID,3,,1.,1.\nGRID,4,,0.,1.\nMAT1,1,1.,,.3\n"
        shells = "CQUAD4,1,1,1,2,3,4\nCTRIA3,2,2,1,2,3\nPSHELL,1,1,.1\nPCOMP,2\n,1,.1\n"
        found = model(f"{grids}{shells}NSM1,4,{kind},2.,{ids}\n", case="NSM = 4")
        assert found.M().diagonal()[:3].sum() == pytest.approx(3 * (0.5 + 1.0 / 3.0))

    @pytest.mark.parametrize(
        "card",
        ["ASET,1,1", "BSET,1,1", "BNDFIX,1,1", "BNDFIX1,1,1", "CSET1,1,1", "BNDFREE1,1,1"],
    )
    def test_sets_of_the_boundary_are_read_under_all_their_names(self, model, card):
        rods = "GRID,1\nGRID,2,,1.\nGRID,3,,2.,,,,123456\nCELAS2,1,4.,1,1,2,1\n"
        found = model(rods + "CELAS2,2,4.,2,1,3,1\nCONM2,9,1,,1.\n" + card)
        assert found.free_labels == ("1:1",)
        assert found.K().toarray() == pytest.approx(2.0)

    def test_component_modes_need_to_be_asked_for(self, model):
        springs = GRID + MASS + "SPOINT,77\nCELAS2,1,900.,1,1\n"
        with pytest.raises(InputError, match="METHOD selects no EIGRL"):
            model(springs + "ASET,1,1\nQSET,77")
        with pytest.raises(InputError, match=r"77:0 .* is in ASET and in the q-set"):
            model(springs + "ASET,77\nQSET,77")


BAR = "GRID,1\nGRID,2,,1.\nCBAR,1,1,1,2,0.,0.,1.\nMAT1,1,2.6,,.3,1.\n"


def _shell(card, prop, tail=""):
    return (
        "GRID,1,,0.,0.,0.\nGRID,2,,2.,0.,0.\nGRID,3,,2.,1.,0.\nGRID,4,,0.,1.,0.\n"
        f"{card},1,1,1,2,3,4{tail}\n{prop}\nMAT1,1,7.,,.3,1.\n"
    )


def _max_change(one, other):
    return np.abs((one.K() - other.K()).toarray()).max() / np.abs(other.K().toarray()).max()


class TestProperties:
    def test_shear_factors_do_not_count_beside_a_product_of_inertia(self, model):
        pbar = "PBAR,1,1,1.,2.,3.,1.\n,,,,,,,,\n,{},{},{}\n"
        without = model(BAR + pbar.format("", "", 0.5))
        assert _max_change(model(BAR + pbar.format(0.1, 0.1, 0.5)), without) == 0.0
        assert _max_change(model(BAR + pbar.format(0.1, 0.1, "")), without) > 0.1

    def test_thickness_may_stand_on_the_elements_alone(self, model):
        own = ",,\n,,,0.3,0.3,0.3,0.3"
        by_element = model(_shell("CQUAD4", "PSHELL,1,1,,1,,1", own))
        by_property = model(_shell("CQUAD4", "PSHELL,1,1,.3,1,,1"))
        assert _max_change(by_element, by_property) < 1e-12

    def test_a_shell_without_membrane_bends_only(self, model):
        found = model(_shell("CQUAD4", "PSHELL,1,,.3,1,,1,.3"))
        assert {label.split(":")[1] for label in found.free_labels} == {"3", "4", "5"}

    def test_plane_strain(self, model):
        found = model(_shell("CQUAD4", "PSHELL,1,1,.3,-1"), case="")
        plain = model(_shell("CQUAD4", "PSHELL,1,1,.3").replace("7.,,.3", f"{7 / 0.91},,{3 / 7}"))
        assert _max_change(found, plain) < 1e-4


class TestShapes:
    grids = "GRID,1,,0.,0.,0.\nGRID,2,,2.,0.,0.\nGRID,3,,2.,2.,0.\nGRID,4,,0.,2.,{}\n"
    rest = "CQUAD4,7,1,1,2,3,4\nPSHELL,1,1,.1,1,,1\nMAT1,1,7.,,.3,1.\n"

    def test_a_warped_quad_is_said(self, model):
        found = model(self.grids.format(1.5) + self.rest)
        assert any("CQUAD4 7 (" in w and "is warped" in w for w in found.warnings)

    def test_a_nearly_flat_one_is_not(self, model):
        assert not any("warped" in w for w in model(self.grids.format(0.2) + self.rest).warnings)


class TestIntegration:
    corners = "GRID,1\nGRID,2,,1.\nGRID,3,,1.,1.\nGRID,4,,,1.\nGRID,5,,,,1.\nGRID,6,,1.,,1.\n"
    brick = (
        corners
        + "GRID,7,,1.,1.,1.\nGRID,8,,,1.,1.\nCHEXA,1,1,1,2,3,4,5,6\n,7,8\nMAT1,1,7.,,.3,1.\n"
    )

    @pytest.mark.parametrize(
        ("options", "same", "said"),
        [
            ("", True, False),
            (",,BUBBLE,,REDUCED", True, False),
            (",,0,,0", True, False),
            (",,1,,1", True, True),
            (",,TWO,,FULL", False, False),
            (",,2,,1", False, False),
            (",,TWO", False, False),
        ],
    )
    def test_what_the_table_does_not_hold_is_the_default(self, model, options, same, said):
        default = model(self.brick + "PSOLID,1,1\n")
        found = model(self.brick + f"PSOLID,1,1{options}\n")
        assert (_max_change(found, default) < 1e-12) == same
        assert any("integration" in w for w in found.warnings) == said


class TestTemperature:
    rod = "GRID,1,,,,,,123456\nGRID,2,,1.\nCROD,1,1,1,2\nPROD,1,1,1.\nMAT1,1,1.,,.3,1.\n"
    table = "MATT1,1,3\nTABLEM1,3\n,0.,4.,100.,16.,ENDT\n"

    @pytest.mark.parametrize(
        "temperatures",
        ["TEMPD,4,100.", "TEMP,4,1,100.,2,100.", "TEMP,4,1,100.,2,100.\nTEMPD,4,7.,5,8."],
    )
    def test_the_grids_own_go_before_the_default(self, model, temperatures):
        cold = model(self.rod + self.table + "TEMPD,4,0.", case="TEMP(INIT) = 4")
        hot = model(self.rod + self.table + temperatures, case="TEMP(INIT) = 4")
        assert hot.K().diagonal() == pytest.approx(4.0 * cold.K().diagonal())

    @pytest.mark.parametrize(
        ("case", "factor"),
        [
            ("TEMPERATURE = 4", 16.0),
            ("TEMP(MAT) = 4", 16.0),
            ("TEMPERATURE(BOTH) = 4", 16.0),
            ("TEMP(INIT) = 5\nTEMP = 4", 4.0),
            ("TEMP = 4\nTEMPERATURE(INITIAL) = 5", 4.0),
            ("TEMP(LOAD) = 4", 1.0),
        ],
    )
    def test_the_temperature_of_materials_is_the_one_selected(self, model, case, factor):
        found = model(self.rod + self.table + "TEMPD,4,100.,5,0.", case=case)
        plain = model(self.rod)
        assert found.K().diagonal() == pytest.approx(factor * plain.K().diagonal())
        assert any("no temperature" in w for w in found.warnings) == ("LOAD" in case)

    @pytest.mark.parametrize(
        ("table", "modulus"),
        [
            ("TABLEM1,3,LOG,LOG\n,10.,4.,1000.,400.,ENDT", 40.0),
            ("TABLEM1,3,LOG\n,10.,4.,1000.,16.,ENDT", 10.0),
            ("TABLEM1,3,,LOG\n,0.,4.,200.,16.,ENDT", 8.0),
            ("TABLEM2,3,,1\n,0.,4.,50.,16.,ENDT", 16.0),
            ("TABLEM2,3\n,0.,4.,50.,16.,ENDT", 28.0),
            ("TABLEM3,3,0.,1.,1\n,0.,4.,50.,16.,ENDT", 16.0),
        ],
    )
    def test_axes_and_ends_of_tables(self, model, table, modulus):
        hot = model(f"{self.rod}MATT1,1,3\n{table}\nTEMPD,4,100.\n", case="TEMP(INIT) = 4")
        assert hot.K().diagonal() == pytest.approx(modulus * model(self.rod).K().diagonal())

    def test_a_logarithm_of_nothing_is_refused(self, model):
        table = "MATT1,1,3\nTABLEM1,3,LOG\n,0.,4.,100.,16.,ENDT\nTEMPD,4,50.\n"
        with pytest.raises(InputError, match=r"TABLEM1 3 .*has no finite value at the temperature"):
            model(self.rod + table, case="TEMP(INIT) = 4")

    @pytest.mark.parametrize(
        "material",
        [
            "MAT1,1,1.,,.3,1.,,,.5\nMATT1,1,,,,,,,3",
            "MAT2,1,1.,0.,0.,1.,0.,1.,1.\n,,,,,.5\nMATT2,1\n,,,,,3",
            "MAT8,1,1.,1.,.3,1.\n,,,,,,,,\n,.5\nMATT8,1\n,,,,,,,,\n,3",
            f"MAT9,1{3 * (',' * 8 + chr(10))},,,,,,,.5\nMATT9,1{3 * (',' * 8 + chr(10))},,,,,,,3",
        ],
    )
    def test_damping_follows_its_own_table(self, deck, material):
        found = deck(f"{material}\nTABLEM1,3\n,0.,4.,100.,16.,ENDT\nTEMPD,4,100.",
                     case="TEMP(INIT) = 4")  # fmt: skip
        hot = read_thermal(found).applied(found.bulk)
        assert hot.table(material[:4])[1].ge == 16.0

    def test_different_temperatures_are_refused(self, model):
        cards = self.rod + self.table + "TEMP,4,1,50.\nTEMPD,4,60."
        with pytest.raises(InputError, match="initial temperatures differ"):
            model(cards, case="TEMP(INIT) = 4")


class TestParameters:
    def test_autospc_may_stand_in_case_control(self, model):
        rod = "GRID,1,,,,,,123456\nGRID,2,,1.\nCROD,1,1,1,2\nPROD,1,1,1.\nMAT1,1,1.,,.3,1.\n"
        assert model(rod).n_free == 1
        assert model(rod, case="AUTOSPC = NO").n_free == 3


BAD = [
    ("GRID,1,,0.,0.,0.,,1A3", r"deck.bdf line \d+: GRID 1: .*1A3"),
    ("GRDSET,,,,,,,1A3\nGRID,1", r"GRDSET: PS \(field 8\) holds '1A3'"),
    (
        "MAT1,1,7.+4,,.3,nan",
        r"deck.bdf line \d+: MAT1 1: RHO \(field 6\) holds 'nan', which is not a real number",
    ),
    ("MAT1,1,inf,,.3", r"MAT1 1: E \(field 3\) holds 'inf'"),
    ("MAT1,1,-7.+4,,.3", r"MAT1 1 \(.*deck.bdf line \d+\): E is -70000"),
    ("RBE3,7,,5,123,1.,123,1,2,3", r"line \d+: RBE3 has more than eight values on a line"),
    ("RBE3,7,,5,123,1.,123,1,2,3,4,5", r"line \d+: RBE3 has more than eight values on a line"),
]


@pytest.mark.parametrize(("card", "message"), BAD, ids=[b[0] for b in BAD])
def test_bad_fields_are_named(model, card, message):
    first = "" if card.startswith("G") else "GRID,1\n"
    rest = "" if card.startswith("MAT1") else "MAT1,1,1.,,.3,1.\n"
    with pytest.raises(InputError, match=message):
        model(f"{first}{card}\n{rest}GRID,2,,1.\nCROD,1,1,1,2\nPROD,1,1,1.\n")


def test_a_degenerate_system_prints_nothing(model, capsys):
    with pytest.raises(
        InputError, match=r"CORD2R 5 \(.*\): its three points coincide or stand in a line"
    ):
        model("CORD2R,5,0,0.,0.,0.,0.,0.,1.\n,0.,0.,2.\nGRID,1,5")
    assert capsys.readouterr().out == ""


def test_scalar_masses_weigh_along_their_axis(deck):
    found = weight(deck(GRID + "CELAS2,1,900.,1,1\nCMASS2,2,3.,1,1\n"))
    np.testing.assert_allclose(found.masses, [3.0, 0.0, 0.0])
    assert found.mass == 3.0


def test_direct_masses_weigh_and_are_where_they_are(tmp_path):
    """M2GG at two grids along z alone, 2 and 1 times 0.5, the heavy one at x = 6."""
    path = tmp_path / "a.bdf"
    rows = ["GRID,1,,6.,1.", "GRID,2,,0.,4.", "CELAS2,1,9.,1,3,2,3", "DMIG,MX,0,6,1,0"]
    rows += ["DMIG,MX,1,3,,1,3,2.", "DMIG,MX,2,3,,2,3,1."]
    path.write_text("CEND\nM2GG = MX\nBEGIN BULK\nPARAM,CM2,.5\n" + "\n".join(rows) + "\n")
    read = read_deck(path)
    found = weight(read)
    np.testing.assert_allclose(found.masses, [0.0, 0.0, 1.5])
    assert found.mass == 1.5
    np.testing.assert_allclose(found.centre_of_gravity, [4.0, 2.0, 0.0])
    (said,) = (w for w in build_model(read).warnings if "masses along" in w)
    assert said.startswith("masses along x, y and z are 0, 0 and 1.5; the largest")


@pytest.mark.parametrize("shear", [1e-6, 1.0, 1e3])
def test_lines_have_any_modulus_of_shear(model, shear):
    """A stick model's material: shells refuse a Poisson's ratio of 49."""
    cards = f"GRID,1,,,,,,123456\nGRID,2,,2.,0.,0.,,2356\nMAT1,1,100.,{shear}\n"
    for element in ("CROD,1,1,1,2\nPROD,1,1,3.,5.", "CBAR,1,1,1,2,0.,1.\nPBAR,1,1,3.,1.,1.,5."):
        found = model(f"{cards}{element}\nPARAM,AUTOSPC,NO\n")
        np.testing.assert_allclose(found.K().diagonal(), [150.0, 2.5 * shear], rtol=1e-12)
    plate = "GRID,3,,0.,1.\nCTRIA3,1,1,1,2,3\nPSHELL,1,1,.1\n"
    with pytest.raises(InputError, match="Poisson's ratio") if shear < 30.0 else nullcontext():
        model(cards + plate)


def test_a_solid_that_names_a_grid_twice_is_refused(model):
    grids = "".join(
        f"GRID,{1 + i + 2 * j + 4 * k},,{i}.,{j}.,{k}.\n"
        for i in (0, 1)
        for j in (0, 1)
        for k in (0, 1)
    )
    with pytest.raises(InputError, match=r"CHEXA 5 \(.*\) names a grid twice"):
        model(grids + "CHEXA,5,1,1,2,4,3,5,6\n,8,8\nPSOLID,1,1\nMAT1,1,1.,,.3,1.")
