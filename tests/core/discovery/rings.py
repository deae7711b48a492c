"""A ring of 40 nodes in closed form, and the test of a ring that its model does not have right.

A thin inextensible ring moves by cos nθ or sin nθ along its radius and by ∓ the same, a quarter
of a wave on and n times less, along its rim (Love, *Mathematical Theory of Elasticity*, § 293).
"""

import numpy as np

from trueup.core.discovery.sensor_faults.diagnosis import judge_sensors
from trueup.core.discovery.sensor_faults.leave_one_out import Span, Survey

ANGLE = np.linspace(0.0, 2.0 * np.pi, 40, endpoint=False)
WAVES = np.repeat(np.arange(2, 9), 2)
HZ = 20.0 * WAVES**1.5
RADIAL = np.column_stack([np.cos(ANGLE), np.sin(ANGLE), np.zeros(40)])
ALONG = np.column_stack([-np.sin(ANGLE), np.cos(ANGLE), np.zeros(40)])


def ring():
    """Motion of every node in space, (40, 3, 14)."""
    phase = ANGLE[:, None] * WAVES - np.where(np.arange(14) % 2, np.pi / 2.0, 0.0)
    out, around = np.cos(phase), -np.sin(phase) / WAVES
    return RADIAL[:, :, None] * out[:, None] + ALONG[:, :, None] * around[:, None]


def vibrating(seed=0):
    """Modes of a ring that the model does not have right: neighbours mixed, (40, 3, 14)."""
    rng = np.random.default_rng(seed)
    apart = np.abs(np.subtract.outer(np.arange(14), np.arange(14)))
    return ring() @ (np.eye(14) + 0.15 * rng.normal(size=(14, 14)) * np.exp(-apart))


def read(motion, axes, noise=0.02, seed=0):
    """Readings of sensors along axes (40, k, 3), (40, k, 14)."""
    shapes = np.einsum("nkx,nxm->nkm", axes, motion)
    scatter = np.random.default_rng([seed, 1]).normal(size=shapes.shape)
    return shapes + noise * np.sqrt(np.mean(shapes**2, axis=(0, 1))) * scatter


def radial():
    """One sensor a node, looking along the radius."""
    return RADIAL[:, None, :].copy()


def planar():
    """Two sensors a node, along x and y."""
    return np.tile(np.eye(3)[:2], (40, 1, 1))


def survey(readings, axes, errors=None):
    """Return the test that readings along axes (40, k, 3) make, and the model's motion there."""
    k = axes.shape[1]
    motion = np.einsum("nkx,nxm->nkm", axes, ring())
    test = Survey(
        readings.reshape(40 * k, -1),
        HZ,
        np.repeat(np.arange(101, 141), k),
        np.tile(np.arange(1, k + 1), 40),
        axes.reshape(-1, 3),
        np.repeat(100.0 * RADIAL, k, axis=0),
        errors,
    )
    return test, Span(motion.reshape(40 * k, -1), ring(), HZ)


def judged(readings, axes):
    """Judge readings by the model of the ring."""
    return judge_sensors(*survey(readings, axes))
