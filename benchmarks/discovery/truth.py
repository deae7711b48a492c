"""What the truth has beyond the deck, in terms of its own mesh."""

from __future__ import annotations

from dataclasses import dataclass, field

from .mesh import Ints


@dataclass(frozen=True, eq=False)
class Patchwork:
    """Elements (0-based quads, then bars) whose modulus and mass a hidden effect changes."""

    quads: Ints
    bars: Ints
    modulus: float = 1.0
    mass_per_area: float = 0.0


@dataclass(frozen=True)
class Absorber:
    """A mass on a spring in direction `component` (1-3) of a node."""

    node: int
    component: int
    mass: float
    stiffness: float


@dataclass(frozen=True)
class Soft:
    """A rotational spring [N mm/rad] about all axes: bar line `line` at its node `node`.

    `ground` puts the spring between the node (held in translation) and the clamped ground.
    """

    node: int
    line: int
    stiffness: float
    ground: bool = False


@dataclass(frozen=True, eq=False)
class Truth:
    """Everything that differs from the deck; `factors` scale a group's thickness or bar modulus."""

    factors: dict[int, float] = field(default_factory=dict)
    modulus: float = 1.0
    patches: tuple[Patchwork, ...] = ()
    masses: tuple[tuple[int, float], ...] = ()
    springs: tuple[tuple[int, int, float], ...] = ()
    absorbers: tuple[Absorber, ...] = ()
    soft: tuple[Soft, ...] = ()
    dampers: tuple[tuple[int, int, float], ...] = ()
    freed: tuple[tuple[int, int], ...] = ()
