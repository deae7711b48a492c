"""Places that are one beside a test that may lie on the model in several ways."""

from collections.abc import Sequence

import numpy as np
from scipy.spatial import cKDTree

from ...arrays import Floats
from ...data.geometry import Geometry
from ...registration.alignment import Alignment, Candidate
from ...registration.pose_selection import margin_of
from .sentences import region


def images(alignment: Alignment, xyz: Floats) -> Floats:
    """Return where a place (3,) is by the other positions that are as good, (n, 3).

    What a test says of the model stays what it says of the test: the place moves with it.
    """
    taken = alignment.rotation.T @ (xyz - alignment.translation)
    others = (c.transform for c in _as_good(alignment))
    return np.array([t.rotation @ taken + t.translation for t in others]).reshape(-1, 3)


def frame_needed(
    alignment: Alignment, geometry: Geometry, places: Sequence[Floats]
) -> tuple[str, ...]:
    """Say that `places` (3,) are one of several where the test may lie in several ways."""
    if alignment.decided:
        return ()
    others = [_said(geometry, images(alignment, xyz)) for xyz in places if _as_good(alignment)]
    now = "it is known but for such a turn or slide"
    if others:
        now = f"it may as well be {', and '.join(others)}"
    return (
        f"how the test lies on the model: {alignment.ambiguity}; with the test in the frame of "
        f"the deck the place is known, now {now}",
    )


def _as_good(alignment: Alignment) -> tuple[Candidate, ...]:
    """Return the positions besides that which was taken that nothing tells from it."""
    if alignment.decided or not alignment.candidates:
        return ()
    best = max(c.score or 0.0 for c in alignment.candidates)
    least = best - margin_of(best)
    return tuple(c for c in alignment.candidates[1:] if c.score is None or c.score >= least)


def _said(geometry: Geometry, places: Floats) -> str:
    """Name the grids next to some places (n, 3)."""
    nearest = cKDTree(geometry.xyz).query(places)[1]
    return " or ".join(region(geometry, xyz) for xyz in geometry.xyz[nearest])
