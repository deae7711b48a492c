"""Motions of free grids that look like those of a rigid body, of a structure that is held."""

from __future__ import annotations

import numpy as np
import scipy.sparse as sp

from .arrays import Floats, Ints
from .errors import InputError
from .mechanism import where
from .model import Model
from .pencil import Pencil

_MOVED = 1e-6


def refuse_linkage(model: Model, pencil: Pencil, modes: Floats) -> None:
    """Refuse free motions that bend a linkage: an element turns about a grid that is held.

    The free end of a rod that is pinned to the ground at its other end can go sideways as in the
    translation of a rigid body; but the rod turns. Such a motion needs a translation, of a grid
    at the other end of an element, that the constraints do not allow.

    Parameters
    ----------
    modes : (n_free, n_mode) float
        Motions without strain energy that count as rigid-body modes.

    Raises
    ------
    InputError
        With the grids and directions that move.
    """
    fixed, xyz = _held(model)
    if not modes.shape[1] or not len(fixed):
        return
    moving = [k for k in range(modes.shape[1]) if _turns(model, fixed, xyz, modes[:, k])]
    if moving:
        count = "a motion" if len(moving) == 1 else f"{len(moving)} motions"
        raise InputError(
            f"the model is a mechanism: {count} of parts that are held elsewhere, without "
            f"stiffness, at {where(model, pencil, modes[:, moving])}; constrain these directions "
            "or give them stiffness"
        )


def _held(model: Model) -> tuple[Ints, Floats]:
    """Find the translations, as rows of `dofs`, that the user holds, and where they are."""
    T = sp.csr_matrix(model.expansion)
    still = np.asarray(abs(T).sum(axis=1)).ravel() == 0.0
    row = model.geometry.index_of(model.dofs.node)
    translation = (model.dofs.component >= 1) & (model.dofs.component <= 3)
    idle = np.isin(model.dofs.node, model.idle)
    fixed = np.flatnonzero(still & translation & (row >= 0) & ~idle)
    return fixed, model.geometry.xyz[row[fixed]]


def _turns(model: Model, fixed: Ints, xyz: Floats, u: Floats) -> bool:
    """Whether a rigid motion of the moving grids would move held ones on the same elements."""
    v = np.asarray(model.expansion @ u)
    dofs = model.dofs
    row = model.geometry.index_of(dofs.node)
    used = np.flatnonzero((dofs.component >= 1) & (dofs.component <= 3) & (row >= 0))
    used = used[np.abs(v[used]) > _MOVED * np.abs(v).max()]
    if not len(used):
        return False
    span = model.geometry.size or 1.0
    centre = model.geometry.xyz[row[used]].mean(axis=0)
    c, *_ = np.linalg.lstsq(
        _rigid(dofs.axis[used], (model.geometry.xyz[row[used]] - centre) / span),
        v[used],
        rcond=None,
    )
    near = np.isin(row[fixed], _neighbours(model, row[used]))
    wanted = _rigid(dofs.axis[fixed[near]], (xyz[near] - centre) / span) @ c
    return bool((np.abs(wanted) > 1e-3 * np.abs(v[used]).max()).any())


def _rigid(axis: Floats, arm: Floats) -> Floats:
    return np.hstack([axis, np.cross(arm, axis)])


def _neighbours(model: Model, grids: Ints) -> Ints:
    """Grid rows on elements that have any of the given ones."""
    moved = np.zeros(len(model.geometry.ids), bool)
    moved[grids] = True
    rows = [
        corners[moved[corners].any(axis=1)].ravel() for corners in model.geometry.elements.values()
    ]
    return np.unique(np.concatenate(rows)) if rows else np.zeros(0, np.int64)
