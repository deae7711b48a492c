"""Whole decks against what NX and MSC Nastran printed for them."""

import numpy as np
import pytest

from trueup.adapters.nastran import build_model, read_deck
from trueup.core.eigen.normal_modes import solve


def test_structure_on_a_seismic_mass(data):
    """A base of 1e9 under some hundredths: no small mass is the rounding of a large one."""
    found = solve(build_model(read_deck(data / "nastran/seismic_mass/good_sine.dat")), 12)
    nx = [10.41889, 20.83568, 63.25364, 126.40667, 176.32675]
    assert found.rigid_body_modes == 6
    np.testing.assert_allclose(found.frequencies_hz[6:11], nx, rtol=1e-6)


@pytest.mark.parametrize("number", [6, 14])
def test_rotor_condensed_to_grids_with_hardly_any_mass(data, number):
    """NX at rest, lambda = -a +- i omega with dashpots: |lambda| is nearly the undamped one.

    Behind the sixth mode come those of condensed masses of 1e-12 to 1e-25, at a million hertz.
    """
    found = solve(build_model(read_deck(data / "nastran/rotor/rot063akd2s_107.bdf")), number)
    real = np.array([0.99949, 0.99951, 8.91852, 8.91875, 143.13274, 12821.45])
    hz = np.array([50.148106, 50.148694, 149.79423, 149.79644, 601.69805, 5320.906])
    nx = np.hypot(real / (2.0 * np.pi), hz)
    np.testing.assert_allclose(found.frequencies_hz[:6], nx, rtol=5e-4)
    assert found.checks.rayleigh < 1e-6


def elastic(path, number):
    found = solve(build_model(read_deck(path)), number)
    return found.frequencies_hz[found.rigid_body_modes :]


def test_orientation_flag_of_old_in_the_place_of_offt(data):
    """CBAR ... 1: X1, X2, X3 are a vector, as before there were offsets (MSC 2020)."""
    msc = [39.96147, 236.4137, 250.4423, 701.4011, 703.4198]
    found = elastic(data / "nastran/bar_offset_flag/pt145.bdf", 5)
    np.testing.assert_allclose(found, msc, rtol=1e-6)


def test_tapered_beams_beside_a_matrix_of_response_analysis(data):
    """MSC 2005: K2PP does not enter normal modes; a tail that tapers from 20 to 1 in a beam."""
    path = data / "nastran/dmig_grid/fmondsp.dat"
    msc = [5.391272, 6.282554, 12.48913, 13.63147, 13.95180, 19.32352, 20.56834, 28.68447]
    msc += [35.84441, 35.92411, 42.05270, 56.62616]
    np.testing.assert_allclose(elastic(path, 18), msc, rtol=1e-6)
    assert any("K2PP = STIFF" in warning for warning in read_deck(path).warnings)


def test_component_modes_of_a_free_boundary(data):
    """NX: four corners free (BNDFREE), modes of the free plate in 500 scalar points (QSET1)."""
    found = solve(build_model(read_deck(data / "nastran/craig_bampton/extse04c.bdf")), 10)
    assert found.rigid_body_modes == 6
    nx = [180.551, 261.290, 332.988, 459.570]
    np.testing.assert_allclose(found.frequencies_hz[6:], nx, rtol=3e-6)


def test_component_modes_of_a_fixed_boundary(data):
    """MSC 2019: three modes of nine that EIGRL asks for, since QSET has no more room."""
    path = data / "nastran/cantilever/dynamicReduction.dat"
    msc = [349.7303, 2168.717, 6015.472, 11974.12, 29336.18]
    np.testing.assert_allclose(elastic(path, 5), msc, rtol=1e-6)


def test_membranes_of_anisotropic_shells_with_and_without_middle_nodes(data):
    """NX: CQUADR, CTRIAR, CQUAD8 and CTRIA6 of plies, nodes left out; behind nine modes that bend.

    The mass of nodes that are left out goes to the ends of their edges before the corners lose
    theirs, and rotations about the normal are held by the shear stiffness in element axes.
    """
    model = build_model(read_deck(data / "nastran/mixed_shells/trncomp12.bdf"))
    for card in ("CQUAD8 with 8", "CTRIA6 with 6", "CTRIAR with 3"):
        assert sum(card in w and "is not known" in w for w in model.warnings) == 1
    found = solve(model, 29)
    square = [23.376093, 62.008167, 164.75215, 286.12778, 332.41791, 786.60229, 971.40106]
    square += [1101.5419, 1175.8164, 1659.0892, 1832.5781, 2029.4102, 2152.9370, 2658.0791]
    square += [3139.2825, 3669.9431, 3725.5938, 4078.3342, 7461.1851, 8890.8848]
    hertz = np.sqrt(square) / (2.0 * np.pi)
    np.testing.assert_allclose(found.frequencies_hz[9:], hertz, rtol=1e-6)


BOLTED = """\
METHOD = 1
SPC = 1
BEGIN BULK
PARAM,WTMASS,.00259
EIGRL,1,,,2
SPC1,1,123456,27,28
PSHELL,1,1,.1,1,,1
PBUSH,2,K,1.+9,1.+9,1.+9,1.+9,1.+9,1.+9
MAT1,1,9.9+6,,.31,.098
CQUAD4,1,1,1,2,3,4
CQUAD4,2,1,5,6,7,8
CQUAD4,31,1,1,2,28,27
CQUAD4,33,1,7,8,30,29
"""
CORNERS = """\
1 0. 0. 0.,2 1. 0. 0.,3 1. 2. 0.,4 0. 2. 0.,5 0. 1. .1,6 1. 1. .1,7 1. 3. .1,8 0. 3. .1,
27 0. -.1 0.,28 1. -.1 0.,29 1. 3.1 .1,30 0. 3.1 .1"""
BOLTS = [".5 1.5", ".875 1.5", ".125 1.5", ".875 1.25", ".875 1.75", ".5 1.25", ".5 1.75"]
BOLTS += [".125 1.75", ".125 1.25"]


def test_plates_bolted_through_weighted_means_of_their_corners(tmp_path):
    """MSC 2025.2: 18 RBE3, nine CBUSH across them (MYSTRAN_Validation, turbo_coarse_bolted)."""
    grids = [c.split() for c in CORNERS.replace("\n", "").split(",")]
    joints = []
    for k, bolt in enumerate(BOLTS):
        grids += [[f"{9 + k}", *bolt.split(), "0."], [f"{18 + k}", *bolt.split(), ".1"]]
        joints += [
            f"RBE3,{3 + k},,{9 + k},123456,1.,123,1,2\n,3,4",
            f"RBE3,{12 + k},,{18 + k},123456,1.,123,5,6\n,7,8",
            f"CBUSH,{50 + k},2,{18 + k},{9 + k},.577,.577,.577",
        ]
    cards = [*(f"GRID,{n},,{x},{y},{z}" for n, x, y, z in grids), *joints, "ENDDATA\n"]
    (tmp_path / "a.bdf").write_text("SOL 103\nCEND\n" + BOLTED + "\n".join(cards))
    np.testing.assert_allclose(elastic(tmp_path / "a.bdf", 2), [270.8582, 1269.993], rtol=5e-7)


CANTILEVER = """\
NASTRAN BARMASS=1
SOL 103
CEND
METHOD = 1
SPC = 1
BEGIN BULK
PARAM,COUPMASS,1
EIGRL,1,,,12
SPC1,1,123456,1
MAT1,1,7.17+10,,.33,2810.
"""
NSM = 2810.0 * 0.025 * 0.00625


def cantilever(path, element, make):
    """Fifty elements in a metre, turned by thirty degrees, made from the scales of their ends."""
    cards = [f"GRID,{k + 1},,{k / 50}" for k in range(51)]
    for k in range(50):
        prop, offsets = make(1.0 - 0.01 * k, 0.99 - 0.01 * k)
        cards.append(prop.format(k + 1))
        cards.append(f"{element},{k + 1},{k + 1},{k + 1},{k + 2},0.,.8660254,.5\n,,,{offsets}")
    path.write_text(CANTILEVER + "\n".join(cards) + "\nENDDATA\n")
    return elastic(path, 12)


def test_bars_that_turn_about_their_axis(tmp_path):
    """BARMASS 1: consistent along and about the axis; tubes beside their grids (TACS).

    The shear factor of a tube is Cowper's without Poisson's ratio there, not PBARL's 0.5.
    """
    A, i = np.pi * (0.0125**2 - 0.011875**2), np.pi / 4.0 * (0.0125**4 - 0.011875**4)
    tube = f"PBAR*,{{}},1,{A},{i}\n*,{i},{2 * i},{NSM}\n*\n*\n*,.500547,.500547"
    run = [11.788982068, 73.479154970, 203.96974252, 394.78371603, 642.51400490]
    found = cantilever(tmp_path / "a.bdf", "CBAR", lambda a, b: (tube, "0.,.0125,.05,0.,.0125,.05"))
    np.testing.assert_allclose(found[[0, 2, 4, 6, 9]], run, rtol=1e-7)
    np.testing.assert_allclose(found[[8, 11]], [611.53200851, 774.32532277], rtol=1e-7)


def test_tapered_beams_with_every_offset(tmp_path):
    """Ends, neutral axis and non-structural mass beside the grids (TACS); its deck is rounded."""

    def rectangle(a, b):
        ends = []
        for w, d in ((0.025 * s, 0.00625 * s) for s in (a, b)):
            J = w * d**3 / 16.0 * (16.0 / 3.0 - 3.36 * d / w * (1.0 - (d / w) ** 4 / 12.0))
            ends.append(f"{w * d:.7e},{w * d**3 / 12:.7e},{d * w**3 / 12:.7e},,{J:.7e},{NSM}")
        offsets = ",.00625,.025,.00625,.025,.0125,.05,.0125,.05"
        prop = f"PBEAM,{{}},1,{ends[0]}\n,\n,NO,1.,{ends[1]}\n,.8333333,.8333333\n{offsets}"
        return prop, "0.,.0125,.05,0.,.0125,.05"

    run = [3.4020326843, 13.585184614, 15.484585105, 38.639044432, 61.250571652, 71.531582313]
    run += [112.54780736, 122.95368962, 150.45980354, 161.95891874, 213.44033788, 270.14164160]
    found = cantilever(tmp_path / "a.bdf", "CBEAM", rectangle)
    np.testing.assert_allclose(found, run, rtol=1e-5)
