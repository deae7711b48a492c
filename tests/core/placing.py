"""Structures with tests of them in frames of their own."""

from itertools import pairwise

import numpy as np
from scipy.spatial.transform import Rotation

from trueup.core.data.dofs import Dofs
from trueup.core.data.geometry import Geometry
from trueup.core.data.modes import Modes
from trueup.core.sensors.sensor_map import observe

FRAME = Rotation.from_euler("xyz", [25.0, -40.0, 110.0], degrees=True).as_matrix()
FLIPS = [[90, 0, 0], [0, 0, 180], [180, 5, 90]]
SHIFT = np.array([0.3, -2.0, 0.7])


def is_identity(move):
    """Whether nothing moves, a change of unit apart."""
    return np.array_equal(move.rotation, np.eye(3)) and not move.translation.any()


def angle_deg(move):
    return np.degrees(Rotation.from_matrix(move.rotation).magnitude())


def geometry(xyz, unit="mm", **elements):
    xyz = np.asarray(xyz, float)
    return Geometry(np.arange(1, len(xyz) + 1), xyz, unit, elements)


def grid_of_quads(k):
    return np.stack([k[:-1, :-1], k[1:, :-1], k[1:, 1:], k[:-1, 1:]], axis=-1).reshape(-1, 4)


def panel(nx=18, ny=12, lx=900.0, ly=600.0):
    x, y = np.meshgrid(np.linspace(0, lx, nx + 1), np.linspace(0, ly, ny + 1), indexing="ij")
    k = np.arange(x.size).reshape(x.shape)
    return geometry(np.stack([x, y, 0 * x], axis=-1).reshape(-1, 3), quad=grid_of_quads(k))


def cylinder(around=48, along=12, radius=300.0, height=700.0):
    phi = 2 * np.pi * np.arange(around) / around
    xyz = [
        [radius * np.cos(a), radius * np.sin(a), h]
        for h in np.linspace(0, height, along + 1)
        for a in phi
    ]
    k = np.arange(around * (along + 1)).reshape(along + 1, around)
    return geometry(xyz, quad=grid_of_quads(np.concatenate([k, k[:, :1]], axis=1)))


def bracket():
    """A lopsided frame of beams with a plate on it: fits in one position only."""
    joints = np.array([[0, 0, 0], [400, 0, 0], [400, 250, 0], [400, 250, 600], [90, 0, 330.0]])
    members = [(0, 1), (1, 2), (2, 3), (0, 4), (4, 3)]
    xyz, lines = [*joints], []
    for a, b in members:
        inner = [joints[a] + (joints[b] - joints[a]) * s for s in np.linspace(0, 1, 7)[1:-1]]
        rows = [a, *range(len(xyz), len(xyz) + 5), b]
        xyz += inner
        lines += list(pairwise(rows))
    n = len(xyz)
    x, y = np.meshgrid(np.linspace(0, 400, 6), np.linspace(0, 250, 5), indexing="ij")
    k = n + np.arange(30).reshape(6, 5)
    xyz = np.vstack([xyz, np.stack([x, y, 0 * x], axis=-1).reshape(-1, 3)])
    return geometry(xyz, line=np.array(lines), quad=grid_of_quads(k))


def points_on(geo, n, seed=0):
    """Random points on the elements, (n, 3), evenly by element."""
    rng = np.random.default_rng(seed)
    out = []
    for corners in geo.elements.values():
        share = max(8, n * len(corners) // sum(len(c) for c in geo.elements.values()))
        w = rng.dirichlet(np.ones(corners.shape[1]), share)
        out.append(np.einsum("nc,ncx->nx", w, geo.xyz[rng.choice(corners, share)]))
    return np.concatenate(out)[:n]


def measured(xyz, frame=FRAME, shift=SHIFT, noise=1.0, seed=1):
    """Test nodes in metres, in a frame of their own, with position noise in mm."""
    noisy = xyz + np.random.default_rng(seed).normal(0, noise, xyz.shape)
    return Geometry(np.arange(len(xyz)) + 101, noisy / 1000 @ frame.T + shift, "m")


def wavy(xyz, hz, waves, normals):
    """Modes of bending waves a(x) normal with rotations left out, on three dofs a grid."""
    shapes = np.stack([(w(xyz)[:, None] * normals(xyz)).ravel() for w in waves], axis=1)
    n = len(xyz)
    return Modes(hz, shapes, Dofs(np.repeat(np.arange(1, n + 1), 3), np.tile([1, 2, 3], n)))


def read_test(modes, geo, xyz, test, normals, frame=FRAME, noise=0.02, seed=2):
    """Read modes at positions `xyz` along the normals, with noise, as a test in its own frame."""
    axis = normals(xyz)
    clean = geometry(xyz)
    sensors = Dofs(clean.ids, np.full(len(xyz), 3), axis)
    values = observe(geo, modes.dofs, clean, sensors).matrix @ modes.shapes
    values = values + noise * values.std(axis=0) * np.random.default_rng(seed).normal(
        size=values.shape
    )
    return Modes(
        modes.frequencies_hz * 1.01, values, Dofs(test.ids, sensors.component, axis @ frame.T)
    )


def up(xyz):
    return np.tile([0.0, 0.0, 1.0], (len(xyz), 1))


def radial(xyz):
    flat = xyz * [1, 1, 0]
    return flat / np.linalg.norm(flat, axis=1)[:, None]


def plate_modes(geo, lopsided=0.15):
    """Waves on a panel with a heavier corner: no two of its four positions are alike."""

    def wave(i, j):
        def w(x):
            s, t = x[:, 0] / 900, x[:, 1] / 600
            warp = lopsided * s * t
            return np.cos(i * np.pi * (s + warp)) * np.cos(j * np.pi * (t - warp))

        return w

    pairs = [(1, 1), (2, 0), (0, 2), (2, 1), (1, 2), (3, 1), (2, 2), (3, 0)]
    return wavy(geo.xyz, [20, 32, 41, 55, 66, 83, 95, 110.0], [wave(*p) for p in pairs], up)


def duct_modes(geo, bump=0.0):
    """Pairs of circumferential waves; a bump at 50 degrees takes the symmetry away."""
    waves, hz = [], []
    for n in (2, 3, 4, 5):
        for phase in (0, np.pi / 2):

            def w(x, n=n, phase=phase):
                phi = np.arctan2(x[:, 1], x[:, 0])
                local = np.exp(-((((phi - 0.87 + np.pi) % (2 * np.pi) - np.pi) / 0.5) ** 2))
                return (1 + bump * local) * np.cos(n * phi + phase) * (1 + 0.3 * x[:, 2] / 700)

            waves.append(w)
            hz.append(30.0 * n**1.5)
    return wavy(geo.xyz, hz, waves, radial)


def error_of(found, test, xyz):
    """Root mean square distance of the moved test nodes from where they truly are."""
    return np.sqrt(((found.apply(test.xyz) - xyz) ** 2).sum(axis=1).mean())


def sensors_of_panel():
    x, y = np.meshgrid([60, 250, 430, 640, 830.0], [50, 180, 330, 440, 560.0], indexing="ij")
    jitter = np.random.default_rng(4).uniform(-30, 30, (25, 2))
    return np.column_stack([np.stack([x.ravel(), y.ravel()], axis=1) + jitter, np.zeros(25)])
