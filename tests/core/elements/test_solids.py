"""Solids: rigid bodies, patch tests, bending, mass."""

import math

import numpy as np
import pytest
from tests.core.elements.plates_and_volumes import volume

from trueup.core.elements.volumes.hexa import HEXA8, HEXA20
from trueup.core.elements.volumes.penta import PENTA6, PENTA15
from trueup.core.elements.volumes.pointed import PYRAMID5, PYRAMID13, TETRA4, TETRA10
from trueup.core.elements.volumes.solid import isotropic_solid, rotate_material, solid_mass, strains

SQUARE = np.array([[0, 0], [1, 0], [1, 1], [0, 1]], dtype=float)
TRIANGLE = SQUARE[[0, 1, 3]]


def extruded(face):
    zero = np.zeros(len(face))
    return np.concatenate([np.column_stack([face, zero]), np.column_stack([face, zero + 1])])


CORNERS = {
    "hexa": extruded(SQUARE),
    "penta": extruded(TRIANGLE),
    "tetra": np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]], dtype=float),
    "pyramid": np.concatenate([extruded(SQUARE)[:4], [[0.4, 0.6, 1.0]]]),
}
VOLUME = {"hexa": 1.0, "penta": 0.5, "tetra": 1 / 6, "pyramid": 1 / 3}
ALL = [
    ("hexa", HEXA8, HEXA8.stiffness),
    ("hexa", HEXA20, HEXA20.stiffness),
    ("penta", PENTA6, PENTA6.stiffness),
    ("penta", PENTA15, PENTA15.stiffness),
    ("tetra", TETRA4, TETRA4.stiffness),
    ("tetra", TETRA10, TETRA10.stiffness),
    ("pyramid", PYRAMID5, PYRAMID5.stiffness),
    ("pyramid", PYRAMID13, PYRAMID13.stiffness),
]
NAMES = [f"{kind}{solid.nodes}" for kind, solid, _ in ALL]
STEEL = isotropic_solid(2.0e5, 0.3)


def nodes(kind, solid, distortion=0.0, seed=0):
    rng = np.random.default_rng(seed)
    corner = CORNERS[kind] + distortion * rng.uniform(-1, 1, CORNERS[kind].shape)
    middle = [0.5 * (corner[i] + corner[j]) for i, j in solid.edges]
    return np.concatenate([corner, middle]) if middle else corner


@pytest.mark.parametrize(("kind", "solid", "stiffness"), ALL, ids=NAMES)
@pytest.mark.parametrize("distortion", [0.0, 0.12])
def test_six_rigid_motions_and_no_more(structure, kind, solid, stiffness, distortion):
    xyz = nodes(kind, solid, distortion)
    K = stiffness(xyz[None], STEEL)[0]
    R = structure.rigid_motions(xyz, rotations=False)
    assert np.abs(K @ R).max() < 1e-12 * np.abs(K).max()
    values = np.linalg.eigvalsh(K)
    assert np.abs(values[:6]).max() < 1e-13 * values[-1]
    assert values[6] > 1e-4 * values[-1]


@pytest.mark.parametrize(("kind", "solid", "stiffness"), ALL, ids=NAMES)
def test_forces_of_constant_stress(kind, solid, stiffness):
    """What a skewed and tapered element passes on to its neighbours; a wedge see below."""
    gradient = np.array([[1.0, 0.3, -0.2], [0.1, -0.5, 0.4], [0.2, 0.6, 0.7]])
    e = 0.5 * (gradient + gradient.T)
    stress = STEEL[0] @ [e[0, 0], e[1, 1], e[2, 2], 2 * e[0, 1], 2 * e[1, 2], 2 * e[2, 0]]
    xyz = nodes(kind, solid, 0.12, seed=3)
    points, weights = solid.rules["full"]
    B, detJ = strains(xyz[None], solid.interpolation, points)
    exact = np.einsum("m,mij,i->j", detJ[0] * weights, B[0], stress)
    for integration in ("full",) if solid is PENTA6 else solid.integrations:
        force = stiffness(xyz[None], STEEL, integration)[0] @ (xyz @ gradient.T).ravel()
        assert np.abs(force - exact).max() < 1e-13 * np.abs(exact).max()


@pytest.mark.parametrize(
    ("shape", "limit"),
    [("in plan", 1e-13), ("skewed", 1e-13), ("tapered", 1e-3), ("inner grid moved", 2e-2)],
)
def test_wedge_patch(shape, limit):
    """Force at the inner grid beside those at the others; not zero where wedges taper."""
    k, j, i = np.indices((3, 3, 3)).reshape(3, -1) / 2
    points, move = np.column_stack([i, j, k]), np.random.default_rng(0).uniform(-0.1, 0.1, (9, 2))
    if shape == "in plan":
        points[:, :2] += np.tile(move, (3, 1))
    elif shape == "skewed":
        points[:, 0] += 0.5 * points[:, 2]
    elif shape == "tapered":
        points[:, :2] *= 1.0 - 0.3 * points[:, 2:]
    else:
        points[13] += 0.1
    low = np.array([c + 3 * r + 9 * layer for layer in (0, 1) for r in (0, 1) for c in (0, 1)])
    ring = low[:, None] + np.array([[0, 1, 4], [0, 4, 3]])[:, None]
    conn = np.concatenate([ring, ring + 9], axis=2).reshape(-1, 6)
    u = points @ np.array([[1.0, 0.5, 0.5], [0.5, 1.0, 0.5], [0.5, 0.5, 1.0]])
    Ke = PENTA6.stiffness(points[conn], np.repeat(STEEL, len(conn), 0))
    force = np.zeros((27, 3))
    np.add.at(force, conn, np.einsum("nij,nj->ni", Ke, u[conn].reshape(-1, 18)).reshape(-1, 6, 3))
    assert np.abs(force[13]).max() < limit * np.abs(force).max()


# the inner cube of MacNeal and Harder's patch of seven bricks
LOW = [[0.249, 0.342, 0.192], [0.826, 0.288, 0.288], [0.850, 0.649, 0.263], [0.273, 0.750, 0.230]]
HIGH = [[0.320, 0.186, 0.643], [0.677, 0.305, 0.683], [0.788, 0.693, 0.644], [0.165, 0.745, 0.702]]
FACES = ([0, 1, 2, 3], [4, 5, 6, 7], [0, 1, 5, 4], [1, 2, 6, 5], [2, 3, 7, 6], [3, 0, 4, 7])


@pytest.mark.parametrize("integration", ["bubble", "reduced", "full"])
def test_brick_patch(structure, integration):
    points = np.concatenate([CORNERS["hexa"], LOW, HIGH])
    conn = [list(range(8, 16))]
    for face in FACES:
        brick = [*face, *(i + 8 for i in face)]
        outward = volume(HEXA8, points[brick][None])[0] > 0
        conn.append(brick if outward else [*brick[4:], *brick[:4]])
    conn = np.array(conn)
    assert volume(HEXA8, points[conn]).sum() == pytest.approx(1.0)
    x, y, z = points.T
    exact = 1e-3 * np.column_stack([2 * x + y + z, x + 2 * y + z, x + y + 2 * z]) / 2
    Ke = HEXA8.stiffness(points[conn], np.repeat(isotropic_solid(1e6, 0.25), 7, 0), integration)
    K = structure.assemble(16, conn, Ke, 3)
    u = structure.solve(K, np.zeros(48), np.arange(24), exact[:8].ravel())
    assert u.reshape(16, 3) == pytest.approx(exact, abs=1e-9)


def bar_of_bricks(kind, n=6):
    x = np.linspace(0, 6, n + 1)
    shift = {
        "rectangles": np.zeros(7),
        "trapezoids": 0.1 * np.array([0, 1, -1, 1, -1, 1, 0]),
        "parallelograms": 0.1 * np.array([0, 1, 1, 1, 1, 1, 0]),
    }[kind]
    rows = [
        np.column_stack([x + side * shift, np.full(7, y), np.full(7, z)])
        for z in (0.0, 0.1)
        for side, y in ((-1, 0.0), (1, 0.2))
    ]
    i = np.arange(n)
    face = [i, i + 1, i + 8, i + 7]
    return np.concatenate(rows), np.stack([*face, *(j + 14 for j in face)], axis=1)


@pytest.mark.parametrize(
    ("kind", "in_plane", "out_of_plane"),
    [("rectangles", 0.98, 0.98), ("parallelograms", 0.624, 0.57), ("trapezoids", 0.047, 0.030)],
)
def test_bricks_bend_as_in_the_paper(structure, kind, in_plane, out_of_plane):
    """MacNeal and Harder's straight beam; HEXA(8) there: 0.978, 0.624, 0.047 in the plane."""
    points, conn = bar_of_bricks(kind)
    Ke = HEXA8.stiffness(points[conn], np.repeat(isotropic_solid(1e7, 0.3), 6, 0))
    K = structure.assemble(28, conn, Ke, 3)
    fixed = np.flatnonzero(np.repeat(np.arange(28) % 7 == 0, 3))
    tip = np.array([6, 13, 20, 27])
    for direction, target, share in (
        (0, 3e-5, 0.99),
        (1, 0.1081, in_plane),
        (2, 0.4321, out_of_plane),
    ):
        f = np.zeros(84)
        f[3 * tip + direction] = 0.25
        u = structure.solve(K, f, fixed)
        assert u[3 * tip + direction].mean() / target == pytest.approx(share, abs=0.012)


def test_brick_locks_only_with_full_integration(structure):
    points, conn = bar_of_bricks("rectangles")
    fixed = np.flatnonzero(np.repeat(np.arange(28) % 7 == 0, 3))
    tip = np.array([6, 13, 20, 27])
    f = np.zeros(84)
    f[3 * tip + 2] = 0.25
    C = np.repeat(isotropic_solid(1e7, 0.3), 6, 0)
    deflection = {}
    for integration in ("bubble", "reduced", "full"):
        K = structure.assemble(28, conn, HEXA8.stiffness(points[conn], C, integration), 3)
        deflection[integration] = structure.solve(K, f, fixed)[3 * tip + 2].mean() / 0.4321
    assert deflection["full"] < 0.1
    assert 0.6 < deflection["reduced"] < 0.9
    assert deflection["bubble"] > 0.97


@pytest.mark.parametrize("nu", [0.0, 0.3])
def test_second_order_solids_bend_exactly(structure, nu):
    """A prismatic bar in pure bending, whose displacements are quadratic."""
    E = 1e5
    for kind, solid, stiffness in ALL:
        if solid.nodes not in (20, 15, 10):
            continue
        xyz = nodes(kind, solid)
        x, y, z = xyz.T
        u = np.column_stack([x * z, -nu * y * z, -(x**2) / 2 + nu * (y**2 - z**2) / 2]).ravel()
        K = stiffness(xyz[None], isotropic_solid(E, nu))[0]
        second_moment = {"hexa": 1 / 3, "penta": 1 / 6, "tetra": 1 / 60}[kind]
        assert u @ K @ u == pytest.approx(E * second_moment, rel=1e-9)


@pytest.mark.parametrize(("kind", "solid", "_"), ALL, ids=NAMES)
@pytest.mark.parametrize("coupled", [False, True])
def test_mass(structure, kind, solid, _, coupled):
    xyz = nodes(kind, solid)
    M = solid_mass(solid, xyz[None], np.array([7.0]), coupled)[0]
    R = structure.rigid_motions(xyz, rotations=False)[:, :3]
    total = R.T @ M @ R
    assert total == pytest.approx(7.0 * VOLUME[kind] * np.eye(3), abs=1e-12)
    assert np.linalg.eigvalsh(M)[0] > 0 or (solid.edges.size and not coupled)
    if not coupled:
        assert np.count_nonzero(M - np.diag(np.diag(M))) == 0


@pytest.mark.parametrize(("kind", "solid", "stiffness"), ALL, ids=NAMES)
def test_anisotropic_material_turns_with_the_body(structure, kind, solid, stiffness):
    rng = np.random.default_rng(3)
    square = rng.standard_normal((6, 6))
    C = (square @ square.T + 5 * np.eye(6))[None]
    R = np.linalg.qr(rng.standard_normal((3, 3)))[0]
    R *= np.linalg.det(R)
    xyz = nodes(kind, solid, 0.05)
    K = stiffness(xyz[None], C)[0]
    turned = stiffness((xyz @ R.T)[None], rotate_material(C, R.T[None]))[0]
    T = np.kron(np.eye(solid.nodes), R)
    assert turned == pytest.approx(T @ K @ T.T, abs=1e-10 * np.abs(K).max())


def test_inside_out_brick_has_negative_volume():
    xyz = CORNERS["hexa"][[4, 5, 6, 7, 0, 1, 2, 3]]
    assert volume(HEXA8, xyz[None])[0] == pytest.approx(-1.0)


def test_the_five_points_of_the_tetrahedron_are_exact_to_third_order():
    """Nastran's rule: on straight edges it sees what any better one does."""
    points, weights = TETRA10.rules["full"]
    for powers in ((0, 0, 0), (1, 0, 0), (1, 1, 1), (2, 1, 0), (3, 0, 0)):
        exact = np.prod([math.factorial(k) for k in powers]) / math.factorial(3 + sum(powers))
        assert weights @ np.prod(points ** np.array(powers), axis=1) == pytest.approx(exact)


@pytest.mark.parametrize("solid", [HEXA20, PENTA15, TETRA10], ids=["hexa", "penta", "tetra"])
def test_lumped_mass_stands_at_the_middle_nodes(solid):
    """As in MSC Nastran, whose modes of a pair of ten-node tetrahedra it makes."""
    kind = {20: "hexa", 15: "penta", 10: "tetra"}[solid.nodes]
    m = np.diag(solid_mass(solid, nodes(kind, solid)[None], np.ones(1), False)[0])[::3]
    corners = solid.nodes - len(solid.edges)
    assert not m[:corners].any()
    assert (m[corners:] > 0.0).all()
