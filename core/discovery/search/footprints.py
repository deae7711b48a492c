"""The footprint of an attached mass on a shell: its middle and radius, finer than the mesh.

A mass that sits between grids, or is spread over a hand's breadth, moves as the skin under it
does. Put on the nearest grid it hangs on the skin's own softness there, which moves the higher
modes too far, so that it is fitted too small and the known parameters make up for the rest. So the
masses of a hypothesis that earned its place are laid on discs, each grid with its share of the
area, whose middle and radius are moved as long as the misfit falls.
"""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
import scipy.sparse as sp
from scipy.spatial import Delaunay, QhullError, cKDTree

from ...arrays import Floats, Ints
from ..effects import point_mass
from ..effects.candidates import Candidates, Suspect
from ..effects.effect_laws import MassLaw
from ..effects.structure_points import translations
from ..likelihood.hypothesis import Fit
from ..likelihood.map_fit import evaluate
from ..reduction.elements_and_supports import Structure
from .exact_scan import scan
from .moves import Searcher
from .search_numbers import SEARCH

_TURN = np.pi * (3.0 - np.sqrt(5.0))
"""The golden angle: points on a spiral that turn by it fill a disc evenly (Vogel 1979)."""


def footed(searcher: Searcher, structure: Structure, state: Fit) -> tuple[Searcher, Fit]:
    """Return a hypothesis with its masses on discs where these fit better, and one who knows them.

    Every mass has a footprint, so that a disc need not gain more than a point.
    """
    for step in SEARCH.foot_steps:
        for q in range(len(state.suspects)):
            better = _step(searcher, structure, state, q, step)
            if better is not None:
                searcher, state = better
    return searcher, state


def _step(
    searcher: Searcher, structure: Structure, state: Fit, q: int, step: float
) -> tuple[Searcher, Fit] | None:
    """Lay one mass on the best disc around its place, None where none fits better."""
    suspect = state.suspects[q]
    c = searcher.problem.catalogue[suspect.kind]
    if c.kind is not point_mass.KIND or c.many(suspect.row) > 1:
        return None
    there = c.where[suspect.row]
    radius = there["radius"] if "shares" in there else None
    discs = _discs(structure, c.xyz[suspect.row], radius, step)
    if not discs:
        return None
    searcher, kind = _with(searcher, structure, c, discs)
    others = state.suspects[:q] + state.suspects[q + 1 :]
    small, here = searcher.local(evaluate(searcher.problem, state.nuisance, others))
    new = searcher.problem.catalogue[kind]
    trials = new.around(suspect.theta, np.array(SEARCH.foot_sizes))
    score = scan(small, here, kind, np.arange(len(new)), trials) + new.surprise(trials)
    best: Fit | None = None
    for row in np.argsort(score.min(axis=1), kind="stable")[: SEARCH.foot_tried]:
        option = Suspect(kind, int(row), tuple(trials[score[row].argmin()]))
        beside = (*state.suspects[:q], option, *state.suspects[q + 1 :])
        trial = searcher.fitted(state, beside, SEARCH.steps_moved)
        if trial.objective < state.objective - SEARCH.better:
            best = trial if best is None or trial.objective < best.objective else best
    return None if best is None else (searcher, best)


Disc = tuple[Floats, float, Ints, Floats]
"""Middle (3,), radius, grids (rows of the geometry) and their shares."""


def _discs(structure: Structure, xyz: Floats, radius: float | None, step: float) -> list[Disc]:
    """Return discs whose middles are up to a `step` of the mesh from a place on shells."""
    g = structure.model.geometry
    shells = [m.corners.ravel() for m in structure.members if m.element.dimension == 2]
    if not shells:
        return []
    grids = np.unique(np.concatenate(shells))
    tree = cKDTree(g.xyz[grids])
    near, _ = tree.query(g.xyz[grids[tree.query(xyz)[1]]], min(SEARCH.foot_near, len(grids)))
    mesh = float(near[-1])
    if np.linalg.norm(g.xyz[grids] - xyz, axis=1).min() > mesh or mesh == 0.0:
        return []
    own = grids[tree.query_ball_point(xyz, SEARCH.foot_reach * mesh)]
    middle = g.xyz[own].mean(axis=0)
    _, _, axes = np.linalg.svd(g.xyz[own] - middle, full_matrices=False)
    flat = (g.xyz[own] - middle) @ axes[:2].T
    try:
        cells = Delaunay(flat)
    except (QhullError, ValueError):
        return []
    radii = mesh * np.array(SEARCH.foot_radii)
    if radius is not None:
        radii = radius * np.exp(step * np.array(SEARCH.foot_changes))
    at = (xyz - middle) @ axes[:2].T
    out = []
    for a, b in step * mesh * np.array([(i, j) for i in (-1, 0, 1) for j in (-1, 0, 1)]):
        for r in radii.tolist():
            shares = _shares(cells, at + np.array([a, b]), r)
            kept = np.flatnonzero(shares > SEARCH.foot_share)
            if len(kept):
                shares = shares[kept] / shares[kept].sum()
                out.append((shares @ g.xyz[own[kept]], r, own[kept], shares))
    return out


def _shares(cells: Delaunay, middle: Floats, radius: float) -> Floats:
    """Return the shares of the corners of a triangulation in the area of a disc, (n,)."""
    k = np.arange(SEARCH.foot_points) + 0.5
    r, turn = radius * np.sqrt(k / len(k)), k * _TURN
    points = middle + np.stack([r * np.cos(turn), r * np.sin(turn)], axis=1)
    found = cells.find_simplex(points)
    points, found = points[found >= 0], found[found >= 0]
    T = cells.transform[found]
    two = np.einsum("nij,nj->ni", T[:, :2], points - T[:, 2])
    three = np.concatenate([two, 1.0 - two.sum(axis=1, keepdims=True)], axis=1)
    shares = np.bincount(
        cells.simplices[found].ravel(), np.maximum(three, 0.0).ravel(), len(cells.points)
    )
    return np.asarray(shares / max(shares.sum(), np.finfo(float).tiny))


def _with(
    searcher: Searcher, structure: Structure, c: Candidates, discs: Sequence[Disc]
) -> tuple[Searcher, int]:
    """Put masses on discs into the catalogue; their number in it."""
    ids, most = structure.model.geometry.ids, max(len(d[2]) for d in discs)
    rows = np.concatenate([i * most + np.arange(len(d[2])) for i, d in enumerate(discs)])
    shares = np.concatenate([d[3] for d in discs])
    where = (np.sqrt(shares), (rows, np.concatenate([d[2] for d in discs])))
    new = Candidates(
        kind=c.kind,
        xyz=np.array([d[0] for d in discs]),
        law=MassLaw(),
        trials=c.trials,
        root=translations(structure, sp.csr_matrix(where, (len(discs) * most, len(ids)))),
        rows_each=3 * most,
        where=tuple(
            {"grids": ids[d[2]].tolist(), "shares": d[3].tolist(), "radius": d[1]} for d in discs
        ),
        typical=c.typical,
        spread=c.spread,
    )
    p = searcher.problem
    problem = replace(
        p,
        catalogue=(*p.catalogue, new),
        factors=(*p.factors, new.factors(p.basis)),
        missing=(*p.missing, None) if p.missing else (),
    )
    coarse = (*searcher.coarse, np.zeros(0, np.int64))
    return replace(searcher, problem=problem, coarse=coarse), len(p.catalogue)
