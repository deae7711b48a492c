"""Second-order solids against CalculiX, which integrates them alike."""

import shutil
import subprocess
from dataclasses import replace

import numpy as np
import pytest

from trueup.core.elements.quadrature import gauss_wedge
from trueup.core.elements.volumes.hexa import HEXA20
from trueup.core.elements.volumes.penta import PENTA15
from trueup.core.elements.volumes.pointed import TETRA10
from trueup.core.elements.volumes.solid import isotropic_solid

CORNERS = {
    20: [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [0, 0, 1], [1, 0, 1], [1, 1, 1], [0, 1, 1]],
    15: [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1], [1, 0, 1], [0, 1, 1]],
    10: [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]],
}
# CalculiX numbers the upright edges of bricks and wedges after both faces
ORDER = {
    20: [*range(12), *range(16, 20), *range(12, 16)],
    15: [*range(9), *range(12, 15), *range(9, 12)],
    10: list(range(10)),
}
NINE_POINTS = replace(PENTA15, rules={"full": gauss_wedge(3, 3)})
KINDS = {20: "C3D20", 15: "C3D15", 10: "C3D10"}


def curved_solid(solid):
    rng = np.random.default_rng(solid.nodes)
    corner = np.array(CORNERS[solid.nodes], dtype=float)
    corner = corner + 0.1 * rng.uniform(-1, 1, corner.shape)
    middle = np.array([0.5 * (corner[i] + corner[j]) for i, j in solid.edges])
    return np.concatenate([corner, middle])


def calculix(folder, xyz, kind, order, E, nu, force):
    n = len(xyz)
    lines = ["*NODE, NSET=ALL"]
    lines += [f"{i + 1}, {x:.15g}, {y:.15g}, {z:.15g}" for i, (x, y, z) in enumerate(xyz)]
    numbers = [1, *(k + 1 for k in order)]
    rows = [", ".join(map(str, numbers[k : k + 10])) for k in range(0, len(numbers), 10)]
    lines += [f"*ELEMENT, TYPE={kind}, ELSET=BODY", ",\n".join(rows)]
    lines += [
        "*MATERIAL, NAME=M",
        "*ELASTIC",
        f"{E}, {nu}",
        "*SOLID SECTION, ELSET=BODY, MATERIAL=M",
    ]
    lines += ["*BOUNDARY", "1, 1, 3", "2, 2, 3", "3, 3, 3", "*STEP", "*STATIC", "*CLOAD"]
    lines += [f"{n}, {d + 1}, {f:.15g}" for d, f in enumerate(force)]
    lines += ["*NODE PRINT, NSET=ALL", "U", "*END STEP"]
    (folder / "one.inp").write_text("\n".join(lines) + "\n")
    subprocess.run(["ccx", "one"], cwd=folder, check=True, capture_output=True, timeout=60)
    u = np.zeros((n, 3))
    for line in (folder / "one.dat").read_text().splitlines():
        words = line.split()
        if len(words) == 4 and words[0].isdigit():
            u[int(words[0]) - 1] = [float(w) for w in words[1:]]
    return u


@pytest.mark.skipif(shutil.which("ccx") is None, reason="CalculiX (ccx) is not installed")
@pytest.mark.parametrize(
    ("solid", "stiffness"),
    [
        (HEXA20, lambda x, C: HEXA20.stiffness(x, C, "full")),
        (TETRA10, TETRA10.stiffness),
        # nine points there, twenty-one in Nastran
        (PENTA15, lambda x, C: NINE_POINTS.stiffness(x, C, "full")),
    ],
    ids=["C3D20", "C3D10", "C3D15"],
)
def test_one_distorted_element(tmp_path, solid, stiffness):
    xyz = curved_solid(solid)
    force = np.array([1.0, -2.0, 3.0])
    K = stiffness(xyz[None], isotropic_solid(1e4, 0.3))[0]
    held = [0, 1, 2, 4, 5, 8]
    free = np.setdiff1d(np.arange(len(K)), held)
    f = np.zeros(len(K))
    f[-3:] = force
    u = np.zeros(len(K))
    u[free] = np.linalg.solve(K[np.ix_(free, free)], f[free])
    theirs = calculix(tmp_path, xyz, KINDS[solid.nodes], ORDER[solid.nodes], 1e4, 0.3, force)
    scale = np.abs(theirs).max()
    assert np.abs(u.reshape(-1, 3) - theirs).max() < 1e-6 * scale
