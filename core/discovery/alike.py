"""Whether two hypotheses say the same: the same kinds at about the same places."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from .candidates import Catalogue, Suspect
from .fitting import Fit


def distinct(fits: Sequence[Fit], catalogue: Catalogue, near: float) -> list[Fit]:
    """Drop fits whose suspects are the same kinds, nearer than `near`, as a better one's."""
    kept: list[Fit] = []
    for f in fits:
        if not any(_same(f, g, catalogue, near) for g in kept):
            kept.append(f)
    return kept


def _same(f: Fit, g: Fit, catalogue: Catalogue, near: float) -> bool:
    if len(f.suspects) != len(g.suspects):
        return False
    left = list(g.suspects)
    for s in f.suspects:
        twin = next((t for t in left if _close(s, t, catalogue, near)), None)
        if twin is None:
            return False
        left.remove(twin)
    return True


def _close(s: Suspect, t: Suspect, catalogue: Catalogue, near: float) -> bool:
    if s.kind != t.kind:
        return False
    xyz = catalogue[s.kind].xyz
    return float(np.linalg.norm(xyz[s.row] - xyz[t.row])) < near
