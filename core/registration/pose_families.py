"""Poses that fit alike: ways in which a test can slide on its model, and samples along them."""

from dataclasses import dataclass, replace

import numpy as np
from scipy.linalg import block_diag

from ..arrays import Bools, Floats
from ..sensors.outer_surface import Surface
from .poses import Poses, centre_and_radius, displaced, jacobian, motion_between
from .registration_numbers import ALIGN
from .surface_registration import Cloud, polish, rms_of


@dataclass(frozen=True, eq=False)
class Family:
    """A pose and the rigid motions from it that keep the test on the model.

    Parameters
    ----------
    pose : Poses
        One pose.
    centre, radius : (1, 3) and (1,) float
        About which the motions are meant.
    motions : (d, 6) float
        Scaled motions, turns first, each a pure turn or slide where that is possible; a unit
        moves the test by about one length unit.
    turning : (d,) bool
        Which of them turn.
    """

    pose: Poses
    centre: Floats
    radius: Floats
    motions: Floats
    turning: Bools

    def at(self, coordinates: Floats) -> Poses:
        """Poses at coordinates (k, d) along the motions."""
        return displaced(self.pose, self.centre, self.radius, coordinates @ self.motions)

    def axis_of(self, k: int) -> Floats:
        """Direction of a motion, (3,): of the axis of a turn or of a slide."""
        vector = self.motions[k, :3] if self.turning[k] else self.motions[k, 3:]
        return np.asarray(vector / np.linalg.norm(vector))


def family_of(surface: Surface, points: Floats, pose: Poses, limit: float) -> Family:
    """Find how points (n, 3) of a test, in one pose at rest, can slide on the model.

    `limit` is the largest rms distance that still fits.
    """
    centre, radius = centre_and_radius(pose.apply(points))
    free = freedoms(surface, points, pose, ALIGN.free * surface.size, limit)
    for reach in ALIGN.followed:
        free = np.concatenate(_parted(free))
        free = _straightened(surface, points, pose, free, reach, limit)
    turns, slides = _parted(free)
    motions = np.concatenate([turns, slides])
    return Family(pose, centre, radius, motions, np.arange(len(motions)) < len(turns))


def _straightened(
    surface: Surface,
    points: Floats,
    pose: Poses,
    motions: Floats,
    reach: float,
    limit: float,
) -> Floats:
    """Follow each motion for a share of the model's size and settle there: where that led to.

    The way from one resting pose to another that is far off tells an axis much better than the
    surface beside the first. A motion that leads off the model stays as it was.
    """
    if not len(motions):
        return motions
    centre, radius = centre_and_radius(pose.apply(points))
    length = reach * surface.size
    trial = displaced(pose, centre, radius, length * np.concatenate([motions, -motions]))
    rested = polish(surface, points, trial.rotation, trial.translation, rounds=ALIGN.settling)
    found = motion_between(pose, rested, centre, radius) / length
    found[len(motions) :] *= -1
    size = np.linalg.norm(found, axis=1)
    likeness = np.einsum("ki,ki->k", found, np.tile(motions, (2, 1)))
    fits = (rested.rms <= limit) & (size > ALIGN.led_least)
    fits &= likeness > ALIGN.led_along * size
    both = (found * fits[:, None]).reshape(2, *motions.shape).sum(axis=0)
    led = fits.reshape(2, -1).sum(axis=0)
    return np.where(led[:, None] > 0, both / np.maximum(led, 1)[:, None], motions)


def _parted(free: Floats) -> tuple[Floats, Floats]:
    """Turn a basis of motions (d, 6) into turns and pure slides."""
    if not len(free):
        return free, free
    U, strength, _ = np.linalg.svd(free[:, :3], full_matrices=True)
    turning = np.concatenate([strength, np.zeros(len(free))])[: len(free)] > ALIGN.turning
    combined = U.T @ free
    turns, slides = combined[turning], combined[~turning].copy()
    slides[:, :3] = 0.0
    slides /= np.linalg.norm(slides, axis=1, keepdims=True)
    turns = turns / np.linalg.norm(turns[:, :3], axis=1, keepdims=True)
    turns[:, 3:] -= turns[:, 3:] @ slides[:, 3:].T @ slides[:, 3:]
    return turns, slides


def freedoms(surface: Surface, points: Floats, pose: Poses, step: float, limit: float) -> Floats:
    """Rigid motions that keep points in one pose, at rest, on the surface, (d, 6), d from 0 to 6.

    Scaled as in `jacobian`. The points are moved by `step` along and about their principal axes,
    and by any two of these motions at once, and come to rest again: from where they are held they
    go back, and the ways to where else they rest, within the rms distance `limit`, span what is
    free. Slopes would not tell: points at the joints of a frame are held by a whisker in every
    direction, yet slide freely.
    """
    x = pose.apply(points)
    centre, radius = centre_and_radius(x)
    J = jacobian(x, centre, radius)[0, ..., :3]
    value, axes = np.linalg.eigh(np.einsum("nxi,nxj->ij", J, J) / len(points))
    moving = np.append(value >= ALIGN.still, [True] * 3)
    turns = axes / np.sqrt(np.where(moving[:3], value, 1.0))
    motions = block_diag(turns.T, axes.T)
    # A motion that does not move the points (a turn about the line they lie on) is free.
    motions, still = motions[moving], motions[~moving]
    i, j = np.triu_indices(len(motions), 1)
    two = np.concatenate([motions[i] + motions[j], motions[i] - motions[j]]) / np.sqrt(2.0)
    way = step * np.concatenate([motions, two])
    trial = displaced(pose, centre, radius, np.concatenate([way, -way]))
    rested = polish(surface, points, trial.rotation, trial.translation, rounds=ALIGN.settling)
    led = motion_between(pose, rested, centre, radius)[rested.rms <= limit] / step
    _, strength, basis = np.linalg.svd(led @ np.linalg.pinv(motions), full_matrices=False)
    return np.concatenate([still, basis[strength > ALIGN.led_least] @ motions])


def members(family: Family, points: Floats, poses: Poses, surface: Surface) -> Bools:
    """Whether each pose is reached by sliding along a family, (k,) bool."""
    motions = motion_between(family.pose, poses, family.centre, family.radius)
    J = jacobian(family.pose.apply(points), family.centre, family.radius)[0]
    moved = np.einsum("nxi,ki->knx", J, motions)
    flat = moved.reshape(len(poses), -1)
    if len(family.motions):
        free = np.einsum("nxi,di->dnx", J, family.motions).reshape(len(family.motions), -1)
        along = np.linalg.lstsq(free.T, flat.T, rcond=None)[0]
        flat = flat - (free.T @ along).T
    rms = np.sqrt((flat**2).sum(axis=1) / len(points))
    return np.asarray(rms < ALIGN.free * surface.size)


def sampled(cloud: Cloud, points: Floats, family: Family, limit: float) -> Poses:
    """Poses of a family within the rms distance `limit` of points (n, 3), its own pose first.

    About every two degrees of turn and 1 % of the size of slide.
    """
    d = len(family.motions)
    if d == 0:
        return family.pose
    ways = [_feasible(cloud, points, family, k, limit) for k in range(d)]
    count = np.prod([len(way) for way in ways], dtype=float)
    if count <= ALIGN.most_samples:
        coordinates = np.stack(np.meshgrid(*ways, indexing="ij"), axis=-1).reshape(-1, d)
    else:
        where = (_even(ALIGN.most_samples, d) * [len(way) for way in ways]).astype(np.int64)
        coordinates = np.stack([way[i] for way, i in zip(ways, where.T, strict=True)], axis=1)
    poses = family.at(coordinates)
    far = ALIGN.off * limit + cloud.spacing
    near = cloud.rms(poses.rotation, poses.translation, points) < far
    poses = poses.take(np.flatnonzero(near))
    if d == 1:
        poses = polish(
            cloud.surface, points, poses.rotation, poses.translation, rounds=ALIGN.settled
        )
    poses = replace(poses, rms=rms_of(cloud.surface, points, poses))
    return family.pose.followed_by(poses.take(np.flatnonzero(poses.rms <= limit)))


def step_of(family: Family, surface: Surface) -> Floats:
    """Coordinate distance of neighbouring samples along each motion, (d,)."""
    turn = np.radians(ALIGN.turn_step) * family.radius[0]
    slide = ALIGN.slide_step * surface.size
    return np.where(family.turning, turn, slide)


def _feasible(cloud: Cloud, points: Floats, family: Family, k: int, limit: float) -> Floats:
    """Coordinates along one motion at which the test about fits, neighbours included."""
    surface = cloud.surface
    step = step_of(family, surface)[k]
    reach = np.pi * family.radius[0] if family.turning[k] else surface.size
    half = int(reach / step)
    steps = step * np.arange(-half, half + 1 - family.turning[k])
    poses = family.at(steps[:, None] * np.eye(len(family.motions))[k])
    fits = rms_of(surface, points, poses) <= ALIGN.feasible * limit
    fits[half] = True
    fits[1:] |= fits[:-1].copy()
    fits[:-1] |= fits[1:].copy()
    return np.asarray(steps[fits])


def _even(count: int, dimension: int) -> Floats:
    """Evenly spread points of the unit cube (additive recurrence, Roberts 2018), (count, d)."""
    root = 2.0
    for _ in range(30):
        root = (1.0 + root) ** (1.0 / (dimension + 1))
    step = (1.0 / root) ** np.arange(1, dimension + 1)
    return np.asarray((0.5 + np.arange(1, count + 1)[:, None] * step) % 1.0)
