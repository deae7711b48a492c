"""A mass on a spring of its own: a vibration absorber, a pendulum, equipment on soft mounts."""

from __future__ import annotations

import numpy as np

from ..candidates import Candidates
from ..laws import TunedLaw
from ..structure import Structure
from .point_mass import points_of, translations
from .scale import Scale

_MASSES = (0.008, 0.016, 0.032, 0.06)
"""Trial masses beside that of the structure."""
_BESIDE = (0.93, 1.07)
"""An absorber shows by a mode of its own, so it is tuned into the band that was measured."""
_SPACING = 0.04
"""Between trial frequencies, of ln f."""
_FREQUENCY_STEP = 0.15


def candidates(structure: Structure, scale: Scale) -> tuple[Candidates, ...]:
    """Give every grid, shell middle and shell edge an absorber along each basic axis.

    Far above the band an absorber is a mass and far below it a spring to ground: those kinds are
    looked for as such.
    """
    points, xyz, grids = points_of(structure)
    root = translations(structure, points)
    live = np.flatnonzero(np.diff(root.indptr) > 0)
    at = live // 3
    low, high = np.log(scale.band_hz) + np.log(_BESIDE)
    hz = np.linspace(low, high, 2 + int((high - low) / _SPACING))
    made = Candidates(
        kind="tuned_absorber",
        xyz=xyz[at],
        law=TunedLaw(np.zeros((len(at), 1)), 0.0),
        trials=np.array([(m, f) for m in np.log(scale.mass * np.array(_MASSES)) for f in hz]),
        root=root[live],
        rows_each=1,
        where=tuple(
            {"grids": grids[i], "components": [int(c)]}
            for i, c in zip(at, live % 3 + 1, strict=True)
        ),
        typical=np.array([np.log(0.025 * scale.mass), 0.5 * (low + high)]),
        spread=np.array([1.0, 0.5 * (high - low)]),
        steps=np.array([1.0, _FREQUENCY_STEP]),
        lower=np.array([-np.inf, low]),
        upper=np.array([np.inf, high]),
    )
    return (made,)
