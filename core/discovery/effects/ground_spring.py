"""A spring to ground: a cable, a hose, a suspension, a contact that the model does not have."""

import numpy as np

from ..reduction.elements_and_supports import Structure
from .candidates import Candidates
from .effect_kind import STIFFNESS, EffectKind, Scale
from .effect_laws import SpringLaw
from .effect_numbers import EFFECTS
from .structure_points import along_axes, points_of


def _places(structure: Structure, scale: Scale) -> tuple[Candidates, ...]:
    """Springs along each basic axis at every grid, shell middle and shell edge that moves."""
    xyz, root, where = along_axes(points_of(structure))
    made = Candidates(
        kind=KIND,
        xyz=xyz,
        law=SpringLaw(np.zeros((len(xyz), 1))),
        trials=scale.springs(),
        root=root,
        rows_each=1,
        where=where,
        typical=scale.spring,
        spread=np.array([EFFECTS.spring_spread]),
    )
    return (made,)


KIND = EffectKind(
    name="ground_spring",
    label="spring to ground",
    plural="springs to ground",
    sentence="A spring to ground of {size} in direction {components} is missing {region}: it",
    magnitudes=(STIFFNESS,),
    places=_places,
    across=EFFECTS.springs_across,
    directed=True,
    nature="spring",
)
