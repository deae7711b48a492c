"""Solids: CHEXA, CPENTA, CTETRA, CPYRAM, without and with middle nodes."""

from typing import NamedTuple

import numpy as np

from .....core.arrays import Floats, Ints, Matrices
from .....core.elements import Element
from .....core.elements.volumes.solid import rotate_material
from .....core.errors import Place
from ...deck.bulk import Bulk
from ...deck.card_definition import Card
from ...properties.materials import elastic
from ..element_group import Context, Group, Key, with_material
from ..placed_elements import Placed, placed
from . import laminated_solids
from .laminated_solids import UNKNOWN, laminated, of_several, ply_axes


def _card(name: str, corners: int, nodes: int, elements: str) -> Card:
    names = [f"G{k}" for k in range(1, nodes + 1)]
    first, middle = ",".join(names[:corners]), ",".join(names[corners:])
    layout = f"EID:i! PID:i! {first}>nodes:i! {middle}>nodes:i"
    return Card(name, layout, "eid", elements=elements, properties="PSOLID PCOMPS PLSOLID")


CARDS = (
    _card("CTETRA", 4, 10, "tetra4 tetra10"),
    _card("CPYRAM", 5, 13, "pyramid5 pyramid13"),
    _card("CPENTA", 6, 15, "penta6 penta15"),
    _card("CHEXA", 8, 20, "hexa8 hexa20"),
    laminated_solids.CARD,
    Card("PLSOLID", "PID:i! MID:i! ...", "pid"),
    Card(
        "PSOLID", "PID:i! MID:i! CORDM:i=0 IN>integration:iw STRESS:iw ISOP:iw FCTN:w=SMECH", "pid"
    ),
)

_INTEGRATION = {"0": "BUBBLE", "1": "GAUSS", "2": "TWO", "3": "THREE"}
_SCHEME = {"0": "REDUCED", "1": "FULL", "": "REDUCED"}
"""The words that numbers and blanks of IN and ISOP stand for."""

_LINEAR = {
    "REDUCED": {"": "bubble", "BUBBLE": "bubble", "TWO": "reduced", "THREE": "reduced"},
    "FULL": {"": "full", "BUBBLE": "bubble", "TWO": "full", "THREE": "full"},
}
_QUADRATIC = {
    "REDUCED": {"": "reduced", "TWO": "two", "THREE": "reduced"},
    "FULL": {"": "full", "TWO": "two", "THREE": "full"},
}
"""The element's word for the integration, by ISOP and IN."""


def solids(context: Context) -> list[Group]:
    """Make the groups of every card that may have a PCOMPS, by which middle nodes are there."""
    groups: list[Group] = []
    for solid in placed(context, "PCOMPS"):
        several = np.array([of_several(context.bulk, key) for key in solid.keys])[solid.of]
        if not several.all():
            groups.append(_group(context, solid.take(~several)))
        if several.any():
            groups.append(laminated(context, solid.take(several)))
    return groups


def _group(context: Context, solid: Placed) -> Group:
    element, keys, of, xyz = solid.element, solid.keys, solid.of, solid.xyz
    schemes = [_scheme(context, solid.name, element, key) for key in keys]
    centre = xyz[:, : element.corners].mean(axis=1)

    def matrices(values: Bulk, rows: Ints, wanted: tuple[bool, bool]) -> Matrices:
        C, rho = _materials(context, values, solid, centre[rows], rows)
        K = M = None
        if wanted[0]:
            K = _stiffness(element, xyz[rows], C, [schemes[k] for k in of[rows]])
            K = solid.of_nodes_there(K)
        if wanted[1]:
            M = solid.mass(rows, rho, context.settings.coupled)
        return K, M

    sources = tuple(with_material(context.bulk, key) for key in keys)
    return Group(solid.name, solid.ids, element, solid.nodes, matrices, sources, of)


def _stiffness(element: Element, xyz: Floats, C: Floats, schemes: list[str]) -> Floats:
    if len(set(schemes)) == 1:
        return element.stiffness(xyz, C, schemes[0])
    n = 3 * element.nodes
    K = np.zeros((len(xyz), n, n))
    for scheme in dict.fromkeys(schemes):
        rows = np.flatnonzero([s == scheme for s in schemes])
        K[rows] = element.stiffness(xyz[rows], C[rows], scheme)
    return K


def _scheme(context: Context, name: str, element: Element, key: Key) -> str:
    """Return the element's word for the integration that PSOLID asks for."""
    card = context.bulk.table(key[0])[key[1]]
    place = context.bulk.place(*key)
    if key[0] == "PLSOLID":
        raise place.error(f"hyperelastic solids are not supported: give {name} a PSOLID")
    if key[0] == "PCOMPS":
        context.notes.append(f"{place}: {UNKNOWN.format(name)}; that with PSOLID stands for it")
        return element.integrations[0]
    if card.fctn != "SMECH":
        raise place.error(f"FCTN {card.fctn} (fluid elements) is not supported")
    if len(element.integrations) < 2:
        return element.integrations[0]
    integration, isop = ("" if w is None else str(w) for w in (card.integration, card.isop))
    integration, isop = _INTEGRATION.get(integration, integration), _SCHEME.get(isop, isop)
    schemes = _QUADRATIC if len(element.edges) else _LINEAR
    found = schemes.get(isop, {}).get(integration)
    if found is None:  # as the Quick Reference Guide says, PSOLID remark 10
        context.notes.append(
            f"{place}: no integration IN = {integration or 'blank'}, ISOP = {isop} exists "
            f"for {name} with {element.nodes} nodes: the default is used, as in Nastran"
        )
        return element.integrations[0]
    return found


def _materials(
    context: Context, bulk: Bulk, solid: Placed, centre: Floats, rows: Ints
) -> tuple[Floats, Floats]:
    """Elastic matrices in the basic frame, (n, 6, 6), and densities, (n,), of these elements."""
    keys, of = solid.keys, solid.of[rows]
    used, position = np.unique(of, return_inverse=True)
    places = [context.bulk.place(*keys[k]) for k in used]
    filled = [_fill(bulk, keys[k], place) for k, place in zip(used, places, strict=True)]
    found = [elastic(bulk, fill.mid, place) for fill, place in zip(filled, places, strict=True)]
    C = np.array([m.C for m in found])[position]
    rho = np.array([m.rho for m in found])[position]
    for number, (fill, place) in enumerate(zip(filled, places, strict=True)):
        if found[number].isotropic:
            continue
        # the element system of CPYRAM is the basic one (Quick Reference Guide, PSOLID)
        cordm = max(fill.cordm, 0) if solid.name == "CPYRAM" else fill.cordm
        if cordm < 0:
            raise place.error(
                "CORDM = -1 (element coordinates) is not supported with MAT9 and MAT11: name a "
                "coordinate system"
            )
        at = np.flatnonzero(position == number)
        frame = context.points.frames.get(cordm, place)
        C[at] = rotate_material(C[at], fill.axes @ frame.directions(centre[at]))
    return C, rho


class _Fill(NamedTuple):
    """What a property fills elements with: material axes are rows in the system CORDM."""

    mid: int
    cordm: int
    axes: Floats


def _fill(bulk: Bulk, key: Key, place: Place) -> _Fill:
    """Return the material of a PSOLID, or of a PCOMPS whose plies are all alike."""
    card = bulk.table(key[0])[key[1]]
    if key[0] != "PCOMPS":
        return _Fill(card.mid, card.cordm, np.eye(3))
    return _Fill(card.mid[0], card.cordm, ply_axes(card, place)[0])
