"""How large masses are in a model that errs by more than tells what they stand on.

What stands on a mount acts as a larger mass the nearer a mode is to the mount's frequency: a small
mass that is held softly moves modes as a large one that is held rigidly. In a poor model a fit puts
into the mount what the model itself errs by, to the bound of what mounts are. So the test is not
asked (Plummer 2015, Statistics and Computing 25: cut models): masses are sized on mounts of every
stiffness that such have beforehand, and lie in the middle of all these sizes.
"""

from __future__ import annotations

from collections.abc import Sequence
from itertools import product

import numpy as np
from scipy.special import ndtr, ndtri

from ...arrays import Floats
from ..effects.effect_numbers import EFFECTS
from ..effects.point_mass import Mounted
from ..likelihood.hypothesis import Fit
from ..likelihood.map_fit import evaluate
from ..model_error.diffuse_fit import Judged
from ..model_error.size_posterior import amid
from ..reduction.elements_and_supports import Structure
from .equipment_growth import as_blocks
from .moves import Searcher


def as_blocks_on_mounts(
    structure: Structure, searcher: Searcher, best: Fit, starts: Sequence[Floats], density: float
) -> tuple[Searcher, Judged, Judged] | None:
    """Return masses at points as blocks: a searcher that knows them, as the test has them, sized.

    The parameters climb from each of the `starts`. None where there are no such masses, or where
    the model with them does not solve.
    """
    wide, solid = as_blocks(structure, searcher, best, density)
    if solid is best:
        return None
    starts, sizes = [solid.nuisance, *starts], (solid, best)
    rigid = _likeliest(wide, solid, sizes, starts)
    if rigid is None:
        return None
    tried = (
        _likeliest(*as_blocks(structure, searcher, best, density, mount), sizes, starts)
        for mount in _mounts(searcher)
    )
    sized = [t for t in tried if t is not None]
    return wide, rigid, amid(rigid, sized) if sized else rigid


def _mounts(searcher: Searcher) -> Floats:
    """Return ln f of mounts that are as likely beforehand."""
    c = next(c for c in searcher.problem.catalogue if isinstance(c, Mounted))
    low, high = ndtr((np.array([c.lower[1], c.upper[1]]) - c.typical[1]) / c.spread[1])
    shares = low + (high - low) * np.array(EFFECTS.mounts_unknown)
    return np.asarray(c.typical[1] + c.spread[1] * ndtri(shares))


def _likeliest(
    searcher: Searcher, state: Fit, sizes: Sequence[Fit], starts: Sequence[Floats]
) -> Judged | None:
    """Return a hypothesis as the test is likeliest, climbed to from each start and each size."""
    best: Judged | None = None
    for nuisance, sized in product(starts, sizes):
        both = zip(state.suspects, sized.suspects, strict=True)
        suspects = tuple(s.moved(np.append(o.theta[:1], s.theta[1:])) for s, o in both)
        new = searcher.judged(searcher.problem, evaluate(searcher.problem, nuisance, suspects))
        if new is not None and (best is None or new.evidence > best.evidence):
            best = new
    return best
