"""Whether two hypotheses say the same: the same kinds at about the same places."""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np

from ..effects.candidates import Catalogue, Suspect
from ..likelihood.hypothesis import Fit


def distinct(fits: Sequence[Fit], catalogue: Catalogue, near: float) -> list[Fit]:
    """Drop fits whose suspects are the same kinds, nearer than `near`, as a better one's."""
    kept: list[Fit] = []
    for f in fits:
        if not any(_same(f, g, catalogue, near) for g in kept):
            kept.append(f)
    return kept


def unmatched(
    best: Fit, f: Fit, same: Callable[[Suspect, Suspect], bool]
) -> tuple[list[int], list[Suspect]]:
    """Return numbers of the suspects of the best that `f` does not have, and what it has instead.

    Parameters
    ----------
    best, f : Fit
    same : callable
        Whether a suspect of the best and one of `f` are one.
    """
    left, alone = list(f.suspects), []
    for k, s in enumerate(best.suspects):
        twin = next((t for t in left if same(s, t)), None)
        if twin is None:
            alone.append(k)
        else:
            left.remove(twin)
    return alone, left


def _same(f: Fit, g: Fit, catalogue: Catalogue, near: float) -> bool:
    def close(s: Suspect, t: Suspect) -> bool:
        xyz = catalogue[s.kind].xyz
        return s.kind == t.kind and float(np.linalg.norm(xyz[s.row] - xyz[t.row])) < near

    return unmatched(f, g, close) == ([], [])
