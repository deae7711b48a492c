"""Where on a structure something may be missing."""

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property

import numpy as np
import scipy.sparse as sp
from scipy.sparse.csgraph import connected_components

from ...arrays import Bools, Floats, Ints
from ...assembly.element_assembly import ElementBlock
from ...data.parametric_model import Model
from ...elements import Element
from ...noun import Noun
from .own_axes import own_axes
from .reduction_numbers import REDUCTION

Moved = Callable[[Floats], tuple[sp.csr_matrix, sp.csr_matrix]]


@dataclass(frozen=True, eq=False)
class Members:
    """Elements of one card.

    Parameters
    ----------
    element : Element
        What they are; one that has a shape.
    ids : (n,) int
    corners : (n, k) int
        Rows of the geometry.
    block : ElementBlock
        Their matrices, in the coordinates of `Structure.displacement`.
    """

    element: Element
    ids: Ints
    corners: Ints
    block: ElementBlock

    def stiffness(self, rows: Ints, p: Floats) -> Floats:
        """Return the stiffness of some elements, (n, m, m)."""
        return self._known(rows, self.block.evaluate(rows, p, (True, False))[0])

    def mass(self, rows: Ints, p: Floats) -> Floats:
        """Return the mass of some elements, (n, m, m)."""
        return self._known(rows, self.block.evaluate(rows, p, (False, True))[1])

    def _known(self, rows: Ints, matrices: Floats | None) -> Floats:
        """Return matrices of some elements, zeros where they have none."""
        m = self.block.width * self.block.places.shape[1]
        return np.zeros((len(rows), m, m)) if matrices is None else matrices

    def slope(self, rows: Ints, p: Floats, parameter: int) -> Floats:
        """Return the derivative of the stiffness of some elements by ln p of one, (n, m, m)."""
        step = REDUCTION.log_step * (np.arange(len(p)) == parameter)
        more, less = (self.stiffness(rows, p * np.exp(x)) for x in (step, -step))
        return np.asarray((more - less) / (2.0 * REDUCTION.log_step))

    def coordinates(self, rows: Ints) -> Ints:
        """Rows of `Structure.displacement` of some elements, (n, m)."""
        w = self.block.width
        places = self.block.places[rows]
        return (w * places[:, :, None] + np.arange(w)).reshape(len(rows), w * places.shape[1])


@dataclass(frozen=True, eq=False)
class Supports:
    """Degrees of freedom that the deck fixes.

    Parameters
    ----------
    grid, component : (n,) int
    xyz : (n, 3) float
    axis : (n, 3) float
        Direction of each, basic axes.
    root : (n, n_free) sparse
        Forces on the free degrees of freedom of a unit displacement of each.
    coupling : (n, n) sparse
        Stiffness among them, all else fixed.
    slopes : tuple of (n, n) sparse
        Its derivatives by the parameters, at the deck's values.
    inertia, mass : (n, n_free), (n, n) sparse
        Mass between them and the free degrees of freedom, and among them.
    motion : (n_dof, n) sparse
        Motion of all analysis dofs, basic axes, by a unit displacement of each.
    """

    grid: Ints
    component: Ints
    xyz: Floats
    axis: Floats
    root: sp.csr_matrix
    coupling: sp.csr_matrix
    slopes: tuple[sp.csr_matrix, ...]
    inertia: sp.csr_matrix
    mass: sp.csr_matrix
    motion: sp.csr_matrix

    @property
    def places(self) -> Floats:
        """Where grids are held in any direction, not turned alone, (m, 3)."""
        pinned = np.flatnonzero(self.component <= 3)
        first = np.unique(self.grid[pinned], return_index=True)[1]
        return np.asarray(self.xyz[pinned[first]])


@dataclass(frozen=True, eq=False)
class Structure(Noun):
    """A model with its elements one by one.

    Parameters
    ----------
    model : Model
    members : tuple of Members
    displacement : (n_g, n_free) sparse
        Displacements in the coordinates of the element matrices.
    supports : Supports or None
    damping : (n_free, n_free) sparse or None
        Dashpots of the deck, force over velocity; None where it has none.
    moved : callable, optional
        Stiffness and mass of the deck with its nodes moved by (n_node, 3) in basic axes, each
        (n_free, n_free) sparse; None where these cannot be had.
    """

    model: Model
    members: tuple[Members, ...]
    displacement: sp.csr_matrix
    supports: Supports | None = None
    damping: sp.csr_matrix | None = None
    moved: Moved | None = None

    def centroids(self, m: Members) -> Floats:
        """Centroids of the elements of one card, (n, 3)."""
        return np.asarray(self.model.geometry.xyz[m.corners].mean(axis=1))

    def in_order(self, xyz: Floats) -> Ints:
        """Rows of points (n, 3) in order along the structure's own axes, whatever order they have.

        So what is chosen of them hangs on where they are, not on how a deck numbers them.
        """
        unit = REDUCTION.as_far * self.model.geometry.size
        return np.asarray(np.lexsort(np.round(xyz @ self._axes.T / unit).T[::-1]))

    @cached_property
    def lumped_masses(self) -> tuple[Floats, ...]:
        """Masses of the elements of each card whose mass is lumped, 0 where it is not, (n,)."""
        return tuple(_lumped(m, self.model.deck_point) for m in self.members)

    @cached_property
    def _axes(self) -> Floats:
        return own_axes(self.model.geometry.xyz)


def _lumped(m: Members, p: Floats) -> Floats:
    along = m.mass(np.arange(len(m.ids)), p)[:, ::6, ::6]
    diagonal = np.einsum("eii->e", along)
    whole = along.sum(axis=(1, 2))
    return np.asarray(np.where(np.isclose(diagonal, whole), whole, 0.0))


def placed(n: int, at: Ints, matrices: Floats) -> sp.csr_matrix:
    """Return the sum (n, n) of matrices (n_element, m, m) of elements at `at` (n_element, m)."""
    rows, columns = np.broadcast_arrays(at[:, :, None], at[:, None, :])
    return sp.csr_matrix((matrices.ravel(), (rows.ravel(), columns.ravel())), (n, n))


def used(structure: Structure, dimension: int = 0) -> Bools:
    """Whether each grid is one of an element of so many dimensions or more, (n_grid,)."""
    out = np.zeros(len(structure.model.geometry.ids), bool)
    for m in structure.members:
        if m.element.dimension >= dimension:
            out[m.corners.ravel()] = True
    return out


def unit(v: Floats) -> Floats:
    """Return vectors (..., 3) scaled to length one, those without length as they are."""
    length = np.linalg.norm(v, axis=-1, keepdims=True)
    return np.asarray(v / np.maximum(length, np.finfo(float).tiny))


def connected(n: int, first: Ints, last: Ints) -> list[Ints]:
    """Return the rows of n things in sets, joined by pairs of `first` and `last`."""
    graph = sp.csr_matrix((np.ones(len(first)), (first, last)), (n, n))
    label = connected_components(graph, directed=False)[1]
    return np.split(np.argsort(label, kind="stable"), np.cumsum(np.bincount(label)))[:-1]


def thinned(xyz: Floats, distance: float) -> Ints:
    """Rows of a subset of points in which every other has one within `distance`, the first kept."""
    from scipy.spatial import cKDTree

    tree = cKDTree(xyz)
    left = np.ones(len(xyz), bool)
    kept = []
    for i in range(len(xyz)):
        if left[i]:
            kept.append(i)
            left[tree.query_ball_point(xyz[i], distance)] = False
    return np.array(kept, dtype=np.int64)
