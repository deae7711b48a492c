"""Where equipment may stand, and how what stands there moves.

It follows what it stands on, as a rigid body: a grid with its own rotations, or on shells and
solids as well a grid and those beside it, whose motion it follows in the mean (RBE3). A foot on one
grid of a shell tilts by all that its moment bends there, a wide one hardly. About the normal of a
sheet a grid of its shells says nothing of how it turns: those around it do.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
import scipy.linalg as la
import scipy.sparse as sp

from ...arrays import Floats, Ints, skew
from ..effects.effect_kind import Words
from ..effects.effect_numbers import EFFECTS
from ..effects.structure_points import rotations, translations
from ..reduction.elements_and_supports import Structure


@dataclass(frozen=True, eq=False)
class Stand:
    """A place where equipment stands.

    Parameters
    ----------
    xyz : (3,) float
    where : dict
        ``grids`` and, of a place off its grid, ``arms``: see `structure_points`. Of one grid of a
        sheet that grid first, and the ``normal`` about which it turns as all of them do.
    motion : (6, n_free) sparse
        Its translations and rotations.
    turn : (3, 3) float
        Takes the offset of the first of places alike to that here.
    axes : (3, 3) float
        Rows: the normal of the sheet it stands on, and two ways along it; basic axes on no sheet.
    sheet : bool
    """

    xyz: Floats
    where: Words
    motion: sp.csr_matrix
    turn: Floats
    axes: Floats
    sheet: bool


def stands(structure: Structure, where: Words, turn: Floats) -> list[Stand]:
    """Return the places of equipment on some grids, none where nothing there holds it upright.

    The widest first.
    """
    g = structure.model.geometry
    own = g.index_of(np.array(where["grids"]))
    wide = np.zeros(len(g.ids), bool)
    wide[own] = True
    for m in structure.members:
        if m.element.dimension > 1:
            beside = np.isin(m.corners, own).any(axis=1)
            wide[m.corners[beside].ravel()] = True
    foot, around = _on_grid(structure, where, turn), None
    if wide.sum() > 1 and "arms" not in where:
        around = _around(structure, own, np.flatnonzero(wide), turn)
    sheet = around is not None and around.sheet
    if foot is not None and not _turns(foot, around.axes[1:] if around and sheet else np.eye(3)):
        foot = None
    if foot is not None and around is not None and sheet:
        n = around.axes[0]
        swung = la.block_diag(np.zeros((3, 3)), np.outer(n, n))
        straight = sp.csr_matrix(np.eye(6) - swung)
        motion = straight @ foot.motion + sp.csr_matrix(swung) @ around.motion
        first = where["grids"][0]
        grids = [first, *(k for k in around.where["grids"] if k != first)]
        named: Words = {"grids": grids, "normal": n.tolist()}
        foot = replace(around, xyz=foot.xyz, where=named, motion=motion.tocsr())
    return [s for s in (around, foot) if s is not None]


def _on_grid(structure: Structure, where: Words, turn: Floats) -> Stand | None:
    """Return the place on one grid, or an arm off it."""
    g = structure.model.geometry
    if len(where["grids"]) > 1:
        return None
    (own,) = g.index_of(np.array(where["grids"]))
    points = sp.csr_matrix((np.ones(1), ([0], [own])), (1, len(g.ids)))
    turns = rotations(structure, points)
    arm = np.sum(where.get("arms", np.zeros((1, 3))), axis=0)
    moves = translations(structure, points) - sp.csr_matrix(skew(arm)) @ turns
    kept: Words = {k: where[k] for k in ("grids", "arms") if k in where}
    return Stand(g.xyz[own] + arm, kept, sp.vstack([moves, turns]).tocsr(), turn, np.eye(3), False)


def _turns(s: Stand, ways: Floats) -> bool:
    """Whether a place turns about each of some ways (n, 3)."""
    return bool(np.diff((sp.csr_matrix(ways) @ s.motion[3:]).indptr).min() > 0)


def _around(structure: Structure, own: Ints, rows: Ints, turn: Floats) -> Stand | None:
    """Return the place on grids in `rows` whose motion it follows in the mean."""
    g = structure.model.geometry
    xyz = g.xyz[own].mean(axis=0)
    points = sp.csr_matrix(
        (np.ones(len(rows)), (np.arange(len(rows)), rows)), (len(rows), len(g.ids))
    )
    size = float(np.linalg.norm(g.xyz[rows] - xyz, axis=1).max())
    rigid = np.concatenate([np.hstack([np.eye(3), -skew(x - xyz) / size]) for x in g.xyz[rows]])
    if np.linalg.matrix_rank(rigid) < rigid.shape[1]:
        return None
    fitted = np.linalg.pinv(rigid) / np.repeat([1.0, size], 3)[:, None]
    motion = sp.csr_matrix(fitted) @ translations(structure, points)
    grids = {"grids": g.ids[rows].tolist()}
    return Stand(xyz, grids, motion, turn, *_axes(g.xyz[rows] - xyz))


def _axes(around: Floats) -> tuple[Floats, bool]:
    """Return the normal of a sheet of grids (n, 3) and two ways along it, one near to an axis.

    Basic axes where they are no sheet; also whether they are one.
    """
    _, extent, ways = np.linalg.svd(around - around.mean(axis=0), full_matrices=False)
    if extent[2] > EFFECTS.sheet_thick * extent[1]:
        return np.eye(3), False
    normal = ways[2] * np.sign(ways[2][np.argmax(np.abs(ways[2]))])
    along = np.eye(3)[np.argmin(np.abs(normal))]
    along = along - normal * (normal @ along)
    along /= np.linalg.norm(along)
    return np.array([normal, along, np.cross(normal, along)]), True
