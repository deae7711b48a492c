"""A sensor, or a set of two or three, turned on its node."""

from collections.abc import Callable

import numpy as np
from scipy.spatial.transform import Rotation
from scipy.special import logsumexp

from ...arrays import Floats
from .sensor_numbers import SENSORS


def rotation(vector: Floats) -> Floats:
    """Return the rotation matrix of a rotation vector (3,) [rad], (3, 3), or of several."""
    return np.asarray(Rotation.from_rotvec(vector).as_matrix())


def maps_of(axes: Floats, Q: Floats) -> Floats:
    """Return what sensors along `axes` (k, 3), turned by Q (n, 3, 3), read, (n, k, k + 3)."""
    k = len(axes)
    return np.concatenate([np.zeros((len(Q), k, k)), axes @ np.swapaxes(Q, 1, 2)], axis=2)


Evidence = Callable[[Floats], Floats]
"""From maps (n, k, k + 3) to log likelihoods (n,)."""


def about(axes: Floats, axis: Floats, of: Evidence) -> tuple[float, Floats, float]:
    """Turn about one axis: log evidence, rotation vector, deviation of the angle [rad].

    Every angle but the smallest is as likely before as any other.
    """
    step = np.radians(SENSORS.angle_step)
    angle = np.arange(-np.pi + step, np.pi + 0.5 * step, step)
    angle = angle[np.abs(angle) > np.radians(SENSORS.angle_least)]
    log = of(maps_of(axes, rotation(angle[:, None] * axis)))
    best = float(angle[np.argmax(log)])
    weight = np.exp(log - log.max())
    off = (angle - best + np.pi) % (2.0 * np.pi) - np.pi
    spread = float(np.sqrt(np.sum(weight * off**2) / weight.sum() + step**2 / 12.0))
    sure = spread < SENSORS.angle_unsure
    mean = best + float(np.sum(weight * off) / weight.sum()) if sure else best
    return float(logsumexp(log) - np.log(len(angle))), mean * np.asarray(axis), spread


def anyhow(axes: Floats, start: Floats, of: Evidence) -> tuple[float, Floats, float] | None:
    """Turn in space: as `about`, by Laplace's approximation, all rotations as likely before.

    `start` (3, 3) is a rotation near the best; None where the readings do not hold the rotation.
    """
    Q, h = start, SENSORS.turn_step
    steps = h * np.array([[0, 0, 0], *np.eye(3), *-np.eye(3)])
    pairs = [(0, 1), (0, 2), (1, 2)]
    mixed = [
        s * np.eye(3)[a] + t * np.eye(3)[b] for a, b in pairs for s in (1, -1) for t in (1, -1)
    ]
    steps = np.vstack([steps, h * np.array(mixed)])
    for _ in range(SENSORS.turn_rounds):
        f = of(maps_of(axes, rotation(steps) @ Q))
        g = (f[1:4] - f[4:7]) / (2.0 * h)
        H = np.diag((f[1:4] + f[4:7] - 2.0 * f[0]) / h**2)
        for n, (a, b) in enumerate(pairs):
            q = f[7 + 4 * n : 11 + 4 * n]
            H[a, b] = H[b, a] = (q[0] - q[1] - q[2] + q[3]) / (4.0 * h**2)
        values = np.linalg.eigvalsh(-H)
        if values[0] < SENSORS.turn_curved:
            return None
        step = np.linalg.solve(-H, g)
        Q = rotation(np.clip(step, -SENSORS.turn_most, SENSORS.turn_most)) @ Q
        if np.abs(step).max() < SENSORS.turn_done * h:
            break
    best = float(of(maps_of(axes, Q[None]))[0])
    vector = np.asarray(Rotation.from_matrix(Q).as_rotvec())
    along = vector / max(float(np.linalg.norm(vector)), np.finfo(float).tiny)
    log = best + 1.5 * np.log(2.0 * np.pi) - 0.5 * np.log(values).sum() - np.log(8.0 * np.pi**2)
    return float(log), vector, float(np.sqrt(along @ np.linalg.solve(-H, along)))


def tilted(axis: Floats, of: Evidence) -> tuple[float, Floats, float]:
    """Turn one sensor away from its axis: as `about`; all directions as likely before."""
    other = np.eye(3)[np.argmin(np.abs(axis))]
    a = np.cross(axis, other)
    a /= np.linalg.norm(a)
    b = np.cross(axis, a)
    cosine = (np.arange(SENSORS.tilts) + 0.5) * 2.0 / SENSORS.tilts - 1.0
    tilt, way = np.meshgrid(
        np.arccos(cosine), 2.0 * np.pi * np.arange(SENSORS.ways) / SENSORS.ways, indexing="ij"
    )
    vector = tilt[..., None] * (np.cos(way)[..., None] * a + np.sin(way)[..., None] * b)
    least = np.radians(SENSORS.angle_least)
    kept = (tilt > least) & (tilt < np.pi - least)
    vector, tilt = vector[kept], tilt[kept]
    log = of(maps_of(axis[None], rotation(vector)))
    weight = np.exp(log - log.max())
    weight /= weight.sum()
    mean = float(np.sum(weight * tilt))
    best = vector[np.argmax(log)]
    step = float(np.median(np.diff(np.arccos(cosine))))
    spread = float(np.sqrt(np.sum(weight * (tilt - mean) ** 2) + step**2 / 12.0))
    return float(logsumexp(log) - np.log(len(log))), best / np.linalg.norm(best) * mean, spread
