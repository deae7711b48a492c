"""Degrees of freedom: which node, which component, along which axis."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..arrays import Floats, Ints, frozen, require_shape
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
        object.__setattr__(self, "node", frozen(self.node, np.int64))
        object.__setattr__(self, "component", frozen(self.component, np.int64))
        require_shape(self.component, self.node.shape, "components")
        axis = _AXES[self.component - 1] if self.axis is None else self.axis
        object.__setattr__(self, "axis", frozen(axis, np.float64).reshape(-1, 3))
        require_shape(self.axis, (len(self.node), 3), "axes")

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
