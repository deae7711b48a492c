"""The paired shapes, analysis over test, reduced to what a page can carry."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
import scipy.sparse as sp

from ...core.arrays import Floats, Ints, Numbers
from ...core.geometry import Geometry
from ...core.modes import Modes
from . import reading
from .reading import Result
from .surface import Surface, coarsened, surface


@dataclass(frozen=True, eq=False)
class Overlay:
    """Pairs of shapes on a drawable mesh.

    Parameters
    ----------
    mesh : Surface
        Coarse enough to embed.
    shapes : (n_pair, n_node, 3) float
        Analysis displacement at the nodes of `mesh`, the largest of each pair 1.
    sensors : (n_sensor, 3) float
        Positions.
    axes : (n_sensor, 3) float
        Measured directions.
    model, test : (n_pair, n_sensor) float
        What each side says the sensors read, in the scale of `shapes`; the test fitted to the
        model by least squares.
    pairs : tuple of mapping
        The rows of the result, as many as there are shapes.
    """

    mesh: Surface
    shapes: Floats
    sensors: Floats
    axes: Floats
    model: Floats
    test: Floats
    pairs: tuple[Result, ...]


def overlay(
    result: Result,
    geometry: Geometry,
    analysis: Modes,
    test: Modes,
    observation: sp.csr_matrix | None,
    transformation: Floats | None = None,
    *,
    most: int = 800,
) -> Overlay | None:
    """Return the final pairs of a run as shapes; None when the run and the modes disagree.

    Parameters
    ----------
    result : mapping
        Content of result.json: its final pairs and ``alignment.sensors``.
    geometry : Geometry
        Of the analysis.
    analysis : Modes
        On the analysis dofs.
    test : Modes
        At the sensors, (n_sensor) dofs.
    observation : (n_sensor, n_dof) sparse, optional
        Sensor map; without it there is nothing to lay over.
    transformation : (n, n) float, optional
        What the shapes of the turned side are multiplied by; which side it was is told by the
        MAC of the pairs.
    most : int
        Faces and lines of the mesh, about.
    """
    found = reading.final(result)
    rows = reading.records(found, "pairs")
    numbers = [reading.identifiers([p.get("test"), p.get("analysis")]) for p in rows]
    if observation is None:
        return None
    alike = observation.shape == (len(test.dofs), len(analysis.dofs))
    inside = all(
        len(n) == 2 and 1 <= n[0] <= len(test) and 1 <= n[1] <= len(analysis) for n in numbers
    )
    if not rows or not alike or not inside:
        return None
    t, a = (np.array([n[k] for n in numbers]) - 1 for k in (0, 1))
    full, measured = _turned(rows, t, a, analysis, test, observation, transformation)
    sensors = _positions(found, geometry, test)
    if sensors is None:
        return None
    mesh = coarsened(surface(geometry), most)
    moved = _at_nodes(full, analysis, geometry)[:, mesh.original]
    size = np.maximum(np.linalg.norm(moved, axis=2).max(axis=1), 1e-300)
    model = np.asarray(observation @ full).T / size[:, None]
    fitted = _fitted(_real(measured), model.T).T
    return Overlay(
        mesh,
        moved / size[:, None, None],
        sensors,
        np.asarray(test.dofs.axis),
        model,
        fitted,
        tuple(rows),
    )


def _turned(
    rows: list[Result],
    t: Ints,
    a: Ints,
    analysis: Modes,
    test: Modes,
    observation: sp.csr_matrix,
    transformation: Floats | None,
) -> tuple[Floats, Numbers]:
    """Return the shapes of the pairs, the side turned that gives the MAC of the pairs."""
    full, measured = np.real(analysis.shapes), np.asarray(test.shapes)
    choices: list[tuple[Any, Any]] = [(full[:, a], measured[:, t])]
    if transformation is not None and len(transformation) == len(analysis):
        choices.append(((full @ transformation)[:, a], measured[:, t]))
    if transformation is not None and len(transformation) == len(test):
        length = np.maximum(np.linalg.norm(_real(measured), axis=0), 1e-300)
        choices.append((full[:, a], (_real(measured) / length @ transformation)[:, t]))
    told = np.array([reading.number(p.get("mac")) or 0.0 for p in rows])
    return min(choices, key=lambda c: float(np.abs(_mac(observation @ c[0], c[1]) - told).sum()))


def _mac(a: Numbers, b: Numbers) -> Floats:
    scale = np.sum(np.abs(a) ** 2, axis=0) * np.sum(np.abs(b) ** 2, axis=0)
    product = np.abs(np.sum(np.conj(a) * b, axis=0)) ** 2
    return np.asarray(product / np.maximum(scale, 1e-300))


def _real(shapes: Numbers) -> Floats:
    """Shapes turned to their principal phase, real part."""
    phase = np.angle(np.sum(shapes**2, axis=0)) / 2.0
    return np.asarray(np.real(shapes * np.exp(-1j * phase)))


def _fitted(b: Floats, a: Floats) -> Floats:
    scale = np.sum(a * b, axis=0) / np.maximum(np.sum(b * b, axis=0), 1e-300)
    return np.asarray(b * scale)


def _at_nodes(full: Floats, analysis: Modes, geometry: Geometry) -> Floats:
    """Return translations by node of the geometry, (n_pair, n_node, 3), from whatever axes."""
    moved = np.zeros((len(geometry.ids), 3, full.shape[1]))
    rows = np.flatnonzero(analysis.dofs.component <= 3)
    node = geometry.index_of(analysis.dofs.node[rows])
    rows, node = rows[node >= 0], node[node >= 0]
    np.add.at(moved, node, analysis.dofs.axis[rows][:, :, None] * full[rows][:, None, :])
    return moved.transpose(2, 0, 1)


def _positions(found: Result, geometry: Geometry, test: Modes) -> Floats | None:
    rows = reading.records(reading.part(found, "alignment"), "sensors")
    told = [reading.numbers(s.get("xyz")) for s in rows]
    if len(told) == len(test.dofs) and all(len(p) == 3 and None not in p for p in told):
        return np.array(told, dtype=float)
    grids = [reading.identifiers([s.get("nearest_grid")]) for s in rows]
    if len(grids) == len(test.dofs) and all(grids):
        index = geometry.index_of(np.array([g[0] for g in grids]))
        return np.asarray(geometry.xyz[index])
    return None
