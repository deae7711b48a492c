"""Degrees of freedom: which node, which component, along which axis."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..arrays import Floats, Ints, hold
from ..errors import InputError
from ..noun import Noun

_AXES = np.vstack([np.eye(3), np.eye(3)])


@dataclass(frozen=True, eq=False)
class Dofs(Noun):
    """One row per degree of freedom; analysis and test use the same type.

    Parameters
    ----------
    node : (n,) int
        Node number.
    component : (n,) int
        1, 2, 3 translation, 4, 5, 6 rotation, in the node's displacement system.
    axis : (n, 3) float, optional
        Unit vector of each degree of freedom in the basic frame of its geometry. Default: the
        basic axes. A sensor mounted backwards or askew has its own axis here.
    """

    node: Ints
    component: Ints
    axis: Floats = None  # type: ignore[assignment]

    def __post_init__(self) -> None:
        hold(self, "node", np.int64, ("n",))
        hold(self, "component", np.int64, self.node.shape)
        if not np.isin(self.component, range(1, 7)).all():
            raise InputError("component of Dofs must be 1 to 3 (translation) or 4 to 6 (rotation)")
        if self.axis is None:
            object.__setattr__(self, "axis", _AXES[self.component - 1])
        hold(self, "axis", np.float64, (len(self.node), 3))

    def __len__(self) -> int:
        return len(self.node)

    def take(self, rows: Ints) -> Dofs:
        """Return the degrees of freedom of the given rows (indices or mask)."""
        return Dofs(self.node[rows], self.component[rows], self.axis[rows])

    @property
    def directions(self) -> list[str]:
        """Directions as engineers write them: X, Y, Z, RX, RY, RZ."""
        letters = ("X", "Y", "Z", "RX", "RY", "RZ")
        return [letters[c - 1] for c in self.component]

    @property
    def labels(self) -> list[str]:
        """``node:direction``, e.g. ``12:Z``."""
        return [f"{n}:{d}" for n, d in zip(self.node, self.directions, strict=True)]
