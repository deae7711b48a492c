"""Bushings and gaps: CBUSH, CBUSH1D, CGAP."""

from collections.abc import Callable, Sequence
from typing import Any, NamedTuple

import numpy as np

from .....core.arrays import Floats, Ints, Matrices
from .....core.elements.connectors.lumped import BUSH, GROUNDED_BUSH, bush_stiffness
from .....core.errors import Place
from ...deck.bulk import Bulk
from ...deck.card_definition import Card, Known, Values
from ...deck.field_values import FieldError, Fields, take
from ...deck.movable_values import Moves, Read, Variable
from ..element_group import Context, Group, connected

Six = Callable[[Values], Sequence[float]]
"""The six stiffnesses or dampings of a property."""

_NO_OTHER = (0.0,) * 5
_OPEN = 1e-14
"""Stiffness of an open gap beside that of the closed one, where PGAP does not say it."""

_LINES = {
    "K": ("k", [f"K{n}:r=0." for n in range(1, 7)]),
    "B": ("b", [f"B{n}:r=0." for n in range(1, 7)]),
    "GE": ("ge", [f"GE{n}:r=0." for n in range(1, 7)]),
    "RCV": ("rcv", ["SA:r=1.", "ST:r=1.", "EA:r=1.", "ET:r=1."]),
    "T": ("alpha", ["ALPHA:r=0.", "TREF:r=0.", "COINL:r=0."]),
    "M": ("m", ["M:r=0."]),
}


def _lines(fields: Fields, _: Known) -> list[Any]:
    """Read a PBUSH: each line starts with the word that says what it holds.

    GE1 without any other holds for all directions, `apart` says that it does not: a zero that is
    written is not a blank there (Quick Reference Guide, PBUSH).
    """
    out: dict[str, Any] = {name: (0.0,) * len(words) for name, words in _LINES.values()}
    out["apart"] = False
    for start in range(2, len(fields), 8):
        flag = take(fields, start, "K, B, GE, RCV, T or M:w!")
        if flag not in _LINES:
            raise FieldError(start, flag, "is none of K, B, GE, RCV, T, M")
        name, words = _LINES[flag]
        out[name] = tuple(take(fields, start + k, w) for k, w in enumerate(words, start=1))
        if flag == "GE":
            out["apart"] = any(fields[start + 2 : start + 7])
    out["m"] = out["m"][0]
    return list(out.values())


_PLACES = {
    word.partition(":")[0]: (flag, column)
    for flag, (_, words) in _LINES.items()
    for column, word in enumerate(words, start=4)
    if flag != "T"
}
"""Values of a PBUSH: the flag of their line and their column in it."""


def _find(name: str, read: Read) -> int | None:
    flag, column = _PLACES[name]
    lines = [line for line in range(8) if read(10 * line + 3) == flag]
    return 10 * lines[0] + column if lines else None


_SIX = tuple(f"K{n}" for n in range(1, 7))
_VARIABLE = Variable(tuple(_PLACES), _PLACES.__contains__, _find)

CARDS = (
    Card(
        "CBUSH",
        "EID:i! PID:i=EID GA>nodes:i! GB>nodes:i X1,X2,X3>x:ir CID:i / S:r=0.5 OCID:i=-1 "
        "S1,S2,S3>si:r=0.",
        "eid",
        elements="bush",
        properties="PBUSH",
    ),
    Card(
        "CBUSH1D",
        "EID:i! PID:i=EID GA>nodes:i! GB>nodes:i CID:i",
        "eid",
        elements="bush",
        properties="PBUSH1D",
    ),
    Card(
        "PBUSH",
        "PID:i!",
        "pid",
        more=_lines,
        extra="k b ge rcv alpha m apart",
        companions="PBUSHT",
        moves=Moves(linear=_SIX, concentrated=_SIX, variable=_VARIABLE),
    ),
    Card(
        "PBUSH1D",
        "PID:i! K:r=0. C:r=0. M:r=0. - SA:r=0. SE:r=0. ...",
        "pid",
        moves=Moves(concentrated=("K",)),
    ),
    Card(
        "CGAP",
        "EID:i! PID:i=EID GA,GB>nodes:i! X1,X2,X3>x:ir CID:i",
        "eid",
        elements="bush",
        properties="PGAP",
    ),
    Card(
        "PGAP",
        "PID:i! U0:r=0. F0:r=0. KA:r! KB:r KT:r MU1:r=0. MU2:r=MU1 TMAX:r=0. MAR:r=100. "
        "TRMIN:r=.001",
        "pid",
        moves=Moves(concentrated=("KA",)),
    ),
)


class _Bush(NamedTuple):
    """Geometry of one bushing."""

    axes: Floats  # (3, 3), rows are the element axes, basic frame
    arms: list[Floats]  # from each grid to the spring
    axial_only: bool  # no orientation was given: only K1 and K4 have a meaning


def bushes(context: Context) -> list[Group]:
    """Make the groups of CBUSH and CBUSH1D, between two grids or one and the ground, and CGAP."""
    if context.bulk.table("CGAP"):
        closed = [_is_closed(p) for p in context.bulk.table("PGAP").values()]
        context.notes.append(
            f"CGAP stand as they do at the start: {sum(closed)} properties (PGAP) closed, "
            f"{len(closed) - sum(closed)} open"
        )
    stiffnesses: dict[str, Six] = {"CBUSH": lambda p: p.k, "CBUSH1D": lambda p: (p.k, *_NO_OTHER)}
    return _groups(context, {**stiffnesses, "CGAP": _gap})


def _is_closed(gap: Values) -> bool:
    return bool(gap.u0 <= 0.0)


def _gap(gap: Values) -> Sequence[float]:
    """Stiffnesses of a gap as it stands at the start, as in linear solutions."""
    if not _is_closed(gap):
        return (_OPEN * gap.ka if gap.kb is None else gap.kb, *_NO_OTHER)
    lateral = gap.mu1 * gap.ka if gap.kt is None else gap.kt
    return (gap.ka, lateral, lateral, 0.0, 0.0, 0.0)


def bush_dampers(context: Context) -> list[Group]:
    """Make the same groups with their dampings in place of stiffnesses."""
    return _groups(context, {"CBUSH": lambda p: p.b, "CBUSH1D": lambda p: (p.c, *_NO_OTHER)})


def _groups(context: Context, values_of: dict[str, Six]) -> list[Group]:
    groups = []
    for name, values in values_of.items():
        cards = list(context.bulk.table(name).values())
        for grounded in (False, True):
            chosen = [c for c in cards if (not c.nodes[1]) == grounded]
            if chosen:
                groups.append(_group(context, name, values, chosen, grounded))
    return groups


def _group(context: Context, name: str, values: Six, cards: list[Values], grounded: bool) -> Group:
    bulk = context.bulk
    grids = [[c.nodes[0]] if grounded else c.nodes for c in cards]
    ids, ends, keys, of = connected(context, name, cards, grids)
    bushes = [_geometry(context, name, c, e) for c, e in zip(cards, ends, strict=True)]
    axes = np.stack([b.axes for b in bushes])
    arm_a, arm_b = (np.stack([b.arms[k] for b in bushes]) for k in (0, -1))
    size = 6 * ends.shape[1]
    deck = [values(bulk.table(card)[number]) for card, number in keys]
    for eid, bush, k in zip(ids, bushes, of, strict=True):
        if bush.axial_only and any(deck[k][i] for i in (1, 2, 4, 5)):
            raise bulk.place(name, int(eid)).fault(
                "has lateral stiffness but neither an orientation vector nor CID: give one of them"
            )
    half = np.array([[0.5, 0.5], [1.0, 0.0]])[int(grounded), : ends.shape[1]]

    def matrices(current: Bulk, rows: Ints, wanted: tuple[bool, bool]) -> Matrices:
        used, position = np.unique(of[rows], return_inverse=True)
        properties = [current.table(keys[k][0])[keys[k][1]] for k in used]
        K = M = None
        if wanted[0]:
            k = np.array([values(p) for p in properties])[position]
            K = bush_stiffness(axes[rows], k, arm_a[rows], arm_b[rows])[:, :size, :size]
        if wanted[1]:
            mass = np.array([getattr(p, "m", 0.0) for p in properties])[position]
            if mass.any():
                pattern = np.repeat(half, 6) * np.tile([1.0, 1, 1, 0, 0, 0], len(half))
                M = mass[:, None, None] * np.diag(pattern)
        return K, M

    sources = tuple(frozenset([key]) for key in keys)
    element = GROUNDED_BUSH if grounded else BUSH
    return Group(name, ids, element, ends, matrices, sources, of)


def _geometry(context: Context, name: str, card: Values, ends: Ints) -> _Bush:
    xyz = context.points.xyz[ends]
    place = context.bulk.place(name, card.eid)
    line = xyz[1] - xyz[0] if len(ends) == 2 else np.zeros(3)
    apart = bool(np.linalg.norm(line) > 1e-9 * np.ptp(context.points.xyz, axis=0).max(initial=0.0))
    axes, axial_only = _axes(context, name, card, int(ends[0]), line if apart else None, place)
    if name == "CBUSH" and card.ocid >= 0:
        frame = context.points.frames.get(card.ocid, place)
        at = xyz[0] + np.array(card.si) @ frame.directions(xyz[:1])[0]
    else:
        at = xyz[0] + (card.s if name == "CBUSH" else 0.0) * line
    if name == "CGAP":  # translations only, and the same stiffness in all lateral directions
        return _Bush(axes, [np.zeros(3)] * 2, False)
    return _Bush(axes, [at - x for x in xyz], axial_only)


def _axes(
    context: Context, name: str, card: Values, row: int, line: Floats | None, place: Place
) -> tuple[Floats, bool]:
    """Axes from CID, else from the line of the grids and the orientation vector."""
    if card.cid is not None:
        frame = context.points.frames.get(int(card.cid), place)
        return frame.directions(context.points.xyz[row : row + 1])[0], False
    if line is None:
        raise place.error("its grids coincide or it is grounded, so it needs CID")
    v = _vector(context, card, row, place) if name == "CBUSH" else None
    axial_only = v is None
    if v is None:
        v = np.eye(3)[np.argmin(np.abs(line))]
    z = np.cross(line, v)
    if not np.linalg.norm(z) > 1e-9 * np.linalg.norm(line) * np.linalg.norm(v):
        raise place.error("its orientation vector is zero or runs along the element")
    x, z = line / np.linalg.norm(line), z / np.linalg.norm(z)
    return np.stack([x, np.cross(z, x), z]), axial_only


def _vector(context: Context, card: Values, row: int, place: Place) -> Floats | None:
    """Orientation vector, basic frame; None where the card gives none."""
    if isinstance(card.x[0], int):
        g0 = context.points.row(card.x[0], place)
        return np.asarray(context.points.xyz[g0] - context.points.xyz[row])
    if card.x == (None, None, None):
        return None
    x = np.array([v or 0.0 for v in card.x])
    return np.asarray(x @ context.points.directions[row])
