"""Smooth fields over the structure: thickness, modulus, density drift."""

from __future__ import annotations

import numpy as np

from ..hide import Scene
from ..mesh import Floats
from ..truth import Field, Truth
from .cause import Cause, centres, size


def _smooth(scene: Scene, waves: int) -> Floats:
    """Return a smooth random field over the elements, largest absolute value 1, mean near 0."""
    rng, p = scene.rng, centres(scene.mesh)
    u = (p - p.mean(axis=0)) / scene.structure.size
    if waves == 0:
        direction = rng.standard_normal(3) * np.ptp(u, axis=0)
        value = u @ direction
    else:
        value = np.zeros(p.shape[0])
        for _ in range(12):
            k = rng.standard_normal(3) * waves
            value += rng.standard_normal() * np.cos(u @ k * np.pi + rng.uniform(0.0, 2.0 * np.pi))
        value -= value.mean()
    return np.asarray(value / np.max(np.abs(value)))


def _field(scene: Scene, kind: str, what: str, low: float, high: float, waves: int) -> Cause:
    amplitude = size(scene, low, high)
    factor = 1.0 + amplitude * _smooth(scene, waves)
    truth = Truth(fields=(Field(**{what: factor}),))
    return Cause(scene.mesh, {"kind": kind, "amplitude": amplitude}, truth)


def thickness_drift(scene: Scene) -> Cause:
    """Let the thickness drift over the structure."""
    return _field(scene, "thickness_drift", "thickness", 0.003, 0.12, int(scene.rng.integers(2)))


def modulus_drift(scene: Scene) -> Cause:
    """Let the modulus drift over the structure."""
    return _field(scene, "modulus_drift", "modulus", 0.006, 0.25, int(scene.rng.integers(2)))


def density_drift(scene: Scene) -> Cause:
    """Let the mass per volume drift over the structure (paint, insulation, absorbed water)."""
    return _field(scene, "density_drift", "density", 0.006, 0.2, int(scene.rng.integers(2)))


def temperature(scene: Scene) -> Cause:
    """Warm one end: the modulus falls there, and with it everywhere a little."""
    drop = size(scene, 0.004, 0.15)
    factor = 1.0 - drop * 0.5 * (1.0 + _smooth(scene, 0))
    return Cause(scene.mesh, {"kind": "temperature", "drop": drop}, Truth(fields=(Field(factor),)))


def scattered(scene: Scene) -> Cause:
    """Let modulus and density differ from element to element, in patches of a few each."""
    amplitude = size(scene, 0.01, 0.3)
    stiff, dense = (1.0 + amplitude * w * _smooth(scene, 6) for w in (1.0, 0.4))
    return Cause(
        scene.mesh,
        {"kind": "scattered", "amplitude": amplitude},
        Truth(fields=(Field(stiff, 1.0, dense),)),
    )
