"""Where a model and a test disagree: by mode, by sensor, and over the structure."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Protocol

import numpy as np
import scipy.sparse as sp
from scipy.spatial import cKDTree

from ..arrays import Floats, Ints, frozen
from ..correlation.comparison import Comparison
from ..correlation.mac import realised
from ..data.geometry import Geometry
from ..noun import Noun
from .first_order_maps import (
    Linearisation,
    linearise,
    mass_evidence,
    patches_of,
    root_of,
    stiffness_evidence,
)
from .localisation_numbers import MAPS
from .shape_misfit import Misfit, misfit, paired_shapes, spread
from .shape_noise import Noise, estimate_noise, given_noise

_TRANSLATIONS = (1, 2, 3)


class ElementGroup(Protocol):
    """Elements of one kind, with their stiffness."""

    @property
    def corners(self) -> Ints:
        """Rows of the geometry, (n, k)."""
        ...

    def stiffness(self, rows: Ints, p: Floats) -> Floats:
        """Stiffness of some of them, (n, m, m)."""
        ...

    def coordinates(self, rows: Ints) -> Ints:
        """Rows of the element displacements, (n, m)."""
        ...


@dataclass(frozen=True, eq=False)
class Disagreement(Noun):
    """Maps of a misfit.

    Parameters
    ----------
    misfit : Misfit
        By mode and by sensor, in standard deviations of the measurement.
    places : (n_place,) int
        Rows of the geometry where the maps below are given.
    motion : (n_place,) float
        Misfit of the sensors around, standard deviations.
    mass, stiffness, ground : (n_place,) float
        Share of the misfit's sum of squares that mass added, stiffness lost or gained, or a
        spring to ground added around the place would take away, to first order.
    total : float
        That sum of squares, frequencies included, less a common scale of all eigenvalues.
    """

    misfit: Misfit
    places: Ints
    motion: Floats
    mass: Floats
    stiffness: Floats
    ground: Floats
    total: float


def disagreement(
    compared: Comparison,
    groups: Sequence[ElementGroup],
    displacement: sp.csr_matrix,
    free_shapes: Floats,
    p: Floats,
) -> Disagreement:
    """Map where a model and a test disagree.

    Parameters
    ----------
    compared : Comparison
        Rotated on the analysis side or not at all.
    groups : sequence of ElementGroup
    displacement : (n, n_free) sparse
        Element displacements from the free degrees of freedom.
    free_shapes : (n_free, n_mode) float
        The analysis modes on the free degrees of freedom, mass-normalised.
    p : (n_parameter,) float
        Where the element matrices are taken.

    Returns
    -------
    Disagreement

    Raises
    ------
    InputError
        There are no pairs, or the test side was rotated.

    Notes
    -----
    First-order maps show where to look. They locate nothing where shapes change much; the search
    for effects does not use them.
    """
    geometry, found, seen = compared.geometry, compared.correlation, compared.observation
    hz = compared.analysis.frequencies_hz
    at_sensors = np.asarray(seen.matrix @ compared.analysis.shapes)
    noise = _noise(compared, at_sensors)
    pairs = paired_shapes(found, at_sensors, compared.test.shapes)
    measured = misfit(found, pairs, noise)
    places = _evenly(len(geometry.xyz), MAPS.places)
    centres = geometry.xyz[places]
    motion = spread(measured.by_sensor, seen.xyz, centres)
    lin = linearise(found, pairs, noise, hz, at_sensors)
    radius = MAPS.reach * geometry.size
    moves = _translations(compared, geometry)
    mass = mass_evidence(lin, moves, patches_of(centres, geometry.xyz, radius))
    springs = [stiffness_evidence(lin, moves[places, c : c + 1]) for c in range(3)]
    ground = np.max([np.where(e.size > 0.0, e.explained, 0.0) for e in springs], axis=0)
    stiffness = _stiffness(lin, groups, displacement, free_shapes, p, geometry, centres, radius)
    total = max(mass.total, float(np.finfo(float).tiny))
    maps = (frozen(explained / total) for explained in (mass.explained, stiffness, ground))
    by_mass, by_stiffness, by_ground = maps
    motion = frozen(motion)
    return Disagreement(measured, places, motion, by_mass, by_stiffness, by_ground, mass.total)


def _noise(compared: Comparison, at_sensors: Floats) -> Noise:
    shapes = realised(compared.test.shapes)
    if len(shapes) < MAPS.few_sensors:
        return given_noise(shapes, MAPS.shape_noise)
    hz = compared.analysis.frequencies_hz
    highest = max(float(hz.max(initial=0.0)), 1e-300)
    rigid = int(np.count_nonzero(hz < MAPS.rigid * highest))
    return estimate_noise(hz, at_sensors, compared.test.frequencies_hz, shapes, rigid)


def _evenly(count: int, most: int) -> Ints:
    """At most `most` of `count` rows, spread over all of them."""
    return np.unique(np.linspace(0, count - 1, min(count, most)).round().astype(np.int64))


def _translations(compared: Comparison, geometry: Geometry) -> Floats:
    """Return the translations of every node in the analysis modes, (n_node, 3, n_mode)."""
    dofs, shapes = compared.analysis.dofs, compared.analysis.shapes
    out = np.zeros((len(geometry.ids), 3, shapes.shape[1]))
    row = geometry.index_of(dofs.node)
    for component in _TRANSLATIONS:
        mine = (dofs.component == component) & (row >= 0)
        out[row[mine], component - 1] = shapes[mine]
    return out


def _stiffness(
    lin: Linearisation,
    groups: Sequence[ElementGroup],
    displacement: sp.csr_matrix,
    free_shapes: Floats,
    p: Floats,
    geometry: Geometry,
    centres: Floats,
    radius: float,
) -> Floats:
    """Find what stiffness around each place explains, the best kind of element, (n_place,)."""
    best = np.zeros(len(centres))
    count = sum(len(g.corners) for g in groups)
    moved = np.asarray(displacement @ free_shapes)
    for group in groups:
        share = max(1, len(group.corners) * MAPS.elements // max(count, 1))
        rows = _evenly(len(group.corners), share)
        if not len(rows):
            continue
        K = group.stiffness(rows, p)
        if not K.any():
            continue
        strain = root_of(K, moved[group.coordinates(rows)])
        middle = geometry.xyz[group.corners[rows]].mean(axis=1)
        apart = cKDTree(middle).query(middle, k=[2])[0].max() if len(middle) > 1 else 0.0
        near = patches_of(centres, middle, max(radius, float(apart)))
        best = np.maximum(best, stiffness_evidence(lin, strain, near).explained)
    return best
