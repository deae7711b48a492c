"""By how much known parameters change what elements hold."""

import numpy as np
import pytest

from trueup.adapters.nastran import read_deck
from trueup.adapters.nastran.discovery.build_structure import build_structure
from trueup.adapters.nastran.fields.parameter_references import FieldRef, ParameterSpec
from trueup.core.discovery.reduction.strain_energies import strain_energies
from trueup.core.eigen.normal_modes import solve

SIDE = 6
KNOWN = [
    ParameterSpec("modulus", (FieldRef("MAT1", 1, "E"),), 0.5, 2.0),
    ParameterSpec("thickness", (FieldRef("PSHELL", 1, "T"),), 0.5, 2.0),
]


@pytest.fixture
def plate(tmp_path):
    """A thin plate, clamped along one edge, its modulus and its thickness known parameters."""
    cards = "MAT1,1,70000.,,0.3,2.7-9\nPSHELL,1,1,0.5,1,,1\n"
    n = SIDE + 1
    for k in range(n * n):
        held = "123456" if k % n == 0 else ""
        cards += f"GRID,{k + 1},,{20.0 * (k % n)},{20.0 * (k // n)},0.,,{held}\n"
    for k in range(SIDE * SIDE):
        a = 1 + k % SIDE + n * (k // SIDE)
        cards += f"CQUAD4,{k + 1},1,{a},{a + 1},{a + 1 + n},{a + n}\n"
    path = tmp_path / "plate.bdf"
    path.write_text(f"CEND\nBEGIN BULK\n{cards}ENDDATA\n")
    return build_structure(read_deck(path), KNOWN)


def test_what_bends_follows_the_modulus_and_the_cube_of_the_thickness(plate):
    s = solve(plate.model, 5)
    (held,) = strain_energies(plate, s.vectors, s.eigenvalues)
    exponents = held[:, 1:] / held[:, :1]
    np.testing.assert_allclose(exponents[:, 0], 1.0, atol=1e-5)
    np.testing.assert_allclose(exponents[:, 1], 3.0, atol=0.02)


def test_the_energies_of_all_elements_are_those_of_the_modes(plate):
    s = solve(plate.model, 5)
    (held,) = strain_energies(plate, s.vectors, s.eigenvalues)
    assert held[:, 0].sum() == pytest.approx(5.0, rel=1e-6)
