"""What the set-up of a test and the mesh of a deck do to every mode, and no effect is.

A structure that was tested free hung on something: soft springs all over it, more of them here or
there, stand for that. Sensors have a mass, be it that they rove and load one part after another:
what the frequencies of all runs agree on has it everywhere. And lumping makes the modes of a mesh
too low by the square of element over wave, what an element's stiffness gets wrong is another part
of that along and across: the error of a mesh along each of the structure's own axes. Bars
have none, but a test that was made by a model of lumped bars has theirs.
"""

from __future__ import annotations

import numpy as np

from ...arrays import Floats
from ..reduction.discretisation_error import lumping_along
from ..reduction.elements_and_supports import Structure
from .model_error_numbers import MODEL_ERROR
from .smooth_fields import Fields

SUSPENSION = "a suspension"
SENSORS = "the mass of the sensors"
MESH = "a mesh that is too coarse along"


def suspension(M: Floats, smooth: Fields, lowest: float) -> Fields:
    """Return springs to ground in proportion to the mass M (r, r), evenly and as `smooth` fields.

    With an amplitude of 1 the structure would swing on them at its `lowest` eigenvalue.
    """
    uneven = smooth.mass[smooth.mass.any(axis=(1, 2))]
    stiffness = lowest * np.concatenate([M[None], uneven])
    n = len(stiffness)
    spread = np.full(n, MODEL_ERROR.suspension)
    least = np.append(0.0, np.full(n - 1, -MODEL_ERROR.most))
    return Fields((SUSPENSION,) * n, stiffness, np.zeros_like(stiffness), spread, least)


def sensor_mass(root: Floats) -> Fields:
    """Return the mass of sensors, a `root` (n_sensor, r) of which is on a basis."""
    M = (root.T @ root)[None]
    return Fields((SENSORS,), np.zeros_like(M), M, np.array([MODEL_ERROR.sensor_mass]), np.zeros(1))


def mesh_errors(structure: Structure, V: Floats, bars: Floats) -> Fields:
    """Return what lumping does along each of the structure's own axes, on a basis (n_free, r).

    Also what it does to bars, where `bars` (n, r, r) hold their consistent mass less the deck's: by
    an amplitude of 1 a test has their mass lumped, as the deck has it.
    """
    found = [(axis, A) for axis, A in lumping_along(structure) if A.nnz]
    r = V.shape[1]
    M = -np.array([*(V.T @ (A @ V) for _, A in found), *bars]).reshape(-1, r, r)
    axes = [", ".join(f"{x:.1f}" for x in np.round(axis, 1) + 0.0) for axis, _ in found]
    names = (*(f"{MESH} ({axis})" for axis in axes), *(f"{MESH} bars",) * len(bars))
    n = np.ones(len(names))
    return Fields(names, np.zeros_like(M), M, MODEL_ERROR.mesh * n, -MODEL_ERROR.mesh_most * n)
