"""An attached mass: equipment, a bracket, ballast, a sensor's own mass."""

from collections.abc import Sequence
from typing import Any

import numpy as np

from ...arrays import Floats
from ..reduction.elements_and_supports import Structure, used
from .candidates import Candidates, with_twins
from .effect_kind import MASS, EffectKind, Magnitude, Scale
from .effect_laws import MassLaw, TunedLaw
from .effect_numbers import EFFECTS
from .element_patches import Patch, on_patches, patches_of
from .structure_points import points_of


class Mounted(Candidates):
    """Masses on mounts."""

    def around(self, theta: Sequence[float], changes: Floats) -> Floats:
        """Return θ (2,) with the mass moved by `changes` (n,), and on a soft and a stiff mount."""
        sizes = theta[0] + np.append(changes, np.zeros(2))
        soft = self.lower[1] + EFFECTS.mount_soft
        mounts = np.append(np.full(len(changes), theta[1]), [soft, self.typical[1]])
        return np.column_stack([sizes, mounts])


def _places(structure: Structure, scale: Scale) -> tuple[Candidates, ...]:
    """Masses at points, and masses on small patches of shells.

    Points are those of `points_of`. Equipment has a footprint,
    and a thin shell gives under a point far more than under a foot, so small patches count as well.
    What is heavier than the structure is no mass on it but what it stands on.
    """
    moves, xyz, where = points_of(structure)
    typical, spread = np.array([np.log(EFFECTS.mass * scale.mass)]), np.array([EFFECTS.mass_spread])
    top, (middle, off, stiffest) = np.log(scale.band_hz[1]), EFFECTS.mount
    masses = scale.masses()
    at_points = Mounted(
        kind=KIND,
        xyz=xyz,
        law=TunedLaw(np.zeros((len(xyz), 1)), 0.0),
        trials=np.insert(masses, 1, top + np.log(middle), axis=1),
        root=moves,
        rows_each=3,
        where=tuple(where),
        typical=np.append(typical, top + np.log(middle)),
        spread=np.append(spread, off),
        steps=np.ones(2),
        lower=np.array([-np.inf, top + np.log(EFFECTS.absorber_band[1])]),
        upper=np.array([np.log(scale.mass), top + np.log(stiffest)]),
    )
    feet, prior = patches_of(structure, scale.size, EFFECTS.feet), (typical, spread)
    on_feet = on_patches(KIND, structure, feet, MassLaw(), masses, prior, _grids)
    grids = structure.model.geometry.xyz[used(structure)]
    held = grids[:0] if structure.supports is None else structure.supports.places
    return (*with_twins(at_points, grids, scale.size, held), *on_feet)


def _grids(structure: Structure, feet: Sequence[Patch]) -> tuple[dict[str, Any], ...]:
    ids = structure.model.geometry.ids
    corners = [structure.members[p.member].corners[p.rows] for p in feet]
    return tuple({"grids": ids[np.unique(c)].tolist()} for c in corners)


KIND = EffectKind(
    name="point_mass",
    label="attached mass",
    plural="attached masses",
    sentence="About {mass} of mass is missing {region}: an attached mass",
    magnitudes=(MASS, Magnitude("mount_hz", 0.0, known_only=True)),
    places=_places,
    across=EFFECTS.masses_across,
    nature="mass",
)
