"""Sets of rigid moves and small motions of them."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.spatial.transform import Rotation

from ..arrays import Floats, Ints


@dataclass(frozen=True, eq=False)
class Poses:
    """Rigid moves x = rotation @ p + translation and how well they fit.

    Parameters
    ----------
    rotation : (k, 3, 3) float
    translation : (k, 3) float
    rms : (k,) float
        Root mean square distance of the points from the surface, each at most `rigid_fit.CAP` of
        its size.
    """

    rotation: Floats
    translation: Floats
    rms: Floats

    def __len__(self) -> int:
        return len(self.rms)

    def take(self, rows: Ints) -> Poses:
        """Return the poses of the given rows (indices or mask)."""
        return Poses(self.rotation[rows], self.translation[rows], self.rms[rows])

    def apply(self, points: Floats) -> Floats:
        """Move points (n, 3) by every pose, (k, n, 3)."""
        return np.asarray(
            np.einsum("kij,nj->kni", self.rotation, points) + self.translation[:, None]
        )

    @staticmethod
    def joined(parts: list[Poses]) -> Poses:
        """Return the poses of all parts, in turn."""
        return Poses(
            np.concatenate([p.rotation for p in parts]),
            np.concatenate([p.translation for p in parts]),
            np.concatenate([p.rms for p in parts]),
        )


def jacobian(x: Floats, centre: Floats, radius: Floats) -> Floats:
    """Motion of points (k, n, 3) by six scaled rigid motions about the centres, (k, n, 3, 6).

    First three turns, then three shifts; `radius` (k,) makes a turn of one move a point at that
    radius by one.
    """
    a = (x - centre[:, None]) / radius[:, None, None]
    J = np.zeros((*x.shape, 6))
    J[..., 0, 1], J[..., 0, 2], J[..., 1, 2] = a[..., 2], -a[..., 1], a[..., 0]
    J[..., 1, 0], J[..., 2, 0], J[..., 2, 1] = -a[..., 2], a[..., 1], -a[..., 0]
    J[..., [0, 1, 2], [3, 4, 5]] = 1.0
    return J


def centre_and_radius(x: Floats) -> tuple[Floats, Floats]:
    """Centre (k, 3) and rms radius (k,) of moved points (k, n, 3)."""
    centre = x.mean(axis=1)
    radius = np.sqrt(((x - centre[:, None]) ** 2).sum(axis=2).mean(axis=1))
    return centre, np.where(radius > 0, radius, 1.0)


def move(
    R: Floats, t: Floats, centre: Floats, turn: Floats, shift: Floats
) -> tuple[Floats, Floats]:
    """Turn poses about their centres by rotation vectors (k, 3), then shift them (k, 3)."""
    D = Rotation.from_rotvec(turn).as_matrix()
    return D @ R, np.einsum("kij,kj->ki", D, t - centre) + centre + shift


def displaced(pose: Poses, centre: Floats, radius: Floats, motions: Floats) -> Poses:
    """Follow scaled rigid motions (k, 6) about a centre (1, 3) from one pose for a unit of time.

    A turn with a shift is a screw: a turn about an axis beside the centre stays about that axis.
    """
    k = len(motions)
    turn = motions[:, :3] / radius
    shift = np.einsum("kij,kj->ki", _screw(turn), motions[:, 3:])
    R, t = move(
        np.repeat(pose.rotation, k, axis=0),
        np.repeat(pose.translation, k, axis=0),
        centre,
        turn,
        shift,
    )
    return Poses(R, t, np.full(k, np.nan))


def motion_between(pose: Poses, others: Poses, centre: Floats, radius: Floats) -> Floats:
    """Scaled motions (k, 6) that `displaced` follows from one pose to the others."""
    turn = Rotation.from_matrix(others.rotation @ pose.rotation[0].T)
    shift = others.translation - (turn.apply(pose.translation[0] - centre[0]) + centre[0])
    vector = turn.as_rotvec().reshape(-1, 3)
    v = np.linalg.solve(_screw(vector), shift[..., None])[..., 0]
    return np.concatenate([vector * radius, v], axis=1)


def _screw(turn: Floats) -> Floats:
    """Left Jacobian of the rotation group at rotation vectors (k, 3): (k, 3, 3)."""
    angle = np.linalg.norm(turn, axis=1)
    small = angle < 1e-4
    a = np.where(small, 1.0, angle)
    first = np.where(small, 0.5, (1 - np.cos(a)) / a**2)
    second = np.where(small, 1 / 6, (a - np.sin(a)) / a**3)
    K = np.zeros((len(turn), 3, 3))
    K[:, 0, 1], K[:, 0, 2], K[:, 1, 2] = -turn[:, 2], turn[:, 1], -turn[:, 0]
    K -= np.swapaxes(K, 1, 2)
    return np.asarray(np.eye(3) + first[:, None, None] * K + second[:, None, None] * (K @ K))
