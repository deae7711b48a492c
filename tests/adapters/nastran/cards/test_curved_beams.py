"""CBEND, CBEAM3 and PBCOMP against closed forms and against what they stand for."""

import numpy as np
import pytest

from trueup.adapters.nastran import build_model, read_deck
from trueup.core.eigen.normal_modes import solve
from trueup.core.errors import InputError

E, NU, RHO = 2.1e5, 0.3, 7.85e-9
G = E / (2.0 + 2.0 * NU)
R, H, B, J = 100.0, 4.0, 6.0, 50.0
A, IN, ACROSS = H * B, B * H**3 / 12.0, H * B**3 / 12.0
MATERIAL = f"MAT1,1,{E},,{NU},{RHO}\n"


@pytest.fixture
def model(tmp_path):
    def of(text, case=""):
        head = f"SOL 103\nCEND\n{case}BEGIN BULK\nPARAM,COUPMASS,1\n"
        (tmp_path / "a.bdf").write_text(f"{head}{text}ENDDATA\n")
        return build_model(read_deck(tmp_path / "a.bdf"))

    return of


def grids(points):
    return "".join(
        f"GRID,{k},,{x:.13f},{y:.13f},{z:.13f}\n" for k, (x, y, z) in enumerate(points, 1)
    )


def on_arc(t, radius=R, z=0.0):
    return np.stack([radius * np.cos(t), radius * np.sin(t), np.full_like(t, z)], axis=1)


def at_end(found):
    """Flexibility at the last grid, the first being held."""
    return np.linalg.inv(found.K().toarray()[6:, 6:])[-6:, -6:]


def pbend(angle, rest):
    return f"PBEND,7,1,{A},{IN},{ACROSS},{J},{R},{angle:.12f}\n,\n{rest}"


def quarter(n, geom, rest=",\n"):
    t = np.linspace(0.0, 0.5 * np.pi, n + 1)
    text = grids(on_arc(t)) + MATERIAL + pbend(90.0 / n, rest)
    vectors = {1: -on_arc(t, 1.0), 2: on_arc(t + 0.5 * np.pi, 1.0), 3: on_arc(0 * t + 0.8, 1.0)}
    for k, v in enumerate(vectors[min(geom, 3)][:n], 1):
        text += f"CBEND,{k},7,{k},{k + 1},{v[0]:.13f},{v[1]:.13f},0.,{geom}\n"
    return text


@pytest.mark.parametrize("geom", [1, 2, 3, 4])
@pytest.mark.parametrize("n", [1, 3])
def test_a_quarter_of_a_circle_bends_as_winkler_and_castigliano_have_it(model, n, geom):
    """Radial, tangential and transverse forces at its end; exact with one element."""
    found = at_end(model(quarter(n, geom)))
    radial = np.pi / 4 * R**3 / (E * IN) - np.pi / 4 * R / (E * A)
    tangential = (0.75 * np.pi - 2) * R**3 / (E * IN) + (2 - 0.25 * np.pi) * R / (E * A)
    across = np.pi / 4 * R**3 / (E * ACROSS) + (0.75 * np.pi - 2) * R**3 / (G * J)
    assert found[1, 1] == pytest.approx(radial, rel=1e-9)
    assert found[0, 0] == pytest.approx(tangential, rel=1e-9)
    assert found[2, 2] == pytest.approx(across, rel=1e-9)


def test_a_bend_is_flexible_in_shear_where_its_factors_say_so(model):
    stiff, soft = (at_end(model(quarter(2, 3, rest))) for rest in (",\n", ",.8,.7\n"))
    assert (soft - stiff)[0, 0] == pytest.approx(np.pi / 4 * R / (0.8 * G * A), rel=1e-6)
    assert (soft - stiff)[2, 2] == pytest.approx(np.pi / 2 * R / (0.7 * G * A), rel=1e-6)


def test_a_bend_whose_centroids_stand_off_its_grids(model):
    """RC outward, ZC across: the arc of the centroids with rigid arms."""
    inner = grids(on_arc(np.array([0.0, 0.5 * np.pi]), R - 5.0))
    bend = "CBEND,1,7,1,2,1.,1.,0.,3\n"
    found = at_end(model(inner + bend + MATERIAL + pbend(90.0, ",,,,5.,3.\n")))
    arm = np.eye(6)
    arm[:3, 3:] = -np.array([[0.0, -3.0, 5.0], [3.0, 0.0, 0.0], [-5.0, 0.0, 0.0]])
    on_line = at_end(model(quarter(1, 3)))
    inverse = np.linalg.inv(arm)
    np.testing.assert_allclose(found, inverse @ on_line @ inverse.T, atol=1e-9)


@pytest.mark.parametrize("kind", ["CBEND", "CBEAM3"])
def test_a_ring_has_its_frequencies(model, kind):
    """In the plane n (n^2 - 1) / sqrt(n^2 + 1), across it with torsion (Love, Timoshenko)."""
    n = 24
    t = np.linspace(0.0, 2.0 * np.pi, 2 * n + 1)[:-1]
    h, b = 1.0, 1.5
    area, flat, tall, torsion = h * b, b * h**3 / 12.0, h * b**3 / 12.0, 0.3
    if kind == "CBEND":
        text = grids(on_arc(t[::2]))
        text += f"PBEND,7,1,{area},{flat},{tall},{torsion},{R}\n"
        ends = [(k + 1, (k + 1) % n + 1) for k in range(n)]
        text += "".join(
            f"CBEND,{a},7,{a},{b},{np.cos(t[2 * a - 1]):.9f},{np.sin(t[2 * a - 1]):.9f},0.,3\n"
            for a, b in ends
        )
    else:
        text = grids(on_arc(t)) + f"PBEAM3,7,1,{area},{tall},{flat},,{torsion}\n"
        text += "".join(
            f"CBEAM3,{k + 1},7,{2 * k + 1},{(2 * k + 2) % (2 * n) + 1},{2 * k + 2},0.,0.,1.\n"
            for k in range(n)
        )
    hz = solve(model(text + MATERIAL), 14).frequencies_hz[6:]
    unit = np.sqrt(E / (RHO * area * R**4)) / (2.0 * np.pi)
    i = np.array([2.0, 3.0])
    plane = i * (i**2 - 1.0) / np.sqrt(i**2 + 1.0) * unit * np.sqrt(flat)
    ratio = E * tall / (G * torsion)
    across = i * (i**2 - 1.0) / np.sqrt(i**2 + ratio) * unit * np.sqrt(tall)
    expected = np.sort(np.repeat(np.concatenate([plane, across]), 2))
    np.testing.assert_allclose(hz[: len(expected)], expected, rtol=2e-3)


CLAMPED = "GRID,1,,0.,0.,0.\nGRID,2,,25.,0.,0.\nGRID,3,,50.,0.,0.\n" + MATERIAL


def test_a_straight_beam_of_three_nodes_is_timoshenko_s(model):
    text = f"CBEAM3,1,7,1,3,2,0.,1.,0.\nPBEAM3,7,1,{A},{IN},{ACROSS},,{J}\n,\n,\n,\n,\n,\n,.8,.7\n"
    found, L = at_end(model(CLAMPED + text)), 50.0
    expected = [
        L / (E * A),
        L**3 / (3 * E * IN) + L / (0.8 * G * A),
        L**3 / (3 * E * ACROSS) + L / (0.7 * G * A),
        L / (G * J),
        L / (E * ACROSS),
        L / (E * IN),
    ]
    np.testing.assert_allclose(np.diag(found), expected, rtol=1e-9)


def test_twist_offsets_neutral_axis_and_mass_of_three_nodes(model):
    """Turned by 90 degrees planes change places; offsets and neutral axes are rigid arms."""
    head = f"PBEAM3,7,1,{A},{IN},{ACROSS},,{J},2.-8\n,\n,\n,\n,\n,\n,.8,.7"
    plain = model(CLAMPED + f"CBEAM3,1,7,1,3,2,0.,1.,0.\n{head}\n")
    turned = model(CLAMPED + f"CBEAM3,1,7,1,3,2,0.,0.,-1.\n,\n,,90.,90.,90.\n{head}\n")
    np.testing.assert_allclose(turned.K().toarray(), plain.K().toarray(), atol=1e-6)
    beside = model(CLAMPED + f"CBEAM3,1,7,1,3,2,0.,1.,0.\n{head},2.,3.\n,2.,3.\n")
    wide = ",0.,2.,3.,0.,2.,3.,0.,2.\n,3."
    moved = model(CLAMPED + f"CBEAM3,1,7,1,3,2,0.,1.,0.\n{wide}\n{head}\n")
    for name in ("K", "M"):
        one, other = (getattr(m, name)().toarray() for m in (beside, moved))
        # shear and torsion act at the shear centre, which the neutral axis does not move
        kept = [k for k in range(18) if k % 6 in (0, 4, 5)] if name == "K" else range(18)
        np.testing.assert_allclose(
            one[np.ix_(kept, kept)], other[np.ix_(kept, kept)], atol=1e-9 * abs(other).max()
        )
    mass = plain.M().toarray()
    assert mass[::6, ::6].sum() == pytest.approx((RHO * A + 2e-8) * 50.0)


def test_nonstructural_mass_counts_along_the_arc(model):
    case = quarter(2, 3).replace("MAT1", "NSM1,5,PBEND,3.,7\nMAT1")
    mass = model(case, "NSM = 5\n").M().toarray()[::6, ::6].sum()
    assert mass == pytest.approx((RHO * A + 3.0) * 0.5 * np.pi * R, rel=1e-6)
    with pytest.raises(InputError, match=r"NSML1 5 .*element 1, which is curved"):
        model(case.replace("NSM1,", "NSML1,"), "NSM = 5\n")


def test_an_arch_of_three_node_beams_comes_to_the_circle(model):
    exact = np.pi / 4 * R**3 / (E * IN) + np.pi / 4 * R / (E * A) + np.pi / 4 * R / (0.7 * G * A)
    off = []
    for n in (2, 4, 8):
        points = on_arc(np.linspace(0.0, 0.5 * np.pi, 2 * n + 1))
        text = grids(points) + MATERIAL + f"PBEAM3,7,1,{A},{ACROSS},{IN},,{J}\n"
        text += ",\n,\n,\n,\n,\n,.8,.7\n"
        for k in range(n):
            text += f"CBEAM3,{k + 1},7,{2 * k + 1},{2 * k + 3},{2 * k + 2},0.,0.,1.\n"
        off.append(abs(at_end(model(text))[1, 1] / exact - 1.0))
    assert off[0] < 0.01
    assert off[1] < off[0] / 12.0
    assert off[2] < off[1] / 12.0


def test_a_pipe_is_the_bend_of_its_section(model):
    """A solid circle has the shear factor 0.9, a thin ring 0.5; the neutral axis is exact."""
    for rm, t, k, tolerance in ((3.0, 0.0, 0.9, 1e-3), (3.0, 0.02, 0.5, 2e-3)):
        outer, inner = rm + 0.5 * t, rm - 0.5 * t if t else 0.0
        area, inertia = np.pi * (outer**2 - inner**2), np.pi / 4 * (outer**4 - inner**4)
        two = [np.sqrt(R**2 - r**2) for r in (outer, inner)]
        e = R - area / (2 * np.pi * (two[1] - two[0]))
        head = quarter(1, 3).partition("PBEND")[0] + "CBEND,1,7,1,2,1.,1.,0.,3\n"
        pipe = at_end(model(head + f"PBEND,7,1,1,{rm},{t},,{R}\n"))
        same = f"PBEND,7,1,{area:.9f},{inertia:.9f},{inertia:.9f},{2 * inertia:.9f},{R}\n,\n"
        beam = at_end(model(head + same + f",{k},{k},,,,{e:.12f}\n"))
        np.testing.assert_allclose(pipe, beam, rtol=tolerance, atol=1e-9 * abs(beam).max())


FOUR = ((5.0, 3.0), (-5.0, 3.0), (5.0, -3.0), (-5.0, -3.0))


def pbcomp(symmetry, points, rest="", mids=(1, 1, 1, 1)):
    lines = "".join(f",{y},{z},.25,{m}\n" for (y, z), m in zip(points, mids, strict=False))
    return f"PBCOMP,7,1,10.,{rest}\n,,,,,,,{symmetry}\n{lines}"


@pytest.mark.parametrize(
    "card",
    [
        "PBCOMP,7,1,10.,250.,90.,,7.,1.-9\n",
        pbcomp(1, FOUR[:1], ",,,7.,1.-9"),
        pbcomp(2, FOUR[:2], ",,,7.,1.-9"),
        pbcomp(3, FOUR[::2], ",,,7.,1.-9"),
        pbcomp(5, FOUR, ",,,7.,1.-9"),
    ],
)
def test_a_composite_beam_of_one_material_is_a_pbeam(model, card):
    beam = CLAMPED + "CBEAM,1,7,1,3,0.,1.,0.\nSPC1,1,123456,2\n"
    found, known = (model(beam + c) for c in (card, "PBEAM,7,1,10.,250.,90.,,7.,1.-9\n"))
    np.testing.assert_allclose(found.K().toarray(), known.K().toarray(), atol=1e-6)
    np.testing.assert_allclose(found.M().toarray(), known.M().toarray(), rtol=1e-12, atol=1e-20)


def test_a_composite_beam_of_two_materials(model):
    """Half of the area twice as stiff and half as heavy: the neutral axis is theirs."""
    card = pbcomp(5, FOUR, ",,,7.", (2, 1, 2, 1)) + f"MAT1,2,{2 * E},,{NU},{0.5 * RHO}\n"
    found = model(CLAMPED + "CBEAM,1,7,1,3,0.,1.,0.\n" + card)
    K = found.K().toarray()[-6:, -6:]
    y = 5.0 * (10.0 * E - 5.0 * E) / (15.0 * E)
    assert K[0, 0] == pytest.approx(15.0 * E / 50.0)
    assert K[0, 5] == pytest.approx(-15.0 * E / 50.0 * y)
    assert found.M().toarray()[::6, ::6].sum() == pytest.approx(7.5 * RHO * 50.0)


@pytest.mark.parametrize(
    ("text", "said"),
    [
        (quarter(1, 3).replace(",3\n", ",5\n"), r"CBEND 1 \(.*line 11\): GEOM 5 is not one of"),
        (quarter(1, 3).replace("0.000000000000,3", "0.,3").replace(f",{R},", ",20.,"), "GEOM 3 of"),
        (quarter(1, 4).replace(",90.0", ",190.0"), r"PBEND 7 \(.*line 8\): GEOM 4 of"),
        (pbcomp(4, FOUR) + "CBEAM,1,7,1,3,0.,1.,0.\n" + CLAMPED, r"PBCOMP 7 .*: SYMOPT 4"),
        (pbcomp(5, FOUR[::3]) + "CBEAM,1,7,1,3,0.,1.,0.\n" + CLAMPED, "on a straight line"),
        (CLAMPED + f"CBEAM3,1,7,1,2,3,0.,1.,0.\nPBEAM3,7,1,{A},{IN},{ACROSS}\n", "GC does not"),
        (CLAMPED + f"CBEAM3,1,7,1,3,2,1.,0.,0.\nPBEAM3,7,1,{A},{IN},{ACROSS}\n", "orientation"),
        (CLAMPED + f"CBEAM3,1,7,1,3,,0.,1.,0.\nPBEAM3,7,1,{A},{IN},{ACROSS}\n", "CBEAM3 1"),
    ],
)
def test_what_is_wrong_is_said_with_its_card(model, text, said):
    with pytest.raises(InputError, match=said):
        model(text)
