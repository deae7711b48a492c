"""A neutral model made of matrices that the user's own Nastran exported."""

from collections.abc import Iterable, Sequence

import numpy as np
import scipy.sparse as sp

from ....core.arrays import Ints
from ....core.data.dofs import Dofs
from ....core.data.geometry import Geometry
from ....core.data.parametric_model import Model, Term
from ....core.errors import InputError
from ..deck.read_deck import Deck
from ..op4.exported_matrix import SYMMETRIC, DofMap, NastranMatrix, guessed_form
from ..properties.grids import Points, point_dofs, read_points

_NOT_FOUND = np.zeros((0, 3))


def stiffness_and_mass(
    matrices: Iterable[NastranMatrix], stiffness: str | None = None, mass: str | None = None
) -> tuple[NastranMatrix, NastranMatrix]:
    """Choose the pair of matrices that are stiffness and mass, by name.

    Names that begin with K and M and go on alike (KAAX and MAAX, KGG and MGG) belong together.

    Raises
    ------
    InputError
        No such pair, several, or a name that is not there.
    """
    named = {m.name: m for m in matrices if m.matrix.shape[0] == m.matrix.shape[1]}
    held = ", ".join(named) or "none"
    for asked in (stiffness, mass):
        if asked is not None and asked.upper() not in named:
            raise InputError(f"there is no square matrix {asked}: there are {held}")
    if stiffness and mass:
        return named[stiffness.upper()], named[mass.upper()]
    pairs = [
        (k, "M" + k[1:])
        for k in named
        if k[0] == "K" and "M" + k[1:] in named and min(named[k].matrix.shape) > 1
    ]
    if stiffness or mass:
        pairs = [p for p in pairs if (stiffness or mass or "").upper() in p]
    if len(pairs) != 1:
        found = " and ".join(k for k, _ in pairs) if pairs else "no pair such as KAAX and MAAX"
        raise InputError(
            f"stiffness and mass are not clear: {found} among {held}; say which ones are meant"
        )
    return named[pairs[0][0]], named[pairs[0][1]]


def model_of_matrices(
    stiffness: Sequence[NastranMatrix], mass: Sequence[NastranMatrix], deck: Deck | None = None
) -> Model:
    """Make a model of exported matrices alone.

    Matrices of several parts (external superelements) are added up over the degrees of freedom
    that they name; one that a matrix does not name has no entry in it.

    Parameters
    ----------
    stiffness, mass : sequence of NastranMatrix
        Real, square, with dof maps.
    deck : Deck, optional
        Gives positions and displacement systems. Without it the nodes have no position, and every
        motion without strain energy counts as a rigid-body mode.

    Returns
    -------
    Model
        Without parameters. `dofs` are those of the matrices; with a deck, six a grid along the
        basic axes, those that no matrix names being zero.

    Raises
    ------
    InputError
        A complex matrix, one without dof map or not symmetric, points that the deck lacks.
    """
    for m in (*stiffness, *mass):
        _check(m)
    keys = np.unique(np.concatenate([m.rows.keys for m in (*stiffness, *mass) if m.rows]))
    K, M = _sum(stiffness, keys), _sum(mass, keys)
    there = DofMap.of_keys(keys)
    if deck is None:
        geometry = Geometry(np.zeros(0, np.int64), _NOT_FOUND)
        dofs, expansion = there.dofs, sp.identity(len(keys), format="csr")
    else:
        points = read_points(deck.bulk)
        geometry = Geometry(points.ids, points.xyz, deck.length_unit)
        dofs, expansion = _expanded(there, points)
    return Model(
        geometry=geometry,
        dofs=dofs,
        expansion=expansion,
        stiffness=(Term(K),),
        mass=(Term(M),),
        parameters=(),
        free_labels=tuple(f"{p}:{c}" for p, c in zip(there.point, there.component, strict=True)),
    )


def _check(m: NastranMatrix) -> None:
    if m.rows is None or len(m.rows) != m.matrix.shape[0]:
        raise InputError(
            f"what the rows of matrix {m.name} are is not known: give the deck, or the punch file "
            "of the superelement"
        )
    if np.iscomplexobj(m.matrix.data):
        raise InputError(f"matrix {m.name} is complex; stiffness and mass must be real")
    size = abs(m.matrix).max() if m.matrix.nnz else 0.0
    if not np.isfinite(size):
        raise InputError(f"matrix {m.name} holds values that are not finite numbers")
    difference = abs(m.matrix - m.matrix.T)
    if difference.nnz and difference.max() > 1e-5 * size:
        raise InputError(f"matrix {m.name} is not symmetric")


def _sum(matrices: Sequence[NastranMatrix], keys: Ints) -> sp.csr_matrix:
    n = len(keys)
    total = sp.csr_matrix((n, n))
    for m in matrices:
        assert m.rows is not None
        at = np.searchsorted(keys, m.rows.keys)
        entries = m.matrix.tocoo()
        total = total + sp.coo_matrix((entries.data, (at[entries.row], at[entries.col])), (n, n))
    return ((total + total.T) / 2.0).tocsr()


def _expanded(there: DofMap, points: Points) -> tuple[Dofs, sp.csr_matrix]:
    """Displacements along basic axes of all points from those that the matrices name."""
    lost = (there.component > 0) & ~np.isin(there.point, points.ids)
    if lost.any():
        raise InputError(
            f"the matrices name grid {there.point[lost][0]}, which the deck does not have"
        )
    is_scalar = there.component == 0  # those of superelements need not stand in the deck
    scalar_ids = np.union1d(points.scalar_ids, there.point[is_scalar])
    dofs = point_dofs(points.ids, scalar_ids)
    grid, scalar = np.flatnonzero(~is_scalar), np.flatnonzero(is_scalar)
    row = np.searchsorted(points.ids, there.point[grid])
    triple, direction = np.divmod(there.component[grid] - 1, 3)
    along = (6 * row + 3 * triple)[:, None] + np.arange(3)
    rows = [along.ravel(), 6 * len(points.ids) + np.searchsorted(scalar_ids, there.point[scalar])]
    values = [points.directions[row, direction].ravel(), np.ones(len(scalar))]
    columns = np.concatenate([np.repeat(grid, 3), scalar])
    matrix = sp.coo_matrix(
        (np.concatenate(values), (np.concatenate(rows), columns)), shape=(len(dofs), len(there))
    ).tocsr()
    matrix.eliminate_zeros()
    return dofs, matrix


def model_matrices(model: Model) -> tuple[NastranMatrix, NastranMatrix]:
    """Return stiffness and mass of an assembled deck as KFF and MFF, on its free dofs.

    Raises
    ------
    InputError
        A model that does not say what its free degrees of freedom are.
    """
    if len(model.free_labels) != model.n_free:
        raise InputError("the model does not name its free degrees of freedom")
    there = DofMap.of_labels(model.free_labels)
    K, M = (
        NastranMatrix(name, matrix.tocsc(), SYMMETRIC, there, there)
        for name, matrix in (("KFF", model.K()), ("MFF", model.M()))
    )
    return K, M


def matrix_of(
    name: str, matrix: object, rows: Dofs | None = None, columns: Dofs | None = None
) -> NastranMatrix:
    """Return an array or sparse matrix, with its degrees of freedom, as a matrix of Nastran's."""
    sparse = sp.csc_matrix(matrix)
    row_map, column_map = (None if d is None else DofMap.of_dofs(d) for d in (rows, columns))
    return NastranMatrix(name, sparse, guessed_form(sparse), row_map, column_map)
