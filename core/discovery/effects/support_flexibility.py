"""A support that gives: a clamp that is not rigid, a foot that turns, an edge that moves."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace

import numpy as np
import scipy.sparse as sp
from scipy.spatial import cKDTree

from ...arrays import Bools, Floats, Ints
from ..reduction.elements_and_supports import Structure, Supports, placed, thinned
from ..reduction.reduction_numbers import REDUCTION
from .candidates import Candidates, Ends
from .effect_kind import STIFFNESS, EffectKind, Scale
from .effect_laws import ReleaseLaw, directions
from .effect_numbers import EFFECTS
from .shell_edges import Edge, edges_of

_TOGETHER = ((4, 5, 6), (1, 2, 3))


@dataclass(frozen=True, eq=False)
class _Place:
    """Rows of supports that give together with one stiffness, and rows that are free besides.

    `ends` says which stretch of which edge they are, see `stretching`.
    """

    sprung: Ints
    free: Ints
    ends: Ends | None = None

    @property
    def rows(self) -> Ints:
        """All of them, the free ones first."""
        return np.concatenate([self.free, self.sprung])


def _places(structure: Structure, scale: Scale) -> tuple[Candidates, ...]:
    """Give supports a finite stiffness.

    Every fixed direction of a support alone, all its rotations or translations alike, those of
    every foot alike, and one direction over groups of supports that are neighbours. Along an edge
    of shells the groups are its stretches: they move along any axis, turn about the edge, or do
    both, where a stretch on springs turns freely, about the edge or at all. The stiffness counts
    over all grids of a place, for each of its directions.
    """
    s = structure.supports
    if s is None or not len(s.grid):
        return ()
    edges = edges_of(structure, s)
    on_edge = np.isin(s.grid, np.concatenate([np.zeros(0, np.int64), *(e.grids for e in edges)]))
    carrying = scale.mass * (2.0 * np.pi * scale.band_hz[0]) ** 2
    made = []
    for components in _TOGETHER:
        made.append(_released(s, list(_joined(s, components)), carrying))
        alike = np.flatnonzero(np.isin(s.component, components) & ~on_edge)
        several = len(np.unique(s.grid[alike])) > 1
        made.append(_released(s, [_Place(alike, alike[:0])] * several, carrying))
    for c in np.unique(s.component):
        own = np.flatnonzero(s.component == c)
        own = own[structure.in_order(s.xyz[own])]
        made.append(_released(s, [_Place(np.array([i]), own[:0]) for i in own], carrying))
        made.append(_released(s, list(_groups(s, own[~on_edge[own]], scale.size)), carrying))
    for component in range(1, 7):
        made.append(_released(s, list(_stretches(s, edges, component, scale.size)), carrying))
    made += (_released(s, places, carrying) for places in _hinges(s, edges, scale.size))
    return tuple(c for c in made if c is not None)


def at_parameters(structure: Structure, c: Candidates, row: int, log_p: Floats) -> Candidates:
    """Return one of some candidates with the stiffness that its supports hold at ln p.

    A release takes away all but a thousandth of that, so that to follow the parameters by its
    slopes from the deck's values alone leaves more, or less than nothing.
    """
    assert structure.supports is not None
    w = c.where[row]
    own = np.isin(structure.supports.grid, w["grids"])
    s = _at(structure, structure.supports, np.exp(log_p), own)
    sprung, free = (
        np.flatnonzero(own & np.isin(s.component, w.get(key, ())))
        for key in ("components", "free_components")
    )
    made = _released(s, [_Place(sprung, free)], 1.0)
    assert made is not None
    assert isinstance(made.law, ReleaseLaw)
    law = replace(made.law, base=log_p)
    return replace(made, law=law, typical=c.typical, spread=c.spread)


def given(c: Candidates, theta: tuple[float, ...], forces: Floats) -> Floats:
    """Return what supports give by in vectors of a basis, (n, r), n those of the structure.

    Of the one place of `c`, see `at_parameters`; `forces` (q, r) are its rows on the basis.
    """
    assert c.turns is not None
    softness = c.law.value(np.array([theta]), np.zeros(1, np.int64))[0]
    return np.asarray(c.turns.T @ (softness[:, None] * forces))


def carried(s: Supports, free: Floats, give: Floats) -> Floats:
    """Return the mass that moves with supports that give, in vectors of a basis, (r, r).

    Their own and what they share with the `free` degrees of freedom, vectors (n_free, r); `give`
    (n, r) is what they give by.
    """
    shared = give.T @ (s.inertia @ free)
    return np.asarray(shared + shared.T + give.T @ (s.mass @ give))


def _at(structure: Structure, s: Supports, p: Floats, own: Bools) -> Supports:
    """Return the supports of a structure, those of `own` (n,) with other parameters."""
    n, grids = structure.displacement.shape[0], structure.model.geometry.index_of(s.grid)
    held = 6 * grids + s.component - 1
    deck = structure.model.deck_point
    root, coupling, slopes = s.root, s.coupling, list(s.slopes)
    for m in structure.members:
        touched = np.isin(m.coordinates(np.arange(len(m.ids))), held[own]).any(axis=1)
        rows = np.flatnonzero(touched)
        if not len(rows):
            continue
        at = m.coordinates(rows)
        change = placed(n, at, m.stiffness(rows, p) - m.stiffness(rows, deck))[held]
        root, coupling = root + change @ structure.displacement, coupling + change[:, held]
        for k in range(len(slopes)):
            other = placed(n, at, m.slope(rows, p, k) - m.slope(rows, deck, k))
            slopes[k] = slopes[k] + other[held][:, held]
    return replace(s, root=root.tocsr(), coupling=coupling.tocsr(), slopes=tuple(slopes))


def _joined(s: Supports, components: tuple[int, ...]) -> Iterator[_Place]:
    """All of several directions of one support."""
    for grid in np.unique(s.grid):
        rows = np.flatnonzero((s.grid == grid) & np.isin(s.component, components))
        if len(rows) > 1:
            yield _Place(rows, rows[:0])


def _groups(s: Supports, own: Ints, size: float) -> Iterator[_Place]:
    """Neighbouring supports among the rows `own`, several sizes of groups."""
    if not len(own):
        return
    tree = cKDTree(s.xyz[own])
    seen = set()
    for half in EFFECTS.support_halves:
        for i in thinned(s.xyz[own], EFFECTS.spacing * half * size):
            rows = own[sorted(tree.query_ball_point(s.xyz[own[i]], half * size))]
            if len(rows) > 1 and rows.tobytes() not in seen:
                seen.add(rows.tobytes())
                yield _Place(rows, rows[:0])


def _stretches(s: Supports, edges: Sequence[Edge], component: int, size: float) -> Iterator[_Place]:
    """Stretches of edges that move along an axis, or turn about the edge."""
    for number, e in enumerate(edges):
        rows = _rows(s, e, component)
        if component > 3:
            rows = np.where(_near(s, rows, e.along), rows, -1)
        for first, last, part in e.stretches(size):
            if np.all(rows[part] >= 0):
                yield _Place(rows[part], rows[:0], (number, first, last))


def _hinges(s: Supports, edges: Sequence[Edge], size: float) -> tuple[list[_Place], list[_Place]]:
    """Stretches of edges that move out of the plane of their shells and turn freely.

    Of the first about the edge alone, of the others about every axis: an edge that is not clamped
    bends along itself.
    """
    hinged, loose = [], []
    for number, e in enumerate(edges):
        turns = np.array([_rows(s, e, c) for c in (4, 5, 6)])
        out, about = (
            max(
                (np.where(_near(s, r, d), r, -1) for r in rows),
                key=lambda rows: np.count_nonzero(rows >= 0),
            )
            for d, rows in ((e.normal, [_rows(s, e, c) for c in (1, 2, 3)]), (e.along, turns))
        )
        for first, last, part in e.stretches(size):
            if np.all(out[part] >= 0) and np.all(about[part] >= 0):
                every, ends = turns[:, part][turns[:, part] >= 0], (number, first, last)
                hinged.append(_Place(out[part], about[part], ends))
                if len(every) > len(about[part]):
                    loose.append(_Place(out[part], every, ends))
    return hinged, loose


def _rows(s: Supports, e: Edge, component: int) -> Ints:
    """Rows of one direction at the grids of an edge, -1 where it is not fixed."""
    own = np.flatnonzero(s.component == component)
    row = dict(zip(s.grid[own].tolist(), own.tolist(), strict=True))
    return np.array([row.get(g, -1) for g in e.grids.tolist()])


def _near(s: Supports, rows: Ints, direction: Floats) -> Bools:
    """Whether the axes of rows lie along a direction at each of them, (n,)."""
    return np.asarray(abs(np.sum(s.axis[rows] * direction, axis=1)) > EFFECTS.support_along)


def _released(s: Supports, places: list[_Place], carrying: float) -> Candidates | None:
    """Make candidates of groups of fixed directions.

    A group is released along principal directions of its own stiffness, each of which then is a
    release by itself; the free ones go first. The stiffness of n grids is n times that of one.
    Beforehand a support that moves is about as stiff as what would carry the whole structure at
    its lowest frequency (`carrying`), one that turns softer than what it holds.
    """
    if not places:
        return None
    free = max(len(p.free) for p in places)
    most = free + max(len(p.sprung) for p in places)
    n = len(places)
    own = np.ones((n, most))
    elastic = np.zeros((n, most, len(s.slopes)))
    turns, where, xyz = [], [], []
    for i, (p, C, slopes) in enumerate(_with_stiffness(s, places)):
        rows, at = p.rows, np.r_[0 : len(p.free), free : free + len(p.sprung)]
        grids = np.unique(s.grid[rows])
        (d,), (W,) = directions(C[None], len(p.free))
        d = np.maximum(d, REDUCTION.free * d[-1])
        own[i, at] = d * len(grids)
        elastic[i, at] = np.einsum("ai,kij,aj->ak", W, slopes, W, optimize=True) / d[:, None]
        turns.append(_block(W * np.sqrt(len(grids)), i * most + at, rows, (n * most, len(s.grid))))
        xyz.append(s.xyz[rows].mean(axis=0))
        place = {"grids": grids.tolist(), "components": _components(s, p.sprung)}
        where.append(place | ({"free_components": _components(s, p.free)} if free else {}))
    typical = float(np.median(np.log(own[:, free])))
    moves = s.component[places[0].sprung[0]] <= 3
    together = sum(turns[1:], turns[0])
    return Candidates(
        kind=KIND,
        xyz=np.array(xyz),
        law=ReleaseLaw(own, elastic, np.zeros(len(s.slopes)), free),
        trials=(typical + np.log(EFFECTS.support_trials))[:, None],
        root=(together @ s.root).tocsr(),
        rows_each=most,
        where=tuple(where),
        typical=np.array([np.log(carrying) if moves else typical - EFFECTS.support_softer]),
        spread=np.array([EFFECTS.spring_spread]),
        loads=s.root,
        turns=together,
        ends=tuple(p.ends for p in places if p.ends is not None),
    )


def _with_stiffness(
    s: Supports, places: Sequence[_Place]
) -> Iterator[tuple[_Place, Floats, Floats]]:
    """Return places with the stiffness among their rows and its slopes, (q, q) and (p, q, q)."""
    for start in range(0, len(places), REDUCTION.at_once):
        some = places[start : start + REDUCTION.at_once]
        own = np.unique(np.concatenate([p.rows for p in some]))
        both = np.array([A[own][:, own].toarray() for A in (s.coupling, *s.slopes)])
        for p in some:
            at = np.searchsorted(own, p.rows)
            part = both[:, at[:, None], at]
            yield p, part[0], part[1:]


def _components(s: Supports, rows: Ints) -> list[int]:
    return sorted({int(c) for c in s.component[rows]})


def _block(W: Floats, at: Ints, rows: Ints, shape: tuple[int, int]) -> sp.csr_matrix:
    """Put W at the rows `at` and the columns `rows`."""
    where = (np.repeat(at, len(rows)), np.tile(rows, len(at)))
    return sp.csr_matrix((W.ravel(), where), shape)


KIND = EffectKind(
    name="support_flexibility",
    label="flexible support",
    sentence="The support gives {region}, direction {components}, with a stiffness of {size}: it",
    magnitudes=(STIFFNESS,),
    places=_places,
)
