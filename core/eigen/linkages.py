"""Motions of free grids that look like those of a rigid body, of a structure that is held."""

from __future__ import annotations

import numpy as np
import scipy.sparse as sp

from ..arrays import Floats, Ints, Numbers
from ..data.parametric_model import Model
from ..errors import InputError
from .mechanisms import where
from .pencil import Pencil

_MOVED = 1e-6


def refuse_linkage(model: Model, pencil: Pencil, modes: Floats) -> None:
    """Refuse free motions that bend a linkage: an element turns about a grid that is held.

    The free grids of a four-bar linkage go sideways as in the translation of a rigid body; but
    its cranks turn about the ground. No rigid motion moves the free grids so and leaves at rest
    the grids that are held at the other ends of their elements. (A pendulum is a rigid body.)

    Parameters
    ----------
    modes : (n_free, n_mode) float
        Motions without strain energy that count as rigid-body modes.

    Raises
    ------
    InputError
        With the grids and directions that move.
    """
    still = np.asarray(abs(sp.csr_matrix(model.expansion)).sum(axis=1)).ravel() == 0.0
    if not modes.shape[1] or not still.any():
        return
    moving = [k for k in range(modes.shape[1]) if _turns(model, still, modes[:, k])]
    if moving:
        count = "a motion" if len(moving) == 1 else f"{len(moving)} motions"
        raise InputError(
            f"the model is a mechanism: {count} of parts that are held elsewhere, without "
            f"stiffness, at {where(model, pencil, modes[:, moving])}; constrain these directions "
            "or give them stiffness"
        )


def _turns(model: Model, still: Numbers, u: Floats) -> bool:
    """Whether no rigid motion moves all moving grids so and leaves the held ones at rest."""
    v = np.asarray(model.expansion @ u)
    dofs, geometry = model.dofs, model.geometry
    row = geometry.index_of(dofs.node)
    translation = (dofs.component >= 1) & (dofs.component <= 3) & (row >= 0)
    moving = translation & (np.abs(v) > _MOVED * np.abs(v).max())
    grids = np.unique(row[moving])
    if not len(grids):
        return False
    involved = np.isin(row, np.union1d(grids, _neighbours(model, grids)))
    known = translation & involved & (still | np.isin(row, grids))
    known &= ~(still & np.isin(dofs.node, model.idle))
    rows = np.flatnonzero(known)
    arm = (geometry.xyz[row[rows]] - geometry.xyz[grids].mean(axis=0)) / (geometry.size or 1.0)
    R = np.hstack([dofs.axis[rows], np.cross(arm, dofs.axis[rows])])
    c, *_ = np.linalg.lstsq(R, v[rows], rcond=None)
    return bool(np.abs(R @ c - v[rows]).max() > 1e-3 * np.abs(v[rows]).max())


def _neighbours(model: Model, grids: Ints) -> Ints:
    """Grid rows on elements that have any of the given ones."""
    moved = np.zeros(len(model.geometry.ids), bool)
    moved[grids] = True
    rows = [
        corners[moved[corners].any(axis=1)].ravel() for corners in model.geometry.elements.values()
    ]
    return np.unique(np.concatenate(rows)) if rows else np.zeros(0, np.int64)
