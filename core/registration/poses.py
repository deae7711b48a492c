"""Sets of rigid moves and small motions of them."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.spatial.transform import Rotation

from ..arrays import Floats, Ints, skew
from .registration_numbers import ALIGN


@dataclass(frozen=True, eq=False)
class Poses:
    """Rigid moves x = rotation @ p + translation and how well they fit.

    Parameters
    ----------
    rotation : (k, 3, 3) float
    translation : (k, 3) float
    rms : (k,) float
        Root mean square distance of the points from the surface, each at most `cap` of
        its size.
    """

    rotation: Floats
    translation: Floats
    rms: Floats

    def __len__(self) -> int:
        return len(self.rms)

    @property
    def angle(self) -> Floats:
        """Angles of the rotations, radians (k,)."""
        return np.asarray(Rotation.from_matrix(self.rotation).magnitude())

    def take(self, rows: Ints) -> Poses:
        """Return the poses of the given rows (indices or mask)."""
        return Poses(self.rotation[rows], self.translation[rows], self.rms[rows])

    def apply(self, points: Floats) -> Floats:
        """Move points (n, 3) by every pose, (k, n, 3)."""
        return np.asarray(
            np.einsum("kij,nj->kni", self.rotation, points) + self.translation[:, None]
        )

    def followed_by(self, other: Poses) -> Poses:
        """Return these poses, then others."""
        return Poses(
            np.concatenate([self.rotation, other.rotation]),
            np.concatenate([self.translation, other.translation]),
            np.concatenate([self.rms, other.rms]),
        )


def jacobian(x: Floats, centre: Floats, radius: Floats) -> Floats:
    """Motion of points (k, n, 3) by six scaled rigid motions about the centres, (k, n, 3, 6).

    First three turns, then three shifts; `radius` (k,) makes a turn of one move a point at that
    radius by one.
    """
    a = (x - centre[:, None]) / radius[:, None, None]
    J = np.zeros((*x.shape, 6))
    J[..., :3] = -skew(a)
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
    R, t = np.repeat(pose.rotation, k, axis=0), np.repeat(pose.translation, k, axis=0)
    return Poses(*move(R, t, centre, turn, shift), np.full(k, np.nan))


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
    small = angle < ALIGN.small_turn
    a = np.where(small, 1.0, angle)
    first = np.where(small, 0.5, (1 - np.cos(a)) / a**2)
    second = np.where(small, 1 / 6, (a - np.sin(a)) / a**3)
    K = skew(turn)
    return np.asarray(np.eye(3) + first[:, None, None] * K + second[:, None, None] * (K @ K))
