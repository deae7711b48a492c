"""What a cause outside the list of effects makes of the truth."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from ..calculix import Modes
from ..hide import Scene
from ..mesh import Bar, Floats, Ints, Mesh
from ..truth import Truth

Entry = dict[str, Any]


@dataclass(frozen=True, eq=False)
class Cause:
    """What a cause makes of the truth.

    `felt` turns the modes of the truth into those of the structure; `runs` roving sensors of
    `sensor_mass` [t] in all measure a part of the points each; `may` are findings that would be
    right: what a listed effect and this cause have in common; `sections` are those of bars that
    the deck does not have.
    """

    mesh: Mesh
    entry: Entry
    truth: Truth = field(default_factory=Truth)
    felt: Callable[[Modes], Modes] | None = None
    runs: int = 1
    sensor_mass: float = 0.0
    may: tuple[Entry, ...] = ()
    sections: dict[int, Bar] = field(default_factory=dict)


def size(scene: Scene, low: float, high: float) -> float:
    """Return a size between two, evenly on a logarithmic scale."""
    return float(np.exp(scene.rng.uniform(np.log(low), np.log(high))))


def centres(m: Mesh) -> Floats:
    """Return the middles of the elements, quads then bars."""
    quads = m.xyz[m.quads[:, :4]].mean(axis=1) if m.quads.size else np.zeros((0, 3))
    bars = m.xyz[m.bars[:, :2]].mean(axis=1) if m.bars.size else np.zeros((0, 3))
    return np.concatenate([quads, bars])


def nodes_of(m: Mesh, line: int) -> Ints:
    """Return the nodes of a line in order, ends included."""
    bars = m.bars[m.bar_line == line]
    return np.array([*bars[:, [0, 2]].ravel(), bars[-1, 1]])
