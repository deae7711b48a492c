"""A dashpot to ground: a damper, a rubbing seal, a bundle of cables, a foot on foam.

It changes D by c·uuᵀ and neither K nor M, so it does not compete in the search but is weighed
afterwards, see `dampers`.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
import scipy.sparse as sp

from ...arrays import Floats
from ..story import odds
from ..structure import Structure
from .point_mass import translations

PEAKS = np.geomspace(0.004, 0.3, 14)
"""Sizes tried at every place: the ratio that the mode which feels a dashpot most gets from it."""


@dataclass(frozen=True, eq=False)
class Dashpots:
    """All places and directions of a dashpot.

    Parameters
    ----------
    xyz : (n, 3) float
        Where, deck units.
    root : (n, n_free) sparse
        Row u of each: D changes by c·uuᵀ.
    where : tuple of dict
        ``grids`` and ``components`` of each.
    """

    xyz: Floats
    root: sp.csr_matrix
    where: tuple[dict[str, Any], ...]


def dashpots(structure: Structure) -> Dashpots:
    """Dashpots along each basic axis at every grid that moves."""
    g = structure.model.geometry
    root = translations(structure, sp.identity(len(g.ids), format="csr"))
    live = np.flatnonzero(np.diff(root.indptr) > 0)
    return Dashpots(
        g.xyz[live // 3],
        root[live],
        tuple(
            {"grids": [int(g.ids[i])], "components": [int(c)]}
            for i, c in zip(live // 3, live % 3 + 1, strict=True)
        ),
    )


def sentence(
    damping: float,
    interval: tuple[float, float],
    components: list[int],
    region: str,
    modes: list[int],
    times: float,
) -> str:
    """Say what is missing, where, what shows it, and how sure.

    Parameters
    ----------
    modes : list of int
        Test modes, from 1, that it gives more damping than they have without.
    times : float
        How many times less likely it is that there is none.
    """
    which = f"mode{'s' if len(modes) > 1 else ''} {', '.join(map(str, modes))}"
    return (
        f"A dashpot to ground of about {damping:.3g} (force per velocity, deck units) in "
        f"direction {''.join(map(str, components))} is missing {region}: it explains the measured "
        f"damping of {which} (95 %: {interval[0]:.3g} to {interval[1]:.3g}); no dashpot at all is "
        f"{odds(times)}."
    )
