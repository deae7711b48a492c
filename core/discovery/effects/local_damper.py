"""A dashpot to ground: a damper, a rubbing seal, a bundle of cables, a foot on foam.

It changes D by c·uuᵀ and neither K nor M, so it does not compete in the search but is weighed
afterwards, see `dampers`.
"""

import numpy as np
import scipy.sparse as sp

from ..reduction.elements_and_supports import Structure
from .effect_kind import EffectKind, Magnitude
from .effect_numbers import EFFECTS
from .sentence_parts import odds
from .structure_points import Axes, Points, along_axes, translations

PEAKS = np.geomspace(*EFFECTS.damper_trials, EFFECTS.damper_sizes)
"""Sizes tried at every place: the ratio that the mode which feels a dashpot most gets from it."""


def dashpots(structure: Structure) -> Axes:
    """Return each basic axis along which a grid moves: D of a dashpot there changes by c·uuᵀ."""
    g = structure.model.geometry
    every = sp.identity(len(g.ids), format="csr")
    return along_axes(
        Points(translations(structure, every), g.xyz, [{"grids": [n]} for n in g.ids.tolist()])
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

    `modes` are the test modes, from 1, that it gives more damping than they have without; that
    there is none is so many `times` less likely.
    """
    which = f"mode{'s' if len(modes) > 1 else ''} {', '.join(map(str, modes))}"
    along = "".join(map(str, components))
    missing = KIND.sentence.format(damping=damping, components=along, region=region)
    return (
        f"{missing} explains the measured damping of {which} "
        f"(95 %: {interval[0]:.3g} to {interval[1]:.3g}); no dashpot at all is {odds(times)}."
    )


KIND = EffectKind(
    name="local_damper",
    label="local damper",
    sentence="A dashpot to ground of about {damping:.3g} (force per velocity, deck units) in "
    "direction {components} is missing {region}: it",
    magnitudes=(Magnitude("damping", EFFECTS.damper_error),),
)
