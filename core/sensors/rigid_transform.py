"""Moves from test coordinates to analysis coordinates."""

from dataclasses import dataclass

import numpy as np

from ..arrays import Floats, hold, require_finite
from ..errors import InputError
from ..noun import Noun
from .placement_numbers import PLACEMENT


@dataclass(frozen=True, eq=False)
class Transform(Noun):
    """A rigid move with a change of unit: x_analysis = rotation @ (scale * x_test) + translation.

    Parameters
    ----------
    rotation : (3, 3) float
        Proper (determinant +1): mirror images are not moves.
    translation : (3,) float
        In the analysis length unit.
    scale : float
        Analysis length units in one test length unit.

    Raises
    ------
    InputError
        The rotation is not a rotation or the scale not positive.
    """

    rotation: Floats
    translation: Floats
    scale: float = 1.0

    def __post_init__(self) -> None:
        hold(self, "rotation", np.float64, (3, 3), "the rotation of the test frame")
        hold(self, "translation", np.float64, (3,), "the translation of the test frame")
        require_finite(self.rotation, "the rotation of the test frame")
        require_finite(self.translation, "the translation of the test frame")
        R = self.rotation
        if np.abs(R @ R.T - np.eye(3)).max() > PLACEMENT.rotation or np.linalg.det(R) < 0:
            raise InputError(
                "the rotation of the test frame is not a proper rotation "
                f"(its determinant is {np.linalg.det(R):.6g}); mirror images are not allowed"
            )
        if not self.scale > 0:
            raise InputError(f"the scale of the test is {self.scale}; it must be positive")

    def apply(self, points: Floats) -> Floats:
        """Move points (n, 3) into the analysis frame."""
        return np.asarray((self.scale * points) @ self.rotation.T + self.translation)

    def turn(self, axes: Floats) -> Floats:
        """Turn directions (n, 3) into the analysis frame."""
        return np.asarray(axes @ self.rotation.T)


IDENTITY = Transform(np.eye(3), np.zeros(3))
