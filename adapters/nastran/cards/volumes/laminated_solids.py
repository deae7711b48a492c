"""Solids of several plies: PCOMPS."""

import numpy as np

from .....core.arrays import Floats, Ints, Matrices
from .....core.data.shapes import HEXA, PENTA
from .....core.elements.batch import transpose
from .....core.elements.volumes.layered import layered_stiffness
from .....core.elements.volumes.solid import Solid, rotate_material
from .....core.errors import Place
from ...deck.bulk import Bulk
from ...deck.card_definition import Card, Values
from ...properties.materials import elastic
from ..element_group import Context, Group, Key, with_material
from ..placed_elements import Placed

CARD = Card(
    "PCOMPS",
    "PID:i! CORDM:i=0 PSDIR:i=13 SB:r NB:r TREF:r=0. GE:r=0. / "
    "[GPLYID:i MID:i! T:r THETA:r=0. FT:w ILMT:iw SOUT:w TFLG:w]",
    "pid",
)

UNKNOWN = "Nastran's law of {} with solid laminates is not known"


def of_several(bulk: Bulk, key: Key) -> bool:
    """Whether a property is a PCOMPS whose plies differ in material or angle."""
    if key[0] != "PCOMPS":
        return False
    card = bulk.table(key[0])[key[1]]
    if not card.mid:
        raise bulk.place(*key).error("has no plies")
    return len(set(zip(card.mid, card.theta, strict=True))) > 1


def ply_axes(card: Values, place: Place) -> Floats:
    """Material axes of the plies, rows in the system CORDM, (plies, 3, 3).

    PSDIR names the directions of the plies and of their stack among those of CORDM, THETA turns
    the first about the second.

    Raises
    ------
    InputError
        PSDIR does not name two directions.
    """
    first, last = divmod(card.psdir, 10)
    if not {first, last} <= {1, 2, 3} or first == last:
        raise place.error(f"PSDIR {card.psdir} is not one of 12, 13, 21, 23, 31, 32")
    ply, stack = np.eye(3)[first - 1], np.eye(3)[last - 1]
    across = np.cross(stack, ply)
    c, s = (f(np.radians(card.theta))[:, None] for f in (np.cos, np.sin))
    axes = [c * ply + s * across, c * across - s * ply, np.broadcast_to(stack, (len(c), 3))]
    return np.stack(axes, axis=1)


def laminated(context: Context, solid: Placed) -> Group:
    """Make the group of elements of several plies."""
    element, keys, of, xyz = solid.element, solid.keys, solid.of, solid.xyz
    bulk, name = context.bulk, solid.name
    place = bulk.place(name, int(solid.ids[0]))
    if not isinstance(element, Solid) or element.shape not in (HEXA, PENTA):
        raise place.fault("cannot have plies of several materials or angles: CHEXA and CPENTA can")
    for number in np.unique(of):
        context.notes.append(
            f"{bulk.place(*keys[number])}: {UNKNOWN.format(name)}; plies of one strain along and "
            "one stress across the stack stand for it"
        )
    axis, against = _stack(context, solid)

    def matrices(values: Bulk, rows: Ints, wanted: tuple[bool, bool]) -> Matrices:
        k = 3 * element.nodes
        K, rho = np.zeros((len(rows), k, k)), np.zeros(len(rows))
        for number, along, turned in set(zip(of[rows], axis[rows], against[rows], strict=True)):
            at = np.flatnonzero((of[rows] == number) & (axis[rows] == along))
            at = at[against[rows[at]] == turned]
            C, share, density = _plies(context, values, keys[number], xyz[rows[at]])
            rho[at] = density
            if wanted[0]:
                order = slice(None, None, -1 if turned else 1)
                K[at] = layered_stiffness(
                    element, xyz[rows[at]], C[:, order], share[order], int(along)
                )
        return (
            solid.of_nodes_there(K) if wanted[0] else None,
            solid.mass(rows, rho, context.settings.coupled) if wanted[1] else None,
        )

    sources = tuple(with_material(bulk, key) for key in keys)
    return Group(name, solid.ids, element, solid.nodes, matrices, sources, of)


def _stack(context: Context, solid: Placed) -> tuple[Ints, Ints]:
    """Natural axis of each element that lies nearest to the stack, and whether against it."""
    element, xyz = solid.element, solid.xyz
    assert isinstance(element, Solid)
    corners = xyz[:, : element.corners]
    half = element.corners // 2
    below, above = corners[:, :half], corners[:, half:]
    natural = [above.mean(axis=1) - below.mean(axis=1)]
    if element.shape is HEXA:
        both = below + above
        for ends in (([1, 2], [0, 3]), ([2, 3], [0, 1])):
            natural.append((both[:, ends[0]] - both[:, ends[1]]).mean(axis=1))
    J = np.stack(natural, axis=1)
    J = J / np.linalg.norm(J, axis=2, keepdims=True)
    stack = np.zeros((len(xyz), 3))
    for number, key in enumerate(solid.keys):
        rows = np.flatnonzero(solid.of == number)
        card, place = context.bulk.table(key[0])[key[1]], context.bulk.place(*key)
        directions = context.points.frames.get(card.cordm, place).directions(
            corners[rows].mean(axis=1)
        )
        stack[rows] = transpose(directions) @ ply_axes(card, place)[0, 2]
    along = np.einsum("nki,ni->nk", J, stack)
    nearest = np.abs(along).argmax(axis=1)
    off = np.take_along_axis(along, nearest[:, None], axis=1)[:, 0]
    if (np.abs(off) < 0.5).any():
        bad = int(solid.ids[np.flatnonzero(np.abs(off) < 0.5)[0]])
        raise context.bulk.place(solid.name, bad).error(
            "the direction of the stack (PSDIR) lies across its triangles: plies lie on each other "
            "along the axis of a CPENTA"
        )
    return np.array([2, 0, 1])[nearest], (off < 0.0).astype(np.int64)


def _plies(context: Context, values: Bulk, key: Key, xyz: Floats) -> tuple[Floats, Floats, float]:
    """Elastic matrices of the plies (n, plies, 6, 6), shares of the thickness, mean density."""
    card, place = values.table(key[0])[key[1]], context.bulk.place(*key)
    t = np.array([x or 0.0 for x in card.t])
    if not (t > 0.0).all():
        raise place.error("every ply needs a positive thickness")
    found = [elastic(values, mid, place) for mid in card.mid]
    directions = context.points.frames.get(card.cordm, place).directions(xyz.mean(axis=1))
    axes = ply_axes(card, place)[None] @ directions[:, None]
    C = np.stack(
        [
            np.broadcast_to(m.C, (len(xyz), 6, 6))
            if m.isotropic
            else rotate_material(np.broadcast_to(m.C, (len(xyz), 6, 6)), axes[:, k])
            for k, m in enumerate(found)
        ],
        axis=1,
    )
    share = t / t.sum()
    return C, share, float(share @ [m.rho for m in found])
