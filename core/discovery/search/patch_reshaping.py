"""Patches grow and shrink, a row of elements at a time, and links end elsewhere, where that pays.

The catalogue has round and elongated patches of a few sizes. What is really there ends where a
bay, a sheet or a blanket ends; on a patch of the wrong shape it leaves a rest that looks like a
second effect beside the first, or that a stand under it would make up for. So a patch may take in
the next row of elements on one side or all round, or give one up, fill its corners, or stop at the
property it is on, as long as each step makes the test likelier by more than trying so many shapes
is worth. So do links: the catalogue has those between some grids.
"""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from ...arrays import Bools, Floats, Ints
from ..effects.candidates import Candidates, Suspect
from ..effects.element_patches import Patch, PatchCandidates, area_of
from ..effects.link_spring import Links
from ..likelihood.hypothesis import Fit
from ..reduction.elements_and_supports import Members, Structure
from .exact_scan import scan
from .model_selection import scored
from .moves import Searcher
from .search_numbers import SEARCH


def reshaped(searcher: Searcher, state: Fit) -> tuple[Searcher, Fit]:
    """Return a hypothesis with patches of better shapes, and a searcher that knows them."""
    for q in range(len(state.suspects)):
        for _ in range(SEARCH.reshape_steps):
            better = _step(searcher, state, q)
            if better is None:
                break
            searcher, state = better
    return searcher, state


def _step(searcher: Searcher, state: Fit, q: int) -> tuple[Searcher, Fit] | None:
    """Give one suspect the best of the shapes next to its own, None where none is worth it."""
    wide, options = options_beside(searcher, state.suspects[q])
    now, worth = scored(wide, state), float(np.log1p(len(options)))
    for option in promising(wide, state, q, options)[: SEARCH.shapes_tried]:
        trial = wide.fitted(state, state.instead(q, option), SEARCH.steps_new)
        if scored(wide, trial, now).score > now.score + worth:
            return wide, trial
    return None


def promising(
    searcher: Searcher,
    state: Fit,
    q: int,
    options: Sequence[Suspect],
    sizes: Sequence[float] = SEARCH.reshape_sizes,
) -> list[Suspect]:
    """Return what may stand in place of one suspect with the best sizes, the best first."""
    small, here = searcher.without(state, q)
    tried: list[tuple[float, Suspect]] = []
    for kind in sorted({s.kind for s in options}):
        of_kind = [s for s in options if s.kind == kind]
        rows = np.array([s.row for s in of_kind])
        c = searcher.problem.catalogue[kind]
        trials = c.around(c.like(of_kind[0].theta).tolist(), np.array(sizes))
        score = scan(small, here, kind, rows, trials) + c.surprise(trials)
        for row, own in zip(rows, score, strict=True):
            best = int(np.argmin(own))
            tried.append((float(own[best]), Suspect(kind, int(row), tuple(trials[best]))))
    return [s for _, s in sorted(tried, key=lambda t: t[0])]


def options_beside(searcher: Searcher, suspect: Suspect) -> tuple[Searcher, list[Suspect]]:
    """Return the shapes next to that of a suspect, and a searcher whose catalogue has them.

    Of twins beside each other what one between them may be, as large as both.
    """
    c = searcher.problem.catalogue[suspect.kind]
    if isinstance(c, PatchCandidates):
        return _added(searcher, suspect, variants(c.structure, c.patches[suspect.row]))
    if isinstance(c, Links):
        near, kind = c.near(suspect.row, SEARCH.link_near), len(searcher.problem.catalogue)
        options = [replace(suspect, kind=kind, row=row) for row in range(len(near))]
        return searcher.with_kind(kind, near), options
    beside = [
        Suspect(kind, int(row), tuple(d.like([size])))
        for kind, spot, size in searcher.forms(suspect)
        for d in [searcher.problem.catalogue[kind]]
        if isinstance(d, PatchCandidates) or c.many(suspect.row) > 1
        for row in np.flatnonzero(
            np.linalg.norm(d.xyz - spot, axis=1) < SEARCH.patch_beside * searcher.size
        )
    ]
    return searcher, beside


def _patched(searcher: Searcher, c: Candidates) -> list[tuple[int, PatchCandidates]]:
    """Return the kinds of the nature of some candidates on patches, small ones first."""
    found = [
        (kind, d)
        for kind, d in enumerate(searcher.problem.catalogue)
        if isinstance(d, PatchCandidates) and d.kind.joins(c.kind)
    ]
    return sorted(found, key=lambda f: f[1].kind.spread_out)


def _added(
    searcher: Searcher, suspect: Suspect, patches: Sequence[Patch]
) -> tuple[Searcher, list[Suspect]]:
    """Put patches into the catalogue, each into the kind of its nature where its extent belongs."""
    of_kind: dict[int, list[Patch]] = {}
    for p in patches:
        of_kind.setdefault(_kind_of(searcher, suspect, p), []).append(p)
    options: list[Suspect] = []
    for kind, new in of_kind.items():
        first = len(searcher.problem.catalogue[kind])
        options += [replace(suspect, kind=kind, row=first + k) for k in range(len(new))]
        searcher = searcher.with_patches(kind, new)
    return searcher, options


def _kind_of(searcher: Searcher, suspect: Suspect, patch: Patch) -> int:
    c = searcher.problem.catalogue[suspect.kind]
    assert isinstance(c, PatchCandidates)
    radius = np.sqrt(area_of(c.structure, patch) / np.pi)
    wide = bool(radius > SEARCH.spread_mass * searcher.size)
    found = [k for k, d in _patched(searcher, c) if d.kind.spread_out == wide]
    return suspect.kind if suspect.kind in found or not found else found[0]


def variants(structure: Structure, patch: Patch) -> list[Patch]:
    """Return the patches that are one row of elements larger or smaller, or end with a property.

    Rows are taken along the sides of the middle element, forwards, backwards and both, and all
    round; one has its corners filled.
    """
    m = structure.members[patch.member]
    if m.element.dimension != 2:
        return []
    inside = np.zeros(len(m.ids), bool)
    inside[patch.rows] = True
    xyz = structure.centroids(m)
    touched = np.zeros(len(structure.model.geometry.ids), bool)
    touched[m.corners[inside]] = True
    ring = touched[m.corners].any(axis=1) & ~inside
    outside = np.zeros_like(touched)
    outside[m.corners[~inside]] = True
    skin = outside[m.corners].any(axis=1) & inside
    shapes = [inside | ring, inside & ~skin]
    for first, last in _rows_of_elements(structure, m, inside, ring, xyz):
        shapes += [inside | first, inside & ~last]
    own = m.block.depends_of
    for k in np.unique(own[inside]):
        if SEARCH.property_share < np.mean(own[inside] == k) < 1.0:
            shapes.append(inside & (own == k))
    alone = np.unique(own[inside])
    if len(alone) == 1:
        shapes += [s & (own == alone[0]) for s in shapes]
    return _patches(patch, xyz, inside, shapes)


def _rows_of_elements(
    structure: Structure, m: Members, inside: Bools, ring: Bools, xyz: Floats
) -> list[tuple[Bools, Bools]]:
    """Return the next row outside and the last row inside, towards four sides and opposite ones.

    And what is missing at the corners, with nothing inside.
    """
    middle = xyz[inside].mean(axis=0)
    rows = np.flatnonzero(inside)
    nearest = rows[np.argmin(np.linalg.norm(xyz[rows] - middle, axis=1))]
    x = structure.model.geometry.xyz[m.corners[nearest]]
    along = x[1] - x[0]
    side = float(np.linalg.norm(along))
    if side == 0.0:
        return []
    across = x[-1] - x[0]
    across = across - along * (across @ along) / side**2
    depth = float(np.linalg.norm(across))
    if depth == 0.0:
        return []
    frame = np.stack([along / side, across / depth])
    place = (xyz - middle) @ frame.T / [side, depth]
    low, high = place[inside].min(axis=0) - 0.5, place[inside].max(axis=0) + 0.5
    corners = ring & np.all((place > low) & (place < high), axis=1)
    out = [(corners, np.zeros_like(inside))]
    for k in (0, 1):
        level = (place[:, 1 - k] > low[1 - k]) & (place[:, 1 - k] < high[1 - k])
        ways = [
            (place[:, k] > high[k], place[:, k] > high[k] - 1.0),
            (place[:, k] < low[k], place[:, k] < low[k] + 1.0),
        ]
        ways.append((ways[0][0] | ways[1][0], ways[0][1] | ways[1][1]))
        out += [(ring & level & ahead, inside & last) for ahead, last in ways]
    return out


def _patches(patch: Patch, xyz: Floats, inside: Bools, shapes: Sequence[Bools]) -> list[Patch]:
    """Shapes as patches, each once, none empty nor as large as smooth fields."""
    seen, out = {inside.tobytes()}, []
    for s in shapes:
        if s.tobytes() in seen or not 0 < np.count_nonzero(s) < SEARCH.largest_patch * len(s):
            continue
        seen.add(s.tobytes())
        rows: Ints = np.flatnonzero(s)
        middle = xyz[rows].mean(axis=0)
        out.append(Patch(patch.member, rows, middle, False))
    return out
