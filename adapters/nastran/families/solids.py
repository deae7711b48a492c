"""Solids: CHEXA, CPENTA, CTETRA, CPYRAM, without and with middle nodes."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field

import numpy as np

from ....core.arrays import Floats, Ints
from ....core.assembly import Matrices
from ....core.elements import hexa, penta, solid
from ....core.elements import solid_shapes as shapes
from ....core.elements.material import rotate_material
from ....core.errors import InputError
from ..cards import Bulk, Card
from ..materials import elastic
from .common import Context, Group, Key, distinct_properties
from .middle_nodes import by_pattern, kept_nodes, nodes_of, spread

SOLID_PROPERTIES = ("PSOLID",)

_INTEGRATION = {
    "0": "BUBBLE", "1": "GAUSS", "2": "TWO", "3": "THREE", "": "", "BUBBLE": "BUBBLE",
    "GAUSS": "GAUSS", "TWO": "TWO", "THREE": "THREE",
}  # fmt: skip
_SCHEME = {"0": "REDUCED", "1": "FULL", "": "REDUCED", "REDUCED": "REDUCED", "FULL": "FULL"}


@dataclass(frozen=True, eq=False)
class Kernel:
    """What tells one solid from another.

    Parameters
    ----------
    shape : str
        For drawing.
    corners : int
        Number of corner nodes.
    geometry : Solid
        Node numbering and quadrature.
    stiffness : callable
        Stiffness from positions, elastic matrices and, where `schemes` says so, the scheme.
    mass : callable
        Mass from positions, densities and whether it is coupled.
    schemes : dict
        The kernel's word for each (IN, ISOP) of PSOLID; empty where there is one only.
    """

    shape: str
    corners: int
    geometry: shapes.Solid
    stiffness: Callable[..., Floats]
    mass: Callable[[Floats, Floats, bool], Floats]
    schemes: dict[tuple[str, str], str] = field(default_factory=dict)


_LINEAR = {
    ("", "REDUCED"): "bubble",
    ("BUBBLE", "REDUCED"): "bubble",
    ("BUBBLE", "FULL"): "bubble",
    ("TWO", "REDUCED"): "reduced",
    ("THREE", "REDUCED"): "reduced",
    ("", "FULL"): "full",
    ("TWO", "FULL"): "full",
    ("THREE", "FULL"): "full",
}
_QUADRATIC = {
    ("", "REDUCED"): "reduced",
    ("THREE", "REDUCED"): "reduced",
    ("TWO", "REDUCED"): "two",
    ("TWO", "FULL"): "two",
    ("", "FULL"): "full",
    ("THREE", "FULL"): "full",
}

KERNELS: dict[str, tuple[Kernel, Kernel]] = {
    "CTETRA": (
        Kernel("tetra", 4, shapes.TETRA4, solid.tetra4_stiffness, solid.tetra4_mass),
        Kernel("tetra", 4, shapes.TETRA10, solid.tetra10_stiffness, solid.tetra10_mass),
    ),
    "CPYRAM": (
        Kernel("pyramid", 5, shapes.PYRAMID5, solid.pyramid5_stiffness, solid.pyramid5_mass),
        Kernel("pyramid", 5, shapes.PYRAMID13, solid.pyramid13_stiffness, solid.pyramid13_mass),
    ),
    "CPENTA": (
        Kernel("penta", 6, shapes.PENTA6, penta.penta6_stiffness, solid.penta6_mass, _LINEAR),
        Kernel("penta", 6, shapes.PENTA15, penta.penta15_stiffness, solid.penta15_mass, _QUADRATIC),
    ),
    "CHEXA": (
        Kernel("hexa", 8, shapes.HEXA8, hexa.hexa8_stiffness, solid.hexa8_mass, _LINEAR),
        Kernel("hexa", 8, shapes.HEXA20, hexa.hexa20_stiffness, solid.hexa20_mass, _QUADRATIC),
    ),
}


def solids(context: Context) -> list[Group]:
    """Make the groups of solids: by card, and by which middle nodes are there."""
    groups = []
    for name, (linear, quadratic) in KERNELS.items():
        cards = list(context.bulk.table(name).values())
        for present, members in by_pattern(cards, linear.corners).items():
            kernel = quadratic if present else linear
            groups.append(_group(context, name, members, kernel, present))
    return groups


def _group(
    context: Context, name: str, cards: list[Card], kernel: Kernel, present: tuple[bool, ...]
) -> Group:
    bulk, points = context.bulk, context.points
    ids = np.array([c.eid for c in cards], dtype=np.int64)
    kept = kept_nodes(present, kernel.corners, kernel.geometry.nodes)
    rows_of = points.rows(nodes_of(cards, kept), name, ids)
    _refuse_repeated(context, name, ids, rows_of)
    T = spread(kernel.geometry.edges, kept)
    xyz = points.xyz[rows_of] if T is None else T @ points.xyz[rows_of]
    check_volume(context, name, ids, kernel, xyz)
    pids = np.array([c.pid for c in cards])
    keys, of = distinct_properties(bulk, SOLID_PROPERTIES, name, ids, pids)
    schemes = [_scheme(context, name, kernel, key) for key in keys]
    centre = xyz[:, : kernel.corners].mean(axis=1)
    full = None if T is None else np.kron(T, np.eye(3))

    def matrices(values: Bulk, rows: Ints, wanted: tuple[bool, bool]) -> Matrices:
        C, rho = _materials(context, values, keys, of[rows], centre[rows])
        K = M = None
        if wanted[0]:
            K = _stiffness(kernel, xyz[rows], C, [schemes[k] for k in of[rows]])
        if wanted[1]:
            M = kernel.mass(xyz[rows], rho, context.settings.coupled)
        if full is not None:
            K, M = (None if X is None else full.T @ X @ full for X in (K, M))
        return K, M

    sources = tuple(_sources(context, key) for key in keys)
    corners = rows_of[:, : kernel.corners]
    return Group(name, ids, 2 * rows_of, 3, matrices, sources, of, kernel.shape, corners)


def _refuse_repeated(context: Context, name: str, ids: Ints, rows_of: Ints) -> None:
    """Raise `InputError` for an element that names a grid twice."""
    ordered = np.sort(rows_of, axis=1)
    twice = (ordered[:, 1:] == ordered[:, :-1]).any(axis=1)
    if twice.any():
        place = context.bulk.place(name, int(ids[np.flatnonzero(twice)[0]]))
        raise InputError(
            f"{place} names a grid twice; use the element of the shape it stands for "
            "(CPENTA, CPYRAM, CTETRA)"
        )


def _stiffness(kernel: Kernel, xyz: Floats, C: Floats, schemes: list[str]) -> Floats:
    if not kernel.schemes:
        return kernel.stiffness(xyz, C)
    if len(set(schemes)) == 1:
        return kernel.stiffness(xyz, C, schemes[0])
    n = 3 * kernel.geometry.nodes
    K = np.zeros((len(xyz), n, n))
    for scheme in dict.fromkeys(schemes):
        rows = np.flatnonzero([s == scheme for s in schemes])
        K[rows] = kernel.stiffness(xyz[rows], C[rows], scheme)
    return K


def _scheme(context: Context, name: str, kernel: Kernel, key: Key) -> str:
    """Return the kernel's word for the integration that PSOLID asks for."""
    card = context.bulk.table(key[0])[key[1]]
    place = context.bulk.place(*key)
    if str(card.fctn or "SMECH").upper() not in ("SMECH", ""):
        raise InputError(f"{place}: FCTN {card.fctn} (fluid elements) is not supported")
    if not kernel.schemes:
        return ""
    words = ("" if w is None else str(w).upper() for w in (card.integ, card.isop))
    asked = tuple(table.get(w, w) for table, w in zip((_INTEGRATION, _SCHEME), words, strict=True))
    found = kernel.schemes.get((asked[0], asked[1]))
    if found is None:  # as the Quick Reference Guide says, PSOLID remark 10
        context.notes.append(
            f"{place}: no integration IN = {asked[0] or 'blank'}, ISOP = {asked[1]} exists "
            f"for {name} with {kernel.geometry.nodes} nodes: the default is used, as in Nastran"
        )
        return kernel.schemes["", "REDUCED"]
    return found


def _sources(context: Context, key: Key) -> frozenset[Key]:
    card = context.bulk.table(key[0])[key[1]]
    found = context.bulk.find(("MAT1", "MAT9"), int(card.mid))
    return frozenset([key, (found[0] if found else "MAT1", int(card.mid))])


def _materials(
    context: Context, bulk: Bulk, keys: list[Key], of: Ints, centre: Floats
) -> tuple[Floats, Floats]:
    """Elastic matrices in the basic frame, (n, 6, 6), and densities, (n,)."""
    used, position = np.unique(of, return_inverse=True)
    found = []
    for k in used:
        place = context.bulk.place(*keys[k])
        found.append(elastic(bulk, bulk.table(keys[k][0])[keys[k][1]].mid, place))
    C = np.array([m.C for m in found])[position]
    rho = np.array([m.rho for m in found])[position]
    for number, (k, material) in enumerate(zip(used, found, strict=True)):
        if material.isotropic:
            continue
        place = context.bulk.place(*keys[k])
        cordm = int(bulk.table(keys[k][0])[keys[k][1]].cordm or 0)
        if cordm < 0:
            raise InputError(
                f"{place}: CORDM = -1 (element coordinates) is not supported with MAT9: name a "
                "coordinate system"
            )
        rows = np.flatnonzero(position == number)
        frame = context.points.frames.get(cordm, place)
        C[rows] = rotate_material(C[rows], frame.directions(centre[rows]))
    return C, rho


def check_volume(context: Context, name: str, ids: Ints, kernel: Kernel, xyz: Floats) -> None:
    """Raise `InputError` for a solid that is flat or turned inside out at an integration point."""
    _, derivatives = kernel.geometry.shape(kernel.geometry.points)
    parts = np.array_split(xyz, max(len(xyz) // 4096, 1))
    smallest = np.concatenate(
        [np.linalg.det(derivatives @ part[:, None]).min(axis=1) for part in parts]
    )
    size = np.ptp(xyz, axis=1).max(axis=1) ** 3
    bad = ~(smallest > 1e-9 * size)
    if bad.any():
        number = int(ids[np.flatnonzero(bad)[0]])
        more = f" (and {int(bad.sum()) - 1} more elements)" if bad.sum() > 1 else ""
        raise InputError(
            f"{context.bulk.place(name, number)} is flat or turned inside out{more}: check the "
            "order and the positions of its grids"
        )
