"""Equipment: a mass with its centre off the structure, which resists being turned.

It follows the footprint it stands on, as a rigid body: a grid of bars with its own rotations, on
shells and solids the grid and those beside it, whose motion the body follows in the mean (RBE3).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
import scipy.sparse as sp

from ...arrays import Floats
from ..reduction.elements_and_supports import Structure
from .candidates import Candidates, places_of, together
from .effect_kind import Words
from .effect_laws import MassLaw, MountedLaw
from .effect_numbers import EFFECTS
from .structure_points import rotations, translations


@dataclass(frozen=True)
class Body:
    """A rigid body of unit mass.

    Parameters
    ----------
    offset : (3,) tuple of float
        Of its centre from the place, basic axes.
    radius : float
        Of gyration, about any axis.
    assumed : bool
        Whether the test does not tell it.
    """

    offset: tuple[float, float, float]
    radius: float
    assumed: bool = False


def block(mass: float, density: float) -> Body:
    """Return a solid block, twice as long as wide and high, its radius the rms about its axes."""
    width = (0.5 * mass / density) ** (1.0 / 3.0)
    return Body((0.0, 0.0, 0.0), float(width / np.sqrt(3.0)), assumed=True)


@dataclass(frozen=True, eq=False)
class Equipment(Candidates):
    """Masses at places, each with its body."""

    bodies: tuple[Body, ...] = ()


@dataclass(frozen=True, eq=False)
class Stand:
    """A place where equipment stands.

    Parameters
    ----------
    xyz : (3,) float
    where : dict
        ``grids`` and, of a place off its grid, ``arms``: see `structure_points`.
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


def stand(structure: Structure, where: Words, turn: Floats) -> Stand | None:
    """Return the place of equipment on some grids, None where nothing there holds it upright."""
    g = structure.model.geometry
    own = g.index_of(np.array(where["grids"]))
    wide = np.zeros(len(g.ids), bool)
    wide[own] = True
    for m in structure.members:
        if m.element.dimension > 1:
            beside = np.isin(m.corners, own).any(axis=1)
            wide[m.corners[beside].ravel()] = True
    rows, xyz = np.flatnonzero(wide), g.xyz[own].mean(axis=0)
    points = sp.csr_matrix(
        (np.ones(len(rows)), (np.arange(len(rows)), rows)), (len(rows), len(g.ids))
    )
    moves = translations(structure, points)
    if len(rows) == 1:
        turns = rotations(structure, points)
        if np.diff(turns.indptr).min() == 0:
            return None
        arm = np.sum(where.get("arms", np.zeros((1, 3))), axis=0)
        motion = sp.vstack([moves - sp.csr_matrix(_cross(arm)) @ turns, turns]).tocsr()
        kept: Words = {k: where[k] for k in ("grids", "arms") if k in where}
        return Stand(xyz + arm, kept, motion, turn, np.eye(3), False)
    size = float(np.linalg.norm(g.xyz[rows] - xyz, axis=1).max())
    rigid = np.concatenate([np.hstack([np.eye(3), -_cross(x - xyz) / size]) for x in g.xyz[rows]])
    if np.linalg.matrix_rank(rigid) < rigid.shape[1]:
        return None
    fitted = np.linalg.pinv(rigid) / np.repeat([1.0, size], 3)[:, None]
    motion = sp.csr_matrix(fitted) @ moves
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


def equipment(
    template: Candidates,
    stands: Sequence[Stand],
    bodies: Sequence[Body],
    mount: float | None = None,
) -> Candidates:
    """Return candidates of masses with each of the bodies, at all the places together.

    Rigidly, or each on a mount of a known ln f, alike in all directions and turns.
    """
    each = [(s, _turned(s, b)) for b in bodies for s in stands]
    held = np.array([] if mount is None else [mount])
    anywhere = np.full(1, np.inf)
    single = Equipment(
        kind=template.kind,
        xyz=np.array([s.xyz for s, _ in each]),
        law=MassLaw() if mount is None else MountedLaw(np.zeros((len(each), 1)), 0.0),
        trials=np.hstack([template.trials[:, :1], np.tile(held, (len(template.trials), 1))]),
        root=sp.vstack([_rows(s, b) for s, b in each]).tocsr(),
        rows_each=6,
        where=tuple(s.where for s, _ in each),
        typical=np.append(template.typical[:1], held),
        spread=np.append(template.spread[:1], np.full(len(held), EFFECTS.mount_held)),
        steps=np.ones(1 + len(held)),
        lower=np.append(-anywhere, held),
        upper=np.append(anywhere, held),
        bodies=tuple(b for _, b in each),
    )
    if len(stands) == 1:
        return single
    return together(single, np.arange(len(each)).reshape(len(bodies), len(stands)))


def further(c: Candidates, row: int, words: Words) -> Words:
    """Return offset and moment of inertia of a mass that has them."""
    if not isinstance(c, Equipment):
        return {}
    body = c.bodies[row]
    said: Words = {"inertia": words["mass"] * body.radius**2}
    if body.assumed:
        said["inertia_assumed"] = True
    return {**({"offset": list(body.offset)} if any(body.offset) else {}), **said}


def stands_off(c: Candidates, row: int) -> bool:
    """Whether one of some candidates has its centre off the place."""
    own, first = places_of(c, row)[0]
    return isinstance(own, Equipment) and any(own.bodies[first].offset)


def _turned(s: Stand, b: Body) -> Body:
    x, y, z = (float(v) for v in s.turn @ np.array(b.offset))
    return replace(b, offset=(x, y, z))


def _rows(s: Stand, b: Body) -> sp.csr_matrix:
    """Root of the mass matrix of unit mass: motion of the centre, and turns times the radius."""
    off = np.hstack([np.eye(3), -_cross(np.array(b.offset))])
    turns = np.hstack([np.zeros((3, 3)), b.radius * np.eye(3)])
    return sp.csr_matrix(np.concatenate([off, turns])) @ s.motion


def _cross(d: Floats) -> Floats:
    """Return the matrix of d × ."""
    x, y, z = d
    return np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])
