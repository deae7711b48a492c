"""What the viewer moves: pairs and modes of one side alone, on one mesh and one set of sensors."""

from collections.abc import Iterator
from dataclasses import dataclass, field, replace

import numpy as np
import scipy.sparse as sp

from ....core.arrays import Floats, Ints
from ....core.data.geometry import Geometry
from ....core.data.modes import Modes
from ....core.results.correlation import Compared, PairRow
from ....core.results.paired_shapes import DrawnMesh, Overlay
from ....core.results.plain import Table
from .seen_surface import surface
from .sensor_shapes import at_places, joined
from .shape_overlay import nodal_shapes, overlay, real_shapes

_ABOVE = 1.02
"""Analysis modes above the highest test mode by this factor are not shown."""
_MOST = 40
"""Modes of each side without a partner that are shown, the lowest ones."""


@dataclass(frozen=True, eq=False)
class Frame:
    """One pair, or one mode of a ``side`` (``test``, ``analysis``) without a partner.

    Parameters
    ----------
    side : str
        ``both``, ``test`` or ``analysis``.
    mode : int
        Its number; of a pair that of the test.
    hz : float
        Likewise.
    shape : (n_node, 3) float
        What the mesh moves, the largest 1.
    model, test : (n_place, 3) float
        What either side moves at the places of sensors, in the same scale.
    pair : PairRow, optional
    before : Frame, optional
        The same before close modes were turned onto each other.
    """

    side: str
    mode: int
    hz: float
    shape: Floats
    model: Floats
    test: Floats
    pair: PairRow | None = None
    before: "Frame | None" = None


def _no_lines() -> Ints:
    return np.zeros((0, 2), np.int64)


@dataclass(frozen=True, eq=False)
class Film:
    """Frames on a mesh.

    Parameters
    ----------
    mesh : DrawnMesh
    frames : tuple of Frame
    places : (n_place, 3) float
        Nodes of the test.
    lines : (n_line, 2) int
        Of the test, rows of `places`.
    sensors, axes : (n_sensor, 3) float
        Where and which way something was measured.
    drawn : bool
        Whether the lines are the test's own, not neighbours joined for the eye.
    """

    mesh: DrawnMesh
    frames: tuple[Frame, ...]
    places: Floats = field(default_factory=lambda: np.zeros((0, 3)))
    lines: Ints = field(default_factory=_no_lines)
    sensors: Floats = field(default_factory=lambda: np.zeros((0, 3)))
    axes: Floats = field(default_factory=lambda: np.zeros((0, 3)))
    drawn: bool = True

    @property
    def all_frames(self) -> tuple[Frame, ...]:
        """The frames, then those before turning."""
        return (*self.frames, *(f.before for f in self.frames if f.before is not None))


def one_side(moving: Overlay) -> Film:
    """Return shapes of one side alone: of a model, or of a test whose sensors rest beside."""
    rows = np.arange(len(moving.sensors))
    still = np.zeros((len(rows), 3))
    frames = tuple(
        Frame("both", k + 1, 0.0, shape, still, read[:, None] * moving.axes)
        for k, (shape, read) in enumerate(zip(moving.shapes, moving.test, strict=True))
    )
    return Film(moving.mesh, frames, moving.sensors, _no_lines(), moving.sensors, moving.axes)


def paired_film(
    found: Compared,
    geometry: Geometry,
    analysis: Modes,
    test: Modes,
    observation: sp.csr_matrix | None,
    transformation: Floats | None = None,
    test_geometry: Geometry | None = None,
) -> Film | None:
    """Return pairs, and modes without a partner, of a correlation; None without pairs.

    A place of the test moves as its sensors read; in directions that none of them measures it
    follows the grid of the model that is nearest.

    Parameters
    ----------
    found, geometry, analysis, test, observation, transformation
        As for `overlay`.
    test_geometry : Geometry, optional
        In the frame of the analysis, for the lines of the test.
    """
    turned = overlay(found, geometry, analysis, test, observation, transformation)
    if turned is None:
        return None
    plain = overlay(replace(found, pairs=_unturned(found)), geometry, analysis, test, observation)
    assert plain is not None
    nodes = np.array([s.node for s in found.alignment.sensors])
    named, place = np.unique(nodes, return_inverse=True)
    places = turned.sensors[[int(np.argmax(place == k)) for k in range(len(named))]]
    lines = _lines(test_geometry, named)
    stage = _Stage(place, turned.axes, _nearest(found, geometry, nodes, named))
    frames = [
        stage.frame(turned, k, stage.frame(plain, k) if p.rotation_deg else None)
        for k, p in enumerate(turned.pairs)
    ]
    frames += _alone(found, stage, turned.mesh, geometry, analysis, test)
    own = lines if lines is not None else joined(places, np.arange(len(places)))
    return Film(
        turned.mesh, tuple(frames), places, own, turned.sensors, turned.axes, lines is not None
    )


def _unturned(found: Compared) -> Table[PairRow]:
    """Return the pairs with their MAC as measured."""
    mac = found.mac
    rows, columns = ({m: k for k, m in enumerate(of)} for of in (mac.test, mac.analysis))
    return Table(
        (replace(p, mac=float(mac.values[rows[p.test], columns[p.analysis]])) for p in found.pairs),
        PairRow,
    )


@dataclass(frozen=True, eq=False)
class _Stage:
    """Which place each sensor stands at, its axis, and the grid nearest to each place."""

    place: Ints
    axes: Floats
    grid: Ints

    def moved(self, read: Floats, near: Floats) -> Floats:
        """Return what places move that read so, (n_place, 3); `near` where nothing is read."""
        seen = np.einsum("sk,sk->s", self.axes, near[self.place])
        moved = at_places(self.place, self.axes, (read - seen)[:, None], len(near))[0]
        return np.asarray(near + moved)

    def frame(self, of: Overlay, k: int, before: Frame | None = None) -> Frame:
        pair = of.pairs[k]
        near = of.nodal[k][self.grid]
        model, test = (self.moved(read[k], near) for read in (of.model, of.test))
        return Frame("both", pair.test, pair.test_hz, of.shapes[k], model, test, pair, before)


def _nearest(found: Compared, geometry: Geometry, nodes: Ints, named: Ints) -> Ints:
    grids = np.array([s.nearest_grid for s in found.alignment.sensors], np.int64)
    rows = geometry.index_of(grids)
    return np.array([rows[int(np.argmax(nodes == n))] for n in named], np.int64)


def _lines(test: Geometry | None, named: Ints) -> Ints | None:
    """Return the lines of the test between places, rows of `named`; None where it has none."""
    if test is None:
        return None
    drawn = surface(test)
    sides = [drawn.lines, *(drawn.faces[:, [k, (k + 1) % 4]] for k in range(4))]
    ends = np.vstack(sides)
    row = np.full(len(test.ids), -1)
    at = test.index_of(named)
    row[at[at >= 0]] = np.flatnonzero(at >= 0)
    ends = np.unique(np.sort(row[ends], axis=1), axis=0) if len(ends) else ends
    ends = ends[(ends[:, 0] >= 0) & (ends[:, 0] != ends[:, 1])] if len(ends) else ends
    return ends if len(ends) else None


def _alone(
    found: Compared,
    stage: _Stage,
    mesh: DrawnMesh,
    geometry: Geometry,
    analysis: Modes,
    test: Modes,
) -> Iterator[Frame]:
    still = np.zeros((len(stage.grid), 3))
    for t in found.unpaired_test[:_MOST]:
        read = real_shapes(np.asarray(test.shapes[:, [t - 1]]))[:, 0]
        moved = stage.moved(read, still)
        size = max(float(np.linalg.norm(moved, axis=1).max(initial=0.0)), 1e-300)
        rest = np.zeros_like(mesh.xyz)
        yield Frame("test", t, float(found.test_hz[t - 1]), rest, still, moved / size)
    top = _ABOVE * np.max(found.test_hz, initial=0.0)
    below = [a for a in found.unpaired_analysis if found.analysis_hz[a - 1] <= top][:_MOST]
    columns = np.real(analysis.shapes[:, np.array(below, int) - 1])
    for a, full in zip(below, nodal_shapes(geometry, analysis.dofs, columns), strict=True):
        drawn = full[mesh.original]
        size = max(float(np.linalg.norm(drawn, axis=1).max(initial=0.0)), 1e-300)
        hz = float(found.analysis_hz[a - 1])
        yield Frame("analysis", a, hz, drawn / size, full[stage.grid] / size, still)
