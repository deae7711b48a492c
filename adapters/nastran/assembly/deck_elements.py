"""The elements of a deck over the g-set, and their matrices at parameter values."""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from ....core.arrays import Floats, Ints, Matrices
from ....core.assembly.element_assembly import ElementBlock
from ....core.errors import InputError
from ....core.noun import Noun
from ..cards import FAMILIES, Context, Group, Settings
from ..deck.bulk import Bulk
from ..deck.read_deck import Deck
from ..properties.grids import Points, read_points
from ..properties.nonstructural import read_nonstructural
from .moving_grids import following_grids
from .variation import GRID, Variation


@dataclass(frozen=True, eq=False)
class Structure(Noun):
    """The elements of a deck over the g-set, before constraints.

    Parameters
    ----------
    points : Points
        Grids and the numbering.
    groups : tuple of Group
        Elements.
    blocks : tuple of ElementBlock
        The same for assembly: in displacement systems, scaled by WTMASS.
    notes : tuple of str
        What is left out.
    """

    points: Points
    groups: tuple[Group, ...]
    blocks: tuple[ElementBlock, ...]
    notes: tuple[str, ...] = ()


def read_structure(deck: Deck, variation: Variation, by: Floats | None = None) -> Structure:
    """Collect the elements of a deck, its grids moved `by` (n_grid, 3), basic axes, if at all.

    Displacement systems stay.

    Raises
    ------
    InputError
        A card that carries stiffness, mass or constraint and is not supported; numbers that refer
        to nothing; elements without shape.
    """
    _refuse(deck)
    points = read_points(deck.bulk)
    if by is not None:
        points = replace(points, xyz=points.xyz + by)
    settings = Settings(
        k6rot=deck.param("K6ROT", 100.0),
        snorm=deck.param("SNORM", 20.0),
        coupled=deck.param("COUPMASS", -1.0) > 0.0,
        bars_spin=deck.param("BARMASS", 0.0) > 0.0,
    )
    nonstructural = read_nonstructural(deck, points)
    moved = frozenset(variation.moves)

    def made(bulk: Bulk, there: Points, notes: list[str]) -> tuple[Group, ...]:
        context = Context(bulk, there, settings, nonstructural, notes, moved)
        return tuple(g for f in FAMILIES if f.groups for g in f.groups(context))

    left_out: list[str] = []
    groups = made(variation.bulk, points, left_out)
    groups = following_grids(deck, variation, points, groups, lambda b, p: made(b, p, []))
    wtmass = deck.param("WTMASS", 1.0)
    blocks = tuple(element_block(g, points, variation, wtmass) for g in groups)
    notes = (*left_out, *_unused_masses(deck), *_shared_numbers(deck, groups))
    return Structure(points, groups, blocks, notes)


def _refuse(deck: Deck) -> None:
    """Raise `InputError` for what carries stiffness, mass or constraint and is not supported."""
    if deck.refused:
        first, more = deck.refused[0], len(deck.refused) - 1
        raise first.reworded(
            f"{first} (and {more} more that are not supported)" if more else f"{first}"
        )


def _shared_numbers(deck: Deck, groups: Sequence[Group]) -> tuple[str, ...]:
    """Say when elements of different cards have one number, which Nastran refuses."""
    owner: dict[int, str] = {}
    shared = []
    for group in groups:
        if group.element.shape:
            new = dict.fromkeys(group.ids.tolist(), group.card)
            shared += [i for i in owner.keys() & new.keys() if owner[i] != new[i]]
            owner |= new
    if not shared:
        return ()
    shown = ", ".join(map(str, sorted(shared)[:5])) + (", ..." if len(shared) > 5 else "")
    return (
        f"{deck.path}: elements of different cards share the number {shown}; Nastran wants every "
        "element number once",
    )


def _unused_masses(deck: Deck) -> tuple[str, ...]:
    """Say when the deck holds non-structural mass that case control does not select."""
    names = [n for n in ("NSM", "NSM1", "NSML", "NSML1") if deck.bulk.table(n)]
    if deck.case.nsm is not None or not names:
        return ()
    return (
        f"{deck.path}: the {', '.join(names)} cards are not used: case control selects none "
        "(NSM = ...)",
    )


def element_block(
    group: Group, points: Points, variation: Variation, wtmass: float = 1.0
) -> ElementBlock:
    """Return a group for assembly: in displacement systems, masses times WTMASS."""
    sets = [
        tuple(sorted({p for key in source for p in variation.acting_on(key)}))
        for source in group.sources
    ]
    distinct = tuple(dict.fromkeys(sets))
    of_source = np.array([distinct.index(s) for s in sets], dtype=np.int64)
    at_grids = group.element.freedoms > 1
    rotated = points.rotated[group.nodes].any(axis=1) if at_grids else None

    def evaluate(rows: Ints, p: Floats, wanted: tuple[bool, bool]) -> Matrices:
        try:
            K, M = group.matrices(variation.at(p), rows, wanted)
        except InputError as error:
            moved = variation.describe(p)
            advice = "; give narrower bounds, such as '[0.9, 1.1]'" if moved else ""
            raise error.reworded(f"{moved}{error}{advice}") from None
        for X in (K, M):
            if X is not None and not np.isfinite(X).all():
                bad = int(group.ids[rows[np.flatnonzero(~np.isfinite(X).all(axis=(1, 2)))[0]]])
                raise variation.bulk.place(group.card, bad).error(
                    "its matrix is not finite; check its shape, its property and its material"
                )
        M = M * wtmass if M is not None and wtmass != 1.0 else M
        if rotated is not None and rotated[rows].any():
            turned = np.flatnonzero(rotated[rows])
            R = points.directions[group.nodes[rows[turned]]]
            K, M = (None if X is None else _turn(X, turned, R) for X in (K, M))
        return K, M

    return ElementBlock(
        places=group.places,
        width=group.element.freedoms,
        evaluate=evaluate,
        depends=distinct,
        depends_of=of_source[group.source_of],
        name=group.card,
        shape_moves=any(card == GRID for source in group.sources for card, _ in source),
    )


def _turn(X: Floats, which: Ints, R: Floats) -> Floats:
    """Turn the matrices of some elements to the displacement systems of their grids.

    `R` is (len(which), w, 3, 3), one rotation a place; a place holds one or two triples.
    """
    n, w = R.shape[:2]
    triples = X.shape[1] // (3 * w)
    T = np.repeat(R, triples, axis=1)
    blocks = X[which].reshape(n, w * triples, 3, w * triples, 3)
    blocks = np.einsum("naij,najbk->naibk", T, blocks, optimize=True)
    blocks = np.einsum("naibk,nblk->naibl", blocks, T, optimize=True)
    out = X.copy()
    out[which] = blocks.reshape(n, X.shape[1], X.shape[1])
    return out
