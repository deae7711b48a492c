"""A body of revolution: the harmonics of its test and analysis modes as they are paired."""

from dataclasses import dataclass

import numpy as np

from ..arrays import Floats
from ..noun import Noun
from .comparison import Comparison
from .harmonics import Harmonic, find_rings, harmonics


@dataclass(frozen=True, eq=False)
class Revolution(Noun):
    """The axis that sensors stand round, and what each mode is round it (None: a mixture).

    Modes of the side that was turned are those of the pairs.
    """

    origin: Floats
    direction: Floats
    test: tuple[Harmonic | None, ...]
    analysis: tuple[Harmonic | None, ...]


def revolution(c: Comparison) -> Revolution | None:
    """Return the harmonics of a comparison; None where its sensors stand round no axis."""
    rings = find_rings(c.geometry.xyz, c.observation.xyz, c.observation.sensors.axis)
    if rings is None:
        return None
    sides = {"test": c.test.shapes, "analysis": c.observation.matrix @ c.analysis.shapes}
    rotate = c.correlation.criteria.rotate
    if rotate in sides:
        turned = sides[rotate]
        size = np.linalg.norm(turned, axis=0) if rotate == "test" else np.ones(turned.shape[1])
        sides[rotate] = turned / np.where(size > 0.0, size, 1.0) @ c.correlation.transformation
    found = {side: harmonics(rings, np.asarray(shapes)) for side, shapes in sides.items()}
    return Revolution(rings.origin, rings.direction, found["test"], found["analysis"])
