"""Shells: CQUAD4, CTRIA3."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from ....core.arrays import Floats, Ints
from ....core.assembly import Matrices
from ....core.elements import shell
from ....core.elements.shell import ShellSection
from ....core.errors import InputError
from ..cards import Bulk, Card
from ..laminates import Layup, layup
from .common import Context, Group, Key, distinct_properties, element_sources
from .normals import shell_normals

SHELL_PROPERTIES = ("PSHELL", "PCOMP", "PCOMPG")


@dataclass(frozen=True, eq=False)
class Kernel:
    """What tells one shell shape from another."""

    shape: str
    corners: int
    axes: Callable[[Floats], Floats]
    stiffness: Callable[..., Floats]
    mass: Callable[[Floats, Floats, bool], Floats]


KERNELS: dict[str, Kernel] = {
    "CQUAD4": Kernel("quad", 4, shell.quad4_axes, shell.quad4_stiffness, shell.quad4_mass),
    "CTRIA3": Kernel("tria", 3, shell.tria3_axes, shell.tria3_stiffness, shell.tria3_mass),
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


@dataclass(frozen=True, eq=False)
class _Placed:
    """Elements of one shape and where they stand."""

    name: str
    kernel: Kernel
    cards: list[Card]
    ids: Ints
    corners: Ints
    axes: Floats


def shells(context: Context) -> list[Group]:
    """Make the groups of shells."""
    found = []
    for name, kernel in KERNELS.items():
        cards = list(context.bulk.table(name).values())
        if cards:
            ids = np.array([c.eid for c in cards], dtype=np.int64)
            corners = context.points.rows([c.nodes for c in cards], name, ids)
            check_shape(context, name, ids, context.points.xyz[corners])
            axes = kernel.axes(context.points.xyz[corners])
            found.append(_Placed(name, kernel, cards, ids, corners, axes))
    normals = shell_normals(
        [f.corners for f in found],
        [f.axes for f in found],
        len(context.points.ids),
        context.settings.snorm,
    )
    return [_group(context, f, n) for f, n in zip(found, normals, strict=True)]


def _group(context: Context, placed: _Placed, normals: Floats | None) -> Group:
    bulk = context.bulk
    name, kernel, cards, ids = placed.name, placed.kernel, placed.cards, placed.ids
    xyz = context.points.xyz[placed.corners]
    keys, of = distinct_properties(
        bulk, SHELL_PROPERTIES, name, ids, np.array([c.pid for c in cards])
    )
    own, share = _thickness(cards, kernel.corners)
    elements = _Elements(
        ids,
        xyz,
        keys,
        of,
        material_angle(context, name, cards, placed.axes, xyz),
        own,
        share,
        np.array([c.zoffset or 0.0 for c in cards], dtype=np.float64),
        normals,
    )
    of_property = [frozenset([key, *layup(bulk, key, bulk.place(*key)).materials]) for key in keys]
    sources, source_of = element_sources(context, ids, of_property, of)

    def matrices(values: Bulk, rows: Ints, wanted: tuple[bool, bool]) -> Matrices:
        return _matrices(context, kernel, elements, values, rows, wanted)

    corners = placed.corners
    return Group(name, ids, corners, 6, matrices, sources, source_of, kernel.shape, corners)


def _matrices(
    context: Context,
    kernel: Kernel,
    elements: _Elements,
    bulk: Bulk,
    rows: Ints,
    wanted: tuple[bool, bool],
) -> Matrices:
    section, density, reference = sections_of(context, elements, bulk, rows)
    xyz = elements.xyz[rows]
    offset = elements.offset[rows] + reference
    K = M = None
    if wanted[0]:
        normals = None if elements.normals is None else elements.normals[rows]
        K = kernel.stiffness(xyz, section, context.settings.k6rot, offset, normals)
    if wanted[1]:
        density = density + context.extra_mass(bulk, elements.ids[rows])
        M = kernel.mass(xyz, density, context.settings.coupled)
    return K, M


def sections_of(
    context: Context, elements: _Elements, bulk: Bulk, rows: Ints
) -> tuple[ShellSection, Floats, Floats]:
    """Sections in element axes, mass per area, and the properties' own offset of each element.

    Elements with the same property and no thickness or angle of their own share one section.
    """
    e = elements
    distinct, position = _distinct(
        np.column_stack([e.of[rows], e.angle[rows], e.own[rows], e.share[rows]])
    )
    layups: list[Layup] = []
    for number, _, own, share in distinct:
        key = elements.keys[int(number)]
        layups.append(layup(bulk, key, context.bulk.place(*key), float(own), float(share)))
    section = ShellSection(
        A=np.array([part.A for part in layups]),
        B=np.array([part.B for part in layups]),
        D=np.array([part.D for part in layups]),
        S=np.array([part.S for part in layups]),
        drilling=np.array([part.drilling for part in layups]),
    )
    turn = np.where([part.isotropic for part in layups], 0.0, distinct[:, 1])
    if turn.any():
        section = shell.rotate_section(section, turn)
    density = np.array([part.density for part in layups])
    reference = np.array([part.offset for part in layups])
    return section.take(position), density[position], reference[position]


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


def material_angle(
    context: Context, name: str, cards: list[Card], axes: Floats, xyz: Floats
) -> Floats:
    """Angle from the element's x axis to the material's [rad].

    THETA counts from side 1-2; a coordinate system (MCID) from its x axis projected on the
    element.
    """
    side = xyz[:, 1] - xyz[:, 0]
    x, y, z = axes[:, 0], axes[:, 1], axes[:, 2]
    base = np.arctan2((side * y).sum(axis=1), (side * x).sum(axis=1))
    by_system = np.array([isinstance(c.theta_mcid, (int, np.integer)) for c in cards])
    theta = np.radians(
        [0.0 if s else float(c.theta_mcid or 0.0) for c, s in zip(cards, by_system, strict=True)]
    )
    angle: Floats = base + theta
    for k in np.flatnonzero(by_system):
        place = context.bulk.place(name, cards[k].eid)
        frame = context.points.frames.get(int(cards[k].theta_mcid), place)
        direction = frame.directions(xyz[k].mean(axis=0, keepdims=True))[0, 0]
        flat = direction - (direction @ z[k]) * z[k]
        if np.linalg.norm(flat) < 1e-6:
            raise InputError(
                f"{place}: the x axis of the material coordinate system is normal to the element"
            )
        angle[k] = np.arctan2(flat @ y[k], flat @ x[k])
    return angle


def check_shape(context: Context, name: str, ids: Ints, xyz: Floats) -> None:
    """Raise `InputError` for an element without area or with a corner turned inside out."""
    if xyz.shape[1] == 3:
        smallest = shell.tria3_area(xyz)
        scale = np.square(np.linalg.norm(xyz[:, 1] - xyz[:, 0], axis=1))
    else:
        d1, d2 = xyz[:, 2] - xyz[:, 0], xyz[:, 3] - xyz[:, 1]
        scale = np.linalg.norm(d1, axis=1) * np.linalg.norm(d2, axis=1)
        flat = np.linalg.norm(np.cross(d1, d2), axis=1) <= 1e-9 * scale
        smallest = np.zeros(len(xyz))
        smallest[~flat] = shell.quad4_corner_jacobians(xyz[~flat]).min(axis=1)
    bad = ~(smallest > 1e-6 * scale)
    if bad.any():
        number = int(ids[np.flatnonzero(bad)[0]])
        more = f" (and {int(bad.sum()) - 1} more elements)" if bad.sum() > 1 else ""
        raise InputError(
            f"{context.bulk.place(name, number)} has no area or a corner turned inside out{more}: "
            "check the order and the positions of its grids"
        )
