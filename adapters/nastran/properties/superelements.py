"""Superelements that stand in the deck (BEGIN SUPER), joined to one structure.

The parts keep all their degrees of freedom: component modes and static condensation, by which
Nastran makes them smaller, are left out, and what they leave out with them. External ones come
with matrices (EXTSEOUT's assembly punch and OP4).
"""

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np

from ....core.arrays import Floats
from ....core.data.coordinate_systems import frame_of_points
from ....core.errors import InputError, Place
from ..deck.bulk import Bulk
from ..deck.card_definition import Card, Values
from ..deck.field_values import Fields, take
from ..deck.merged_bulk import (
    MANY,
    SHARED,
    Numbers,
    clash,
    every_one,
    highest_number,
    merged,
    scalar_points,
)
from ..deck.read_deck import Deck, External
from .deck_coordinate_systems import Frames
from .grids import read_points
from .superelement_sets import of_own_subcase, with_sets_of_parts

_TOLERANCE = 1e-5
_EXTERNAL = "EXTOP4"


def _connections(fields: Fields, _: Any) -> tuple[Any]:
    """Pairs of SECONCT: ``GA GB GA GB ...``, or ``GA1 THRU GA2 GB1 THRU GB2`` on a line."""
    pairs: list[tuple[int, int]] = []
    for first in range(9, len(fields), 8):
        row = [*fields[first : first + 8], *[None] * 8][:8]
        if (row[1] or "").upper() == "THRU":
            ends = [take(fields, first + k, "GRID:i!") for k in (0, 2, 3, 5)]
            pairs += zip(range(ends[0], ends[1] + 1), range(ends[2], ends[3] + 1), strict=False)
        else:
            found = [take(fields, first + k, "GRID:i") for k in range(8)]
            pairs += [(a, b) for a, b in zip(found[::2], found[1::2], strict=True) if a and b]
    return (tuple(pairs),)


CARDS = (
    Card(
        "SEBULK",
        "SEID:i! TYPE:w=PRIMARY RSEID:i METHOD:w=AUTO TOL:r=1.E-5 LOC:w=YES UNITNO:i",
        "seid",
    ),
    Card(
        "SECONCT",
        "SEIDA:i! SEIDB:i=0 TOL:r=1.E-5 LOC:w=YES ...",
        more=_connections,
        extra="pairs",
    ),
    Card("EXTRN", "[G>nodes:i! C>components:c=0]"),
    Card("SEBNDRY", "SEIDA:i! SEIDB:iw=0 GIDA>own:*"),
    Card("SEEXCLD", "SEIDA:i! SEIDB:iw=0 GIDA>own:*"),
    Card("SELOC", "SEID:i! GIDS1,GIDS2,GIDS3>own:i! GIDB1,GIDB2,GIDB3>others:i!", "seid"),
    Card("POINT", "ID:i! CP:i=0 X1,X2,X3>xyz:r=0.", "id"),
)

_LEFT_OUT = (
    *("ASET", "ASET1", "OMIT", "OMIT1", "BSET", "BSET1", "BNDFIX", "BNDFIX1", "CSET", "CSET1"),
    *("BNDFREE", "BNDFRE1", "BNDFREE1", "QSET", "QSET1", "SUPORT", "SUPORT1", "EIGRL", "EIGR"),
    *("PARAM", "DTI", "GRDSET", "BAROR", "BEAMOR"),
)
"""Cards of a part that say how it is reduced, or say nothing of the whole."""

_OWN = ("CWELD", "CFAST", "NSM", "NSML", "NSM1", "NSML1")
"""Cards whose numbers mean what another of their fields says."""

_DIRECTED = ("components", "cm", "cn", "ps")
"""Attributes that hold components of displacement systems."""


@dataclass(frozen=True, eq=False)
class _Joined:
    """What is joined so far: where each grid of each part (0: the main bulk) went."""

    bulk: Bulk
    at: Mapping[tuple[int, int], int]


Matrices = Callable[[Path], Mapping[str, Any]]
"""Reads a file of matrices: by their names."""


def join_superelements(deck: Deck, matrices: Matrices) -> Deck:
    """Put the parts of a deck into its main bulk; what cannot be joined is refused later.

    Parts are joined where grids coincide (SEBULK's METHOD AUTO; SEBNDRY and SEEXCLD limit the
    search) or SECONCT says so. A part may share the numbers of its cards with others: those that
    do not mean the same get others, which is said.
    """
    elsewhere = [
        (k, c.type)
        for k, c in deck.bulk.table("SEBULK").items()
        if k not in deck.parts and c.type not in ("PRIMARY", "COLLCTR", "REPEAT" * bool(deck.parts))
    ]
    if elsewhere:
        number, kind = elsewhere[0]
        refused = deck.bulk.place("SEBULK", number).error(
            f"superelements of TYPE {kind} without a BEGIN SUPER={number} are not supported: give "
            "the assembled deck"
        )
        return replace(deck, refused=(*deck.refused, refused))
    notes: list[str] = []
    deck = with_sets_of_parts(deck, notes)
    if not deck.parts:
        return replace(deck, warnings=(*deck.warnings, *notes))
    external = _external_ones(deck)
    if whole := sorted(set(deck.parts) - set(external)):
        notes.append(
            f"superelements ({', '.join(map(str, whole))}) are joined and solved whole: Nastran "
            "condenses their insides, statically or to component modes, and finds frequencies "
            "higher by what that leaves out"
        )
    main = (*deck.bulk.table("GRID"), *scalar_points(deck.bulk))
    joined = _Joined(deck.bulk, {(0, g): g for g in main})
    try:
        for seid, part in _parts(deck):
            joined = _add(deck, joined, seid, part, notes)
        found = tuple(_external(deck, joined, seid, matrices) for seid in external)
    except InputError as error:
        return replace(deck, refused=(*deck.refused, error))
    return replace(deck, bulk=joined.bulk, external=found, warnings=(*deck.warnings, *notes))


def _external_ones(deck: Deck) -> list[int]:
    return [k for k, c in deck.bulk.table("SEBULK").items() if c.type == _EXTERNAL]


def _external(deck: Deck, joined: _Joined, seid: int, matrices: Matrices) -> External:
    """Read the matrices of an external superelement: on what its EXTRN cards name, in turn."""
    place = deck.bulk.place("SEBULK", seid)
    path = deck.assigned.get(deck.bulk.table("SEBULK")[seid].unitno)
    if path is None:
        raise place.error("its UNITNO is no unit of an ASSIGN INPUTT4 statement of the deck")
    named = (
        pair
        for c in deck.parts[seid].listed("EXTRN")
        for pair in zip(c.nodes, c.components, strict=True)
    )
    points = tuple(
        (joined.at[seid, grid], int(digit)) for grid, digits in named for digit in digits
    )
    held = {n: m for n, m in matrices(path).items() if m.shape == (len(points), len(points))}
    for K, M in (("KXX", "MXX"), ("KAA", "MAA"), ("KAAX", "MAAX")):
        if K in held and M in held:
            return External(points, held[K], held[M])
    raise place.error(
        f"{path} holds no KXX and MXX (KAA and MAA) of {len(points)} rows, as many as EXTRN names"
    )


def _parts(deck: Deck) -> Iterator[tuple[int, Bulk]]:
    """Yield the parts by number, those that repeat another with its cards."""
    kinds = deck.bulk.table("SEBULK")
    for seid in sorted({*deck.parts, *(k for k, c in kinds.items() if c.type == "REPEAT")}):
        card = kinds.get(seid)
        kind = card.type if card else "PRIMARY"
        place = deck.bulk.place("SEBULK", seid)
        if kind not in ("PRIMARY", "REPEAT", _EXTERNAL):
            raise place.error(f"superelements of TYPE {kind} are not supported")
        source = card.rseid if card and kind == "REPEAT" else seid
        if source not in deck.parts:
            raise place.fault(f"repeats superelement {source}, which the deck does not have")
        part = deck.parts[source]
        if own := set(part.definitions) & set(_OWN) & set(part.raw):
            raise Place(deck.path).error(
                f"superelement {seid} holds {min(own)}, which is not supported in superelements"
            )
        yield seid, part


def _add(deck: Deck, joined: _Joined, seid: int, part: Bulk, notes: list[str]) -> _Joined:
    main = joined.bulk
    q_set = {k for name in ("QSET", "QSET1") for c in part.listed(name) for k in every_one(c.nodes)}
    for name, value in _params(part).items():
        if name in ("WTMASS", "K6ROT", "COUPMASS", "SNORM") and deck.params.get(name) != value:
            notes.append(
                f"PARAM {name} {value} of superelement {seid} is not that of the main bulk, which "
                "is taken for all"
            )
    part = _without(part, q_set)
    xyz, system = _positions(part), None
    highest = max(highest_number(main), highest_number(part))
    if selected := deck.bulk.table("SELOC").get(seid):
        turn, origin = _placement(main, xyz, selected, seid)
        xyz = {grid: origin + turn @ x for grid, x in xyz.items()}
        system = _system(part, highest + 1, turn, origin)
    joints = _joints(joined, seid, xyz, part)
    more = 10 ** len(str(highest + 1))
    apart = bool(system) or any(clash(space, main, part, {}) for space in SHARED)
    shared = more * apart
    numbers = {space: Numbers({}, shared) for space in SHARED}
    numbers["grid"] = Numbers(joints, more * clash("grid", main, part, joints))
    numbers["element"] = Numbers({}, more * clash("element", main, part, {}))
    if system:
        numbers["coordinate"] = Numbers({0: system.cid}, shared)
    changed = sorted(MANY[space] for space in numbers if numbers[space].more)
    if changed:
        notes.append(
            f"superelement {seid} shares numbers with others: {more} is added to those of its "
            f"{', '.join(changed)}"
        )
    bulk = merged(main, of_own_subcase(deck, seid, part), numbers)
    _check_directions(bulk, part, joints, numbers)
    if system:
        systems = {**bulk.table("CORD2R"), system.cid: system}
        bulk = replace(bulk, tables={**bulk.tables, "CORD2R": systems})
    grids = (*part.table("GRID"), *scalar_points(part))
    return _Joined(bulk, {**joined.at, **{(seid, g): numbers["grid"](g) for g in grids}})


def _params(part: Bulk) -> dict[str, str]:
    return {c.n: c.v1 for c in part.listed("PARAM") if c.v1 is not None}


def _without(part: Bulk, q_set: set[int]) -> Bulk:
    """Leave out cards that say how the part is reduced, and points of component modes."""
    lists = {n: cards for n, cards in part.lists.items() if n not in _LEFT_OUT}
    if "SPOINT" in lists:
        of = [tuple(k for k in every_one(c.nodes) if k not in q_set) for c in lists["SPOINT"]]
        lists["SPOINT"] = [c._replace(nodes=k) for c, k in zip(lists["SPOINT"], of, strict=True)]
    return replace(
        part, lists=lists, tables={n: t for n, t in part.tables.items() if n not in _LEFT_OUT}
    )


def _positions(bulk: Bulk) -> dict[int, Floats]:
    if not bulk.table("GRID"):
        return {}
    points = read_points(bulk)
    return dict(zip((int(i) for i in points.ids), points.xyz, strict=True))


def _placement(
    main: Bulk, xyz: Mapping[int, Floats], card: Values, seid: int
) -> tuple[Floats, Floats]:
    """Rotation and shift by which SELOC moves three grids of a part to three points."""
    place = main.place("SELOC", seid)
    frames, there = Frames(main, lambda _: None), _positions(main)
    for c in main.table("POINT").values():
        there[c.id] = frames.get(c.cp, place).positions(np.array([c.xyz]))[0]
    for known, wanted in ((xyz, card.own), (there, card.others)):
        if missing := [g for g in wanted if g not in known]:
            raise place.fault(f"refers to grid {missing[0]}, which does not exist")
    try:
        before, after = (
            frame_of_points("rectangular", *(known[g] for g in wanted))
            for known, wanted in ((xyz, card.own), (there, card.others))
        )
    except InputError as error:
        raise place.error(str(error)) from None
    turn = after.axes.T @ before.axes
    return turn, after.origin - turn @ before.origin


def _system(part: Bulk, number: int, turn: Floats, origin: Floats) -> Values:
    """Return the coordinate system that a part which was moved has for its basic one."""
    points = np.concatenate([origin, origin + turn[:, 2], origin + turn[:, 0]])
    return part.definitions["CORD2R"].type(number, 0, tuple(points.tolist()))


def _joints(joined: _Joined, seid: int, xyz: Mapping[int, Floats], part: Bulk) -> dict[int, int]:
    """Grids of a part, and the grids joined before that they are."""
    main = joined.bulk
    card = main.table("SEBULK").get(seid)
    joints: dict[int, int] = {}
    if card is None or card.method != "MANUAL":
        joints = _coincident(joined, seid, xyz, card.tol if card else _TOLERANCE)
    for connection, place in main.placed("SECONCT"):
        sides = (connection.seida, connection.seidb)
        if seid not in sides:
            continue
        for pair in connection.pairs:
            (own,) = (g for s, g in zip(sides, pair, strict=True) if s == seid)
            (other,) = ((s, g) for s, g in zip(sides, pair, strict=True) if s != seid)
            if own not in xyz and own not in scalar_points(part):
                raise place.fault(f"joins grid {own} of superelement {seid}, which has none")
            if other in joined.at:
                joints[own] = joined.at[other]
            elif other[0] in {s for s, _ in joined.at}:
                raise place.fault(f"joins grid {other[1]} of superelement {other[0]}, not there")
    return joints


def _coincident(
    joined: _Joined, seid: int, xyz: Mapping[int, Floats], tolerance: float
) -> dict[int, int]:
    from scipy.spatial import cKDTree

    there = _positions(joined.bulk)
    if not there or not xyz:
        return {}
    allowed = _candidates(joined, seid, set(xyz))
    ids = np.array(list(there))
    tree = cKDTree(np.array(list(there.values())))
    joints = {}
    for grid, x in xyz.items():
        near = ids[tree.query_ball_point(x, tolerance)]
        found = sorted(
            (int(n) for n in near if allowed(grid, int(n))), key=lambda n: (n != grid, n)
        )
        if found:
            joints[grid] = found[0]
    return joints


def _candidates(joined: _Joined, seid: int, own: set[int]) -> Callable[[int, int], bool]:
    """Whether a grid of a part may be searched for among those joined before."""
    part_of: dict[int, set[int]] = {}
    for (part, _), grid in joined.at.items():
        part_of.setdefault(grid, set()).add(part)
    limits: dict[tuple[int | str, int | str], set[int]] = {}
    barred: dict[tuple[int | str, int | str], set[int]] = {}
    for name, kept in (("SEBNDRY", limits), ("SEEXCLD", barred)):
        for card in joined.bulk.listed(name):
            kept.setdefault((card.seida, card.seidb), set()).update(every_one(card.own))

    def allowed(grid: int, other: int) -> bool:
        for part in part_of.get(other, ()):
            for a, b, g in ((seid, part, grid), (part, seid, joined_name(part, other))):
                listed = [limits[k] for k in ((a, b), (a, "ALL")) if k in limits]
                if listed and not any(g in grids for grids in listed):
                    return False
                if any(g in barred.get(k, ()) for k in ((a, b), (a, "ALL"))):
                    return False
        return True

    names = {(part, new): old for (part, old), new in joined.at.items()}

    def joined_name(part: int, grid: int) -> int:
        return names.get((part, grid), grid)

    return allowed


def _check_directions(
    bulk: Bulk, part: Bulk, joints: Mapping[int, int], numbers: Mapping[str, Numbers]
) -> None:
    """Refuse components of a part that stand on a grid with another displacement system."""
    system = numbers["coordinate"]
    other = {
        g
        for g, new in joints.items()
        if g in part.table("GRID")
        and system(part.table("GRID")[g].cd) != bulk.table("GRID")[new].cd
    }
    if not other:
        return
    for name in part.raw:
        cards = part.table(name).values() or part.listed(name)
        definition = part.definitions[name]
        for card in cards:
            directed = any(getattr(card, a, None) for a in _DIRECTED)
            named = {card.id} if name == "GRID" else set(definition.grids_of(card))
            if directed and named & other:
                grid = min(named & other)
                raise Place(bulk.files[0]).error(
                    f"{name} names components of grid {grid}, whose displacement system (CD) is "
                    f"not that of grid {joints[grid]}, which it is joined to: give both the same"
                )
