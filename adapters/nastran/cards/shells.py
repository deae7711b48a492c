"""Shells: CQUAD4, CTRIA3, CQUADR, CTRIAR, CQUAD8, CTRIA6."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from ....core import elements
from ....core.arrays import Floats, Ints
from ....core.assembly import Matrices
from ....core.elements import ShellSection
from ....core.errors import InputError
from ..cards import Bulk, Card
from ..laminates import Layup, layup
from .common import Context, Group, Key, distinct_properties, element_sources
from .middle_nodes import by_pattern, kept_nodes, nodes_of, spread
from .normals import shell_normals

SHELL_PROPERTIES = ("PSHELL", "PCOMP", "PCOMPG")

_WARPED = 0.05
"""Height of a quad's corners over their mean plane beside its diagonal, from which it is said."""


Stiffness = Callable[[Floats, ShellSection, float, Floats, Floats | None], Floats]
"""Positions, section, K6ROT, offset, grid normals."""


@dataclass(frozen=True, eq=False)
class Kernel:
    """What tells one shell from another.

    Parameters
    ----------
    shape : str
        For drawing.
    corners : int
        Number of corner nodes.
    edges : (m, 2) int
        Ends of the edge of each middle node.
    axes : callable
        Element axes from positions.
    stiffness : callable
        See `Stiffness`.
    mass : callable
        From positions, mass per area and whether it is coupled.
    from_side : bool
        Whether THETA counts from the side 1-2; otherwise from the element's x axis.
    """

    shape: str
    corners: int
    edges: Ints
    axes: Callable[[Floats], Floats]
    stiffness: Stiffness
    mass: Callable[[Floats, Floats, bool], Floats]
    from_side: bool = True

    @property
    def curved(self) -> bool:
        """Whether it has middle nodes and normals of its own."""
        return len(self.edges) > 0


def _quadr(
    xyz: Floats, section: ShellSection, _k6rot: float, offset: Floats, normals: Floats | None
) -> Floats:
    return elements.quadr_stiffness(xyz, section, offset, normals)


def _triar(
    xyz: Floats, section: ShellSection, _k6rot: float, offset: Floats, normals: Floats | None
) -> Floats:
    return elements.triar_stiffness(xyz, section, offset, normals)


def _quad8(
    xyz: Floats, section: ShellSection, _k6rot: float, offset: Floats, _normals: Floats | None
) -> Floats:
    return elements.quad8_stiffness(xyz, section, offset)


def _tria6(
    xyz: Floats, section: ShellSection, _k6rot: float, offset: Floats, _normals: Floats | None
) -> Floats:
    return elements.tria6_stiffness(xyz, section, offset)


_NO_EDGES = np.zeros((0, 2), dtype=np.int64)
_QUAD = ("quad", 4, _NO_EDGES, elements.quad4_axes)
_TRIA = ("tria", 3, _NO_EDGES, elements.tria3_axes)

KERNELS: dict[str, Kernel] = {
    "CQUAD4": Kernel(*_QUAD, elements.quad4_stiffness, elements.quad4_mass),
    "CTRIA3": Kernel(*_TRIA, elements.tria3_stiffness, elements.tria3_mass),
    "CQUADR": Kernel(*_QUAD, _quadr, elements.quad4_mass),
    "CTRIAR": Kernel(*_TRIA, _triar, elements.tria3_mass),
    "CQUAD8": Kernel(
        "quad", 4, elements.QUAD8_EDGES, elements.quad8_axes, _quad8, elements.quad8_mass, False
    ),
    "CTRIA6": Kernel(
        "tria", 3, elements.TRIA6_EDGES, elements.tria6_axes, _tria6, elements.tria6_mass
    ),
}


@dataclass(frozen=True, eq=False)
class _Elements:
    """Facts of the elements that do not depend on parameters.

    Parameters
    ----------
    angle : (n,) float
        From the element's x axis to the material's [rad], about the normal.
    own, share : (n,) float
        The mean thickness is ``own + share * T`` with T of the property: corners may have
        thicknesses of their own.
    offset : (n,) float
        ZOFFS.
    normals : (n, m, 3) float or None
        Of the grids at the corners, basic frame.
    spread : (n_node, n_there) float or None
        All nodes from those that are there (`middle_nodes.spread`).
    """

    ids: Ints
    xyz: Floats
    keys: list[Key]
    of: Ints
    angle: Floats
    own: Floats
    share: Floats
    offset: Floats
    normals: Floats | None
    spread: Floats | None


@dataclass(frozen=True, eq=False)
class _Placed:
    """Elements of one shape and where they stand."""

    name: str
    kernel: Kernel
    cards: list[Card]
    ids: Ints
    nodes: Ints
    xyz: Floats
    axes: Floats
    spread: Floats | None

    @property
    def corners(self) -> Ints:
        """Grid rows of the corners, (n, m)."""
        return self.nodes[:, : self.kernel.corners]


def shells(context: Context) -> list[Group]:
    """Make the groups of shells."""
    found = []
    for name, kernel in KERNELS.items():
        cards = list(context.bulk.table(name).values())
        for present, members in by_pattern(cards, kernel.corners).items():
            found.append(_place(context, name, kernel, members, present))
    flat = [f for f in found if not f.kernel.curved]
    normals = shell_normals(
        [f.corners for f in flat],
        [f.axes for f in flat],
        len(context.points.ids),
        context.settings.snorm,
    )
    of = {id(f): n for f, n in zip(flat, normals, strict=True)}
    return [_group(context, f, of.get(id(f))) for f in found]


def _place(
    context: Context, name: str, kernel: Kernel, cards: list[Card], present: tuple[bool, ...]
) -> _Placed:
    ids = np.array([c.eid for c in cards], dtype=np.int64)
    kept = kept_nodes(present, kernel.corners, kernel.corners + len(kernel.edges))
    nodes = context.points.rows(nodes_of(cards, kept), name, ids)
    T = spread(kernel.edges, kept)
    xyz = context.points.xyz[nodes]
    xyz = xyz if T is None else T @ xyz
    check_shape(context, name, ids, xyz[:, : kernel.corners])
    _note_warped(context, name, ids, xyz[:, : kernel.corners])
    return _Placed(name, kernel, cards, ids, nodes, xyz, kernel.axes(xyz), T)


def _group(context: Context, placed: _Placed, normals: Floats | None) -> Group:
    bulk = context.bulk
    name, kernel, cards, ids = placed.name, placed.kernel, placed.cards, placed.ids
    keys, of = distinct_properties(
        bulk, SHELL_PROPERTIES, name, ids, np.array([c.pid for c in cards])
    )
    own, share = _thickness(cards, kernel.corners)
    any_thickness = [layup(bulk, key, bulk.place(*key), own=1.0, share=0.0) for key in keys]
    turned = np.array([not section.isotropic for section in any_thickness])[of]
    angle = np.zeros(len(ids))
    if turned.any():
        angle[turned] = material_angle(context, placed, np.flatnonzero(turned))
    facts = _Elements(
        ids,
        placed.xyz,
        keys,
        of,
        angle,
        own,
        share,
        np.array([c.zoffset or 0.0 for c in placed.cards], dtype=np.float64),
        normals,
        None if placed.spread is None else np.kron(placed.spread, np.eye(6)),
    )
    of_property = [
        frozenset([key, *section.materials])
        for key, section in zip(keys, any_thickness, strict=True)
    ]
    sources, source_of = element_sources(context, ids, of_property, of)

    def matrices(values: Bulk, rows: Ints, wanted: tuple[bool, bool]) -> Matrices:
        return _matrices(context, kernel, facts, values, rows, wanted)

    return Group(
        name, ids, placed.nodes, 6, matrices, sources, source_of, kernel.shape, placed.corners
    )


def _matrices(
    context: Context,
    kernel: Kernel,
    facts: _Elements,
    bulk: Bulk,
    rows: Ints,
    wanted: tuple[bool, bool],
) -> Matrices:
    section, density = sections_of(context, facts, bulk, rows)
    xyz = facts.xyz[rows]
    K = M = None
    if wanted[0]:
        normals = None if facts.normals is None else facts.normals[rows]
        offset = facts.offset[rows]
        K = kernel.stiffness(xyz, section, context.settings.k6rot, offset, normals)
    if wanted[1]:
        density = density + context.extra_mass(bulk, facts.ids[rows])
        M = kernel.mass(xyz, density, context.settings.coupled)
    T = facts.spread
    if T is not None:
        K, M = (None if X is None else T.T @ X @ T for X in (K, M))
    return K, M


def sections_of(
    context: Context, facts: _Elements, bulk: Bulk, rows: Ints
) -> tuple[ShellSection, Floats]:
    """Sections in element axes and mass per area of each element.

    Elements with the same property and no thickness of their own share one layup.
    """
    distinct, position = _distinct(
        np.column_stack([facts.of[rows], facts.own[rows], facts.share[rows]])
    )
    layups: list[Layup] = []
    for number, own, share in distinct:
        key = facts.keys[int(number)]
        layups.append(layup(bulk, key, context.bulk.place(*key), float(own), float(share)))
    section = ShellSection(
        A=np.array([part.A for part in layups]),
        B=np.array([part.B for part in layups]),
        D=np.array([part.D for part in layups]),
        S=np.array([part.S for part in layups]),
        drilling=np.array([part.drilling for part in layups]),
    ).take(position)
    angle = facts.angle[rows]
    if angle.any():
        section = elements.rotate_section(section, angle)
    return section, np.array([part.density for part in layups])[position]


def _distinct(table: Floats) -> tuple[Floats, Ints]:
    """Distinct rows, and which each row is; quick where all are the same."""
    if (table == table[0]).all():
        return table[:1], np.zeros(len(table), dtype=np.int64)
    distinct, position = np.unique(table, axis=0, return_inverse=True)
    return distinct, position.reshape(-1)


def _thickness(cards: list[Card], corners: int) -> tuple[Floats, Floats]:
    """Mean thickness of each element as ``own + share * T``."""
    own, share = np.zeros(len(cards)), np.ones(len(cards))
    for k, card in enumerate(cards):
        given = [getattr(card, f"T{i}", None) for i in range(1, corners + 1)]
        if all(t is None for t in given):
            continue
        if card.tflag:  # relative to the property's thickness
            share[k] = sum(1.0 if t is None else t for t in given) / corners
        else:
            own[k] = sum(0.0 if t is None else t for t in given) / corners
            share[k] = sum(t is None for t in given) / corners
    return own, share


def material_angle(context: Context, placed: _Placed, rows: Ints) -> Floats:
    """Angle from the element's x axis to the material's [rad], of the elements `rows`.

    THETA counts from side 1-2 (CQUAD8: from the element's x axis); a coordinate system (MCID)
    gives the material's x axis by its own, projected on the element.
    """
    xyz, axes = placed.xyz[rows], placed.axes[rows]
    cards = [placed.cards[k] for k in rows]
    side = xyz[:, 1] - xyz[:, 0]
    x, y, z = axes[:, 0], axes[:, 1], axes[:, 2]
    base = np.zeros(len(rows))
    if placed.kernel.from_side:
        base = np.arctan2((side * y).sum(axis=1), (side * x).sum(axis=1))
    by_system = np.array([isinstance(c.theta_mcid, (int, np.integer)) for c in cards])
    theta = np.radians(
        [0.0 if s else float(c.theta_mcid or 0.0) for c, s in zip(cards, by_system, strict=True)]
    )
    angle: Floats = base + theta
    centre = xyz[:, : placed.kernel.corners].mean(axis=1)
    for k in np.flatnonzero(by_system):
        place = context.bulk.place(placed.name, cards[k].eid)
        frame = context.points.frames.get(int(cards[k].theta_mcid), place)
        direction = frame.directions(centre[k : k + 1])[0, 0]
        flat = direction - (direction @ z[k]) * z[k]
        if np.linalg.norm(flat) < 1e-6:
            raise InputError(
                f"{place}: the x axis of the material coordinate system is normal to the element"
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


def check_shape(context: Context, name: str, ids: Ints, xyz: Floats) -> None:
    """Raise `InputError` for an element without area or with a corner turned inside out."""
    if xyz.shape[1] == 3:
        smallest = elements.tria3_area(xyz)
        scale = np.square(np.linalg.norm(xyz[:, 1] - xyz[:, 0], axis=1))
    else:
        d1, d2 = xyz[:, 2] - xyz[:, 0], xyz[:, 3] - xyz[:, 1]
        scale = np.linalg.norm(d1, axis=1) * np.linalg.norm(d2, axis=1)
        flat = np.linalg.norm(np.cross(d1, d2), axis=1) <= 1e-9 * scale
        smallest = np.zeros(len(xyz))
        smallest[~flat] = elements.quad4_corner_jacobians(xyz[~flat]).min(axis=1)
    bad = ~(smallest > 1e-6 * scale)
    if bad.any():
        number = int(ids[np.flatnonzero(bad)[0]])
        more = f" (and {int(bad.sum()) - 1} more elements)" if bad.sum() > 1 else ""
        raise InputError(
            f"{context.bulk.place(name, number)} has no area or a corner turned inside out{more}: "
            "check the order and the positions of its grids"
        )
