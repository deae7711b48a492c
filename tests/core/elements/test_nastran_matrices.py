"""Element by element against the matrices that NX and MSC Nastran made themselves."""

import numpy as np
import pytest
from tests.core.elements.plates_and_volumes import isotropic_section

from trueup.core.elements.lines.bar import bar_mass, bar_stiffness, rod_mass, rod_stiffness
from trueup.core.elements.surfaces.quad4 import QUAD4
from trueup.core.elements.surfaces.tria3 import TRIA3
from trueup.core.elements.volumes.hexa import HEXA8
from trueup.core.elements.volumes.penta import PENTA6
from trueup.core.elements.volumes.pointed import TETRA4
from trueup.core.elements.volumes.solid import isotropic_solid

E, NU, G, RHO = 2.9e7, 0.32, 1.1e7, 0.283
THICKNESS = {**dict.fromkeys((6, 7, 8, 9, 10, 11), 0.25), **dict.fromkeys((16, 18, 19), 1.0)}
THICKNESS |= dict.fromkeys((17, 20, 21), 1.5)
SOLIDS = {1: HEXA8.stiffness, 2: PENTA6.stiffness, 3: PENTA6.stiffness}
SOLIDS |= {4: TETRA4.stiffness, 5: TETRA4.stiffness}


def deviation(matrix, reference):
    return np.abs(matrix - reference).max() / np.abs(reference).max()


def shell(xyz, t, shear_ratio):
    section = isotropic_section(E, NU, G, t, 1.0, shear_ratio)
    function = QUAD4.stiffness if len(xyz) == 4 else TRIA3.stiffness
    return function(xyz[None], section)[0]


def bar(xa, xb, v, area, inertia, torsion):
    one = np.ones(1)
    none = np.zeros((1, 6), dtype=bool)
    zero = 0.0 * one
    values = (E * one, G * one, area * one, inertia * one, inertia * one, zero, torsion * one)
    return bar_stiffness(xa[None], xb[None], v, *values, zero, zero, none, none)[0]


@pytest.mark.parametrize("eid", [6, 7, 8, 9, 10, 11])
def test_homogeneous_shell_is_nx(nx, eid):
    # KELM comes from single precision properties: eight digits are all there are
    K = shell(nx.xyz[eid], 0.25, nx.shear_ratio)
    assert deviation(K, nx.K[eid]) < 5e-9


@pytest.mark.parametrize("eid", [16, 17, 18, 19, 20, 21])
def test_laminate_of_one_material_is_nx(nx, eid):
    assert deviation(shell(nx.xyz[eid], THICKNESS[eid], 5 / 6), nx.K[eid]) < 1e-13


@pytest.mark.parametrize("eid", SOLIDS)
def test_solid_is_nx(nx, eid):
    K = SOLIDS[eid](nx.xyz[eid][None], isotropic_solid(E, NU))[0]
    assert deviation(K, nx.K[eid]) < 1e-13


def test_bar_is_nx(nx):
    xa, xb = nx.xyz[13]
    K = bar(xa, xb, np.array([[0.0, 1.0, 0.0]]), 0.25, 0.0052083, 0.0088021)
    assert deviation(K, nx.K[13]) < 1e-7


@pytest.mark.parametrize("eid", [14, 15])
def test_rod_is_nx(nx, eid):
    one = np.ones(1)
    K = rod_stiffness(nx.xyz[eid][None], E * one, 0.1 * one, G * one, 0.0088021 * one)[0]
    # the reference stands in the rod's own axes, axial first
    axial, torsion = nx.K[eid][0, 0], nx.K[eid][3, 3]
    assert K[2, 2] == pytest.approx(axial, rel=1e-7)
    assert K[5, 5] == pytest.approx(torsion, rel=1e-7)
    assert np.trace(K) == pytest.approx(np.trace(nx.K[eid]), rel=1e-7)


@pytest.mark.parametrize(
    ("eids", "mass"),
    [
        ((6, 7, 16, 17), QUAD4.mass),
        ((8, 9, 18, 19, 20, 21), TRIA3.mass),
        ((1,), HEXA8.mass),
        ((2, 3), PENTA6.mass),
        ((4, 5), TETRA4.mass),
    ],
)
def test_lumped_mass_is_nx(nx, eids, mass):
    for eid in eids:
        density = np.array([RHO * THICKNESS.get(eid, 1.0)])
        M = mass(nx.xyz[eid][None], density, coupled=False)[0]
        translations = [i for i in range(len(M)) if eid in SOLIDS or i % 6 < 3]
        reference = nx.M[eid]
        if len(reference) == len(M):
            reference = reference[np.ix_(translations, translations)]
        assert deviation(M[np.ix_(translations, translations)], reference) < 1e-7


def test_lumped_mass_of_lines_is_nx(nx):
    across, one = np.array([[0.0, 1.0, 0.0]]), np.ones(1)
    bar_ = bar_mass(*nx.xyz[13][:, None], across, RHO * 0.25 * one, coupled=False)[0]
    rod = rod_mass(nx.xyz[14][None], RHO * 0.1 * one, coupled=False)[0]
    assert deviation(bar_, nx.M[13]) < 1e-7
    assert deviation(rod, nx.M[14]) < 1e-7


MSC_SHELLS = {6: 0.25, 7: 0.25, 8: 0.25, 9: 0.25, 10: 0.25, 11: 0.25, 23: 1.0} | {
    e: THICKNESS[e] for e in (16, 17, 18, 19, 20, 21)
}


def residual(K, element, per_node):
    f = element.f[:, :per_node].reshape(len(K), -1)
    u = element.u[:, :per_node].reshape(len(K), -1)
    return (np.linalg.norm(K @ u + f, axis=0) / np.linalg.norm(f, axis=0)).max()


@pytest.mark.parametrize("eid", MSC_SHELLS)
def test_shell_makes_msc_grid_point_forces(msc, eid):
    homogeneous = MSC_SHELLS[eid] == 0.25
    K = shell(msc[eid].xyz, MSC_SHELLS[eid], 0.8333333 if homogeneous else 5 / 6)
    assert residual(K, msc[eid], 6) < (5e-9 if homogeneous else 1e-12)


@pytest.mark.parametrize("eid", SOLIDS)
def test_solid_makes_msc_grid_point_forces(msc, eid):
    K = SOLIDS[eid](msc[eid].xyz[None], isotropic_solid(E, NU))[0]
    assert residual(K, msc[eid], 3) < 1e-9


def test_bar_makes_msc_grid_point_forces(msc):
    xa, xb = msc[13].xyz
    K = bar(xa, xb, np.array([[0.0, 1.0, 0.0]]), 0.25, 0.0052083, 0.0088021)
    assert residual(K, msc[13], 6) < 1e-12
