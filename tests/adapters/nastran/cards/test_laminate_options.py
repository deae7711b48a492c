"""What LAM of PCOMP and PCOMPG asks for, against the same laminate written out."""

import numpy as np
import pytest

from trueup.adapters.nastran import build_model, read_deck
from trueup.core.errors import InputError

PLATE = """\
GRID,1,,0.,0.,0.
GRID,2,,1.,0.,0.
GRID,3,,1.1,.9,0.
GRID,4,,0.,1.,0.
CQUAD4,1,7,1,2,3,4
MAT8,1,1.4+11,9.+9,.3,5.+9,5.+9,3.+9,1600.
MAT8,2,6.+10,5.+10,.1,4.+9,4.+9,4.+9,1500.
MAT8,3,1.+7,1.+7,.2,1.+6,2.+8,1.+8,50.
MAT1,4,7.+10,,.3,2700.
"""


def matrices(tmp_path, *cards):
    path = tmp_path / "a.bdf"
    path.write_text(PLATE + "\n".join(cards) + "\n")
    model = build_model(read_deck(path))
    return model.K().toarray(), model.M().toarray()


@pytest.mark.parametrize("faces", [(1, 2), (2, 1)])
def test_a_smeared_sandwich_has_half_of_its_faces_on_each_side(tmp_path, faces):
    a, b = (f"{face},.002,0.,NO" for face in faces)
    sandwich = matrices(tmp_path, f"PCOMP,7,,,,,,,SMCORE\n,{a},{b}", ",3,.02,0.,NO")
    # one material that is the mean of both faces: reduced stiffnesses add
    q = [np.array([1.4e11, 9e9, 0.3]), np.array([6e10, 5e10, 0.1])]
    mean = []
    for e1, e2, nu in q:
        d = 1.0 - nu * nu * e2 / e1
        mean.append(np.array([e1 / d, nu * e2 / d, e2 / d]))
    q11, q12, q22 = np.mean(mean, axis=0)
    nu = q12 / q22
    d = 1.0 - nu * q12 / q11
    face = f"MAT8*,5,{q11 * d:.9E},{q22 * d:.9E},{nu:.9E}\n*,4.5+9,4.5+9,3.5+9,1550."
    written = matrices(tmp_path, face, "PCOMP,7\n,5,.002,0.,NO,3,.02,0.,NO\n,5,.002,0.,NO")
    for x, y in zip(sandwich, written, strict=True):
        np.testing.assert_allclose(x, y, rtol=0, atol=1e-8 * np.abs(y).max())


def test_a_smeared_laminate_is_a_plate_that_does_not_shear(tmp_path):
    smeared = matrices(tmp_path, "PCOMP,7,,,,,,,SMEAR\n,4,.05,0.,NO,4,.03,30.,NO")
    plate = matrices(tmp_path, "PSHELL,7,4,.08,4")
    sheared = matrices(tmp_path, "PSHELL,7,4,.08,4,,4")
    for x, y in zip(smeared, plate, strict=True):
        np.testing.assert_allclose(x, y, rtol=0, atol=1e-12 * np.abs(y).max())
    assert not np.allclose(plate[0], sheared[0], rtol=0, atol=1e-3 * np.abs(plate[0]).max())


def test_a_core_alone_is_no_sandwich(tmp_path):
    with pytest.raises(InputError, match=r"PCOMP 7 .*SMCORE needs plies of the faces"):
        matrices(tmp_path, "PCOMP,7,,,,,,,SMCORE\n,3,.02,0.,NO")
