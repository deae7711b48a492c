"""Shells: CQUAD4, CTRIA3, CQUADR, CTRIAR, CQUAD8, CTRIA6."""

from typing import NamedTuple

import numpy as np

from .....core.arrays import Floats, Ints, Matrices
from .....core.elements.surfaces.normals import corner_normals, grid_normals
from .....core.elements.surfaces.section import ShellSection, rotate_section
from ...deck.bulk import Bulk
from ...deck.card_definition import Card, Values
from ...deck.movable_values import Moves
from ...properties import laminates
from ...properties.laminates import Layup, layup
from ..element_group import Context, Group, element_sources
from ..placed_elements import Placed, placed

_HEAD = "EID:i! PID:i=EID"
_PLACE = "THETA:ir=0. ZOFFS:r=0."
_QUAD4 = f"{_HEAD} G1,G2,G3,G4>nodes:i! {_PLACE} - TFLAG:i=0 T1,T2,T3,T4>t:r"
_TRIA3 = f"{_HEAD} G1,G2,G3>nodes:i! {_PLACE} - - TFLAG:i=0 T1,T2,T3>t:r"

_QUAD8 = f"{_HEAD} G1,G2,G3,G4>nodes:i! G5,G6,G7,G8>nodes:i T1,T2,T3,T4>t:r {_PLACE} TFLAG:i=0"
_TRIA6 = f"{_HEAD} G1,G2,G3>nodes:i! G4,G5,G6>nodes:i {_PLACE} T1,T2,T3>t:r TFLAG:i=0"
_ELEMENTS = (
    ("CQUAD4", _QUAD4, "quad4"),
    ("CTRIA3", _TRIA3, "tria3"),
    ("CQUADR", _QUAD4, "quadr"),
    ("CTRIAR", _TRIA3, "triar"),
    ("CQUAD8", _QUAD8, "quad8"),
    ("CTRIA6", _TRIA6, "tria6"),
)

CARDS = (
    *(
        Card(
            name,
            layout,
            "eid",
            elements=element,
            properties="PSHELL PCOMP PCOMPG",
            moves=Moves(),
        )
        for name, layout, element in _ELEMENTS
    ),
    *laminates.CARDS,
)

_WARPED = 0.05
"""Height of a quad's corners over their mean plane beside its diagonal, from which it is said."""

_FROM_AXES = ("CQUAD8",)
"""Whose THETA counts from the element's x axis; from side 1-2 on the others."""


class _Facts(NamedTuple):
    """What of shells does not depend on parameters; one value an element."""

    angle: Floats  # from the element's x axis to the material's [rad], about the normal
    own: Floats  # mean thickness is own + share * T: corners may have thicknesses of their own
    share: Floats


def shells(context: Context) -> list[Group]:
    """Make the groups of shells: of every card that may have a PSHELL and is laid out alike."""
    found = list(placed(context, "PSHELL"))
    for shell in found:
        _note_warped(context, shell.name, shell.ids, shell.xyz[:, : shell.element.corners])
    flat = [shell for shell in found if not len(shell.element.edges)]
    normals = dict(zip(map(id, flat), _normals(context, flat), strict=True))
    return [_group(context, shell, normals.get(id(shell))) for shell in found]


def _normals(context: Context, flat: list[Placed]) -> list[Floats | None]:
    """Average the normals of all flat shells at their grids (PARAM,SNORM), (n, m, 3) each."""
    limit = context.settings.snorm
    if limit <= 0.0 or not flat:
        return [None] * len(flat)
    corners = [shell.nodes[:, : shell.element.corners] for shell in flat]
    every = np.concatenate([c.reshape(-1) for c in corners])
    normal = [corner_normals(_axes(s), s.element.corners) for s in flat]
    averaged = grid_normals(every, np.concatenate(normal), len(context.points.ids), limit)
    return [averaged[c] for c in corners]


def _axes(shell: Placed) -> Floats:
    assert shell.element.axes is not None
    return shell.element.axes(shell.xyz)


def _group(context: Context, shell: Placed, normals: Floats | None) -> Group:
    bulk, element, ids, keys = context.bulk, shell.element, shell.ids, shell.keys
    own, share = _thickness(shell.cards, element.corners)
    any_thickness = [layup(bulk, key, bulk.place(*key), own=1.0, share=0.0) for key in keys]
    turned = np.array([not section.isotropic for section in any_thickness])[shell.of]
    angle = np.zeros(len(ids))
    if turned.any():
        angle[turned] = _material_angle(context, shell, np.flatnonzero(turned))
    off = _offsets(shell.cards)
    every, moved = _Facts(angle, own, share), context.moved_of(shell.name, ids)
    if context.settings.coupled and shell.name in ("CQUADR", "CTRIAR"):
        context.notes.append(
            f"the mass of {shell.name} is coupled (COUPMASS): MSC's guide does not list it among "
            "the elements whose mass is, and another Nastran's does"
        )
    of_property = [
        frozenset([key, *section.materials])
        for key, section in zip(keys, any_thickness, strict=True)
    ]
    sources, source_of = element_sources(context, shell.name, ids, of_property, shell.of)

    def _at(values: Bulk, rows: Ints) -> tuple[_Facts, Floats]:
        """Facts and offsets where some of these elements are moved themselves."""
        table = values.table(shell.name)
        now = [table[int(ids[k])] for k in rows]
        own_now, share_now, off_now = own.copy(), share.copy(), off.copy()
        own_now[rows], share_now[rows] = _thickness(now, element.corners)
        off_now[rows] = _offsets(now)
        return _Facts(angle, own_now, share_now), off_now

    def matrices(values: Bulk, rows: Ints, wanted: tuple[bool, bool]) -> Matrices:
        facts, offset = (every, off) if not moved[rows].any() else _at(values, rows)
        section, density = _sections_of(shell, facts, values, rows)
        K = M = None
        if wanted[0]:
            at_corners = None if normals is None else normals[rows]
            settings = context.settings
            K = element.stiffness(
                shell.xyz[rows], section, settings.k6rot, offset[rows], at_corners
            )
            K = shell.of_nodes_there(K)
        if wanted[1]:
            density = density + context.extra_mass(values, ids[rows])
            M = shell.mass(rows, density, context.settings.coupled)
        return K, M

    return Group(shell.name, ids, element, shell.nodes, matrices, sources, source_of)


def _sections_of(
    shell: Placed, facts: _Facts, bulk: Bulk, rows: Ints
) -> tuple[ShellSection, Floats]:
    """Sections in element axes and mass per area of each element.

    Elements with the same property and no thickness of their own share one layup.
    """
    distinct, position = _distinct(
        np.column_stack([shell.of[rows], facts.own[rows], facts.share[rows]])
    )
    layups: list[Layup] = []
    for number, own, share in distinct:
        key = shell.keys[int(number)]
        layups.append(layup(bulk, key, bulk.place(*key), float(own), float(share)))
    section = ShellSection(
        **{
            name: np.array([getattr(part, name) for part in layups])
            for name in ("A", "B", "D", "S")
        }
    ).take(position)
    if facts.angle[rows].any():
        section = rotate_section(section, facts.angle[rows])
    return section, np.array([part.density for part in layups])[position]


def _offsets(cards: list[Values]) -> Floats:
    return np.array([c.zoffs for c in cards], dtype=np.float64)


def _distinct(table: Floats) -> tuple[Floats, Ints]:
    """Distinct rows, and which each row is; quick where all are the same."""
    if (table == table[0]).all():
        return table[:1], np.zeros(len(table), dtype=np.int64)
    distinct, position = np.unique(table, axis=0, return_inverse=True)
    return distinct, position.reshape(-1)


def _thickness(cards: list[Values], corners: int) -> tuple[Floats, Floats]:
    """Mean thickness of each element as ``own + share * T``."""
    own, share = np.zeros(len(cards)), np.ones(len(cards))
    for k, card in enumerate(cards):
        given = card.t
        if all(t is None for t in given):
            continue
        if card.tflag:  # relative to the property's thickness
            share[k] = sum(1.0 if t is None else t for t in given) / corners
        else:
            own[k] = sum(0.0 if t is None else t for t in given) / corners
            share[k] = sum(t is None for t in given) / corners
    return own, share


def _material_angle(context: Context, shell: Placed, rows: Ints) -> Floats:
    """Angle from the element's x axis to the material's [rad], of the elements `rows`.

    THETA counts from side 1-2 (CQUAD8: from the element's x axis); a coordinate system (MCID)
    gives the material's x axis by its own, projected on the element.
    """
    xyz, axes = shell.xyz[rows], _axes(shell)[rows]
    cards = [shell.cards[k] for k in rows]
    side = xyz[:, 1] - xyz[:, 0]
    x, y, z = axes[:, 0], axes[:, 1], axes[:, 2]
    base = np.zeros(len(rows))
    if shell.name not in _FROM_AXES:
        base = np.arctan2((side * y).sum(axis=1), (side * x).sum(axis=1))
    by_system = np.array([isinstance(c.theta, int) for c in cards])
    theta = np.radians([0.0 if s else c.theta for c, s in zip(cards, by_system, strict=True)])
    angle: Floats = base + theta
    centre = xyz[:, : shell.element.corners].mean(axis=1)
    for k in np.flatnonzero(by_system):
        place = context.bulk.place(shell.name, cards[k].eid)
        frame = context.points.frames.get(cards[k].theta, place)
        direction = frame.directions(centre[k : k + 1])[0, 0]
        flat = direction - (direction @ z[k]) * z[k]
        if np.linalg.norm(flat) < 1e-6:
            raise place.error(
                "the x axis of the material coordinate system is normal to the element"
            )
        angle[k] = np.arctan2(flat @ y[k], flat @ x[k])
    return angle


def _note_warped(context: Context, name: str, ids: Ints, xyz: Floats) -> None:
    """Say which quads have corners far off their mean plane (Nastran's GEOMCHECK Q4_WARP)."""
    if xyz.shape[1] != 4:
        return
    d1, d2 = xyz[:, 2] - xyz[:, 0], xyz[:, 3] - xyz[:, 1]
    normal = np.cross(d1, d2)
    off = 0.25 * (xyz[:, 0] - xyz[:, 1] + xyz[:, 2] - xyz[:, 3])
    height = np.abs((off * normal).sum(axis=1)) / np.linalg.norm(normal, axis=1)
    diagonal = 0.5 * (np.linalg.norm(d1, axis=1) + np.linalg.norm(d2, axis=1))
    factor = height / diagonal
    warped = np.flatnonzero(factor > _WARPED)
    if not len(warped):
        return
    worst = int(warped[np.argmax(factor[warped])])
    others = f" (and {len(warped) - 1} more elements less so)" if len(warped) > 1 else ""
    context.notes.append(
        f"{context.bulk.place(name, int(ids[worst]))} is warped: its corners stand "
        f"{100.0 * factor[worst]:.0f} % of its diagonal off their mean plane{others}"
    )
