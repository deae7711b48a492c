"""Spot welds and fasteners between shells: CWELD, CFAST."""

from collections.abc import Iterator
from typing import NamedTuple

import numpy as np

from .....core.arrays import Floats, Ints, Matrices
from .....core.elements.connectors.lumped import BUSH, bush_stiffness
from .....core.elements.connectors.patches import PATCH_CONNECTOR, Foot, foot, patch_stiffness
from .....core.elements.lines.bar import bar_stiffness
from .....core.errors import Place
from ...deck.bulk import Bulk
from ...deck.card_definition import Card, Values
from ...deck.movable_values import Moves
from ...properties.materials import isotropic
from ..element_group import Context, Group, Key, property_key, with_material

_SHELLS = ("CQUAD4", "CTRIA3", "CQUADR", "CTRIAR", "CQUAD8", "CTRIA6")
_REACH = 0.05
"""How far beyond an edge, in natural coordinates, a point may fall (rounding of positions)."""
_SHEAR = (0.9, 0.9)
"""Shear areas of a round section."""
_NO_LENGTH = 1e-6
"""Of the diameter: length of a weld whose ends coincide."""

CARDS = (
    Card(
        "CWELD",
        "EID:i! PID:i=EID GS:i FORMAT:w! GA,GB>ends:i MCID:x SPTYP:x "
        "/ A1,A2,A3,A4,A5,A6,A7,A8>a:i / B1,B2,B3,B4,B5,B6,B7,B8>b:ir",
        "eid",
        grids="gs ends",
        elements="patch_connector",
        properties="PWELD",
    ),
    Card(
        "CFAST",
        "EID:i! PID:i=EID TYPE>format:w! IDA,IDB>a:i! GS:i GA,GB>ends:i / XS,YS,ZS>b:r",
        "eid",
        grids="gs ends",
        elements="patch_connector",
        properties="PFAST",
    ),
    Card(
        "PWELD",
        "PID:i! MID:i! D:r! - - MSET:w - TYPE:w / LDMIN:r=.2 LDMAX:r=5.",
        "pid",
        moves=Moves(concentrated=("D",)),
    ),
    Card(
        "PFAST",
        "PID:i! D:r! MCID:i=-1 MFLAG:i=0 KT1,KT2,KT3,KR1,KR2,KR3>k:r=0. MASS:r=0. GE:r=0.",
        "pid",
        moves=Moves(concentrated=("KT1", "KT2", "KT3")),
    ),
)


class _Patch(NamedTuple):
    """Grid rows of a surface patch, and the thickness of its shell (0 where it is not known)."""

    rows: Ints
    thickness: float


class _Joint(NamedTuple):
    """One connector: where it meets its patches."""

    feet: tuple[Foot, Foot]
    thickness: float  # mean of both shells; 0 where it is not known or does not matter


def fasteners(context: Context) -> list[Group]:
    """Make the groups of CWELD and CFAST, by the numbers of grids of both patches."""
    groups = []
    for name in ("CWELD", "CFAST"):
        by_size: dict[tuple[int, int], list[tuple[Values, Ints, _Joint]]] = {}
        for card in context.bulk.table(name).values():
            place = context.bulk.place(name, card.eid)
            aligned = card.format == "ALIGN"
            rows, joint = (_aligned if aligned else _pierced)(context, card, place)
            member = (card, np.concatenate(rows), joint)
            by_size.setdefault((len(rows[0]), len(rows[1])), []).append(member)
        groups += [_group(context, name, members) for members in by_size.values()]
    return groups


def _group(context: Context, name: str, members: list[tuple[Values, Ints, _Joint]]) -> Group:
    cards, nodes, joints = zip(*members, strict=True)
    keys = [property_key(context.bulk, name, c.eid, c.pid) for c in cards]
    motion = np.stack([_motion(joint) for joint in joints])

    def matrices(values: Bulk, rows: Ints, wanted: tuple[bool, bool]) -> Matrices:
        K = M = None
        chosen = [(values, keys[r], joints[r]) for r in rows]
        if wanted[0]:
            ends = np.concatenate([_ends(context, *one) for one in chosen])
            K = patch_stiffness(ends, motion[rows])
        mass = np.array([getattr(values.table(k[0])[k[1]], "mass", 0.0) for _, k, _ in chosen])
        if wanted[1] and mass.any():
            half = np.tile([0.5, 0.5, 0.5, 0.0, 0.0, 0.0], 2)
            M = patch_stiffness(mass[:, None, None] * np.diag(half), motion[rows])
        return K, M

    ids = np.array([c.eid for c in cards], dtype=np.int64)
    sources = tuple(with_material(context.bulk, key) for key in keys)
    of = np.arange(len(ids))
    rows = np.stack(nodes)
    element = BUSH if rows.shape[1] == 2 else PATCH_CONNECTOR
    return Group(name, ids, element, rows, matrices, sources, of)


def _motion(joint: _Joint) -> Floats:
    """Six motions of both ends from the translations of the grids of both patches."""
    a, b = (f.motion for f in joint.feet)
    return np.block([[a, np.zeros((6, b.shape[1]))], [np.zeros((6, a.shape[1])), b]])


def _ends(context: Context, bulk: Bulk, key: Key, joint: _Joint) -> Floats:
    """Stiffness between the ends, (1, 12, 12)."""
    card, place = bulk.table(key[0])[key[1]], bulk.place(*key)
    a, b = joint.feet
    line = b.point - a.point
    length = float(np.linalg.norm(line))
    along = line / length if length > _NO_LENGTH * card.d else a.normal
    across = np.eye(3)[np.argmin(np.round(np.abs(along), 6))]
    if key[0] == "PFAST":
        axes = _axes(context, card, along, across, a.point, place)
        arm = 0.5 * line
        return bush_stiffness(axes[None], np.array([card.k]), arm[None], -arm[None])
    length = max(length, _NO_LENGTH * card.d)
    effective = min(max(length, card.ldmin * card.d), card.ldmax * card.d)
    if card.type == "SPOT" and joint.thickness > 0.0:
        effective = joint.thickness
    E, G, *_ = isotropic(bulk, card.mid, place)
    area, inertia = np.pi * card.d**2 / 4.0, np.pi * card.d**4 / 64.0
    softer = length / effective
    values = (E * softer, G * softer, area, inertia, inertia, 0.0, 2.0 * inertia, *_SHEAR)
    free = np.zeros((1, 6), dtype=bool)
    ends = (a.point, a.point + length * along, across)
    asked = [*(x[None] for x in ends), *(np.full(1, v) for v in values), free, free]
    return bar_stiffness(*asked)


def _axes(
    context: Context, card: Values, along: Floats, across: Floats, at: Floats, place: Place
) -> Floats:
    """Directions of KT1, KT2, KT3: along the fastener, or those of MCID."""
    if card.mcid >= 0:
        frame = context.points.frames.get(card.mcid, place).directions(at[None])[0]
        if not card.mflag:
            return np.asarray(frame)
        across = frame[1]
    y = across - along * (along @ across)
    if not np.linalg.norm(y) > 1e-9:
        raise place.error("the second axis of MCID runs along the fastener")
    y = y / np.linalg.norm(y)
    return np.stack([along, y, np.cross(along, y)])


def _aligned(context: Context, card: Values, place: Place) -> tuple[list[Ints], _Joint]:
    """Take a weld from grid to grid."""
    rows = [np.array([context.points.row(g or 0, place)]) for g in card.ends]
    at = [context.points.xyz[r[0]] for r in rows]
    if not np.linalg.norm(at[1] - at[0]) > 0.0:
        raise place.error("its grids coincide")
    a, b = (Foot(x, np.zeros(3), np.eye(6), 0.0) for x in at)
    return rows, _Joint((a, b), 0.0)


def _pierced(context: Context, card: Values, place: Place) -> tuple[list[Ints], _Joint]:
    """Find both patches of a connector and where it meets them."""
    xyz = context.points.xyz
    start = _location(context, card, place)
    patches, feet = [], []
    for side, grid in enumerate(card.ends):
        point = xyz[context.points.row(grid, place)] if grid else start
        choice = _patches(context, card, side, place)
        found = min(choice, key=lambda patch: _distance(xyz[patch.rows], point))
        patches.append(found)
        feet.append(foot(xyz[found.rows], point))
    if max(f.outside for f in feet) > _REACH:
        raise place.error("it does not pierce both of its patches: check where it is")
    return [p.rows for p in patches], _Joint(
        (feet[0], feet[1]), 0.5 * sum(p.thickness for p in patches)
    )


def _distance(xyz: Floats, point: Floats) -> float:
    """Distance of a point from a patch, those that it does not fall on last."""
    at = foot(xyz, point)
    size = np.ptp(xyz, axis=0).max()
    return float(np.linalg.norm(at.point - point) + 1e3 * size * max(at.outside - _REACH, 0.0))


def _location(context: Context, card: Values, place: Place) -> Floats:
    """GS, else XS, YS, ZS in the basic frame, else GA."""
    if card.gs:
        return np.asarray(context.points.xyz[context.points.row(card.gs, place)])
    given = card.b[:3]
    if all(isinstance(v, float) for v in given):
        return np.array(given)
    if card.ends[0]:
        return np.asarray(context.points.xyz[context.points.row(card.ends[0], place)])
    raise place.error("has neither GS nor GA nor XS, YS, ZS that say where it is")


def _patches(context: Context, card: Values, side: int, place: Place) -> Iterator[_Patch]:
    """Patches that may be meant on one side: of a list of grids, an element or a property."""
    if card.format == "GRIDID":
        grids = [g for g in (card.a, card.b)[side] if g]
        if len(grids) not in (3, 4) or not all(isinstance(g, int) for g in grids):
            raise place.error("GRIDID is supported for patches of three or four grids on each side")
        yield _Patch(np.array([context.points.row(g, place) for g in grids]), 0.0)
        return
    number = card.a[side]
    if card.format in ("ELEMID", "ELPAT", "ELEM"):
        found = context.bulk.find(_SHELLS, number or 0)
        if found is None:
            raise place.fault(f"refers to shell element {number}, which does not exist")
        yield _of_shell(context, *found)
        return
    if card.format not in ("PARTPAT", "PROP"):
        raise place.error(f"the format {card.format} is not supported")
    some = False
    for shell in _SHELLS:
        for element in context.bulk.table(shell).values():
            if element.pid == number:
                some = True
                yield _of_shell(context, shell, element)
    if not some:
        raise place.fault(f"refers to shell property {number}, which no element has")


def _of_shell(context: Context, name: str, element: Values) -> _Patch:
    corners = 4 if "QUAD" in name else 3
    place = context.bulk.place(name, element.eid)
    rows = np.array([context.points.row(g, place) for g in element.nodes[:corners]])
    found = context.bulk.find(("PSHELL", "PCOMP", "PCOMPG"), element.pid)
    t = 0.0 if found is None else found[1].t
    return _Patch(rows, float(sum(t) if isinstance(t, tuple) else t or 0.0))
