"""What the truth has beyond the deck, in terms of its own mesh."""

from __future__ import annotations

from dataclasses import dataclass, field

from .mesh import Floats, Ints


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
class Field:
    """Factors for every element, quads then bars; of a bar the thickness is left alone."""

    modulus: Floats | float = 1.0
    thickness: Floats | float = 1.0
    density: Floats | float = 1.0


@dataclass(frozen=True)
class Stand:
    """Equipment: `mass` rigidly held at node + offset, half of it at `arm` to either side [mm]."""

    node: int
    offset: tuple[float, float, float]
    arm: tuple[float, float, float]
    mass: float


@dataclass(frozen=True)
class Preload:
    """What stresses the structure before it swings: an acceleration [mm/s²] or strains of groups.

    `strains` (bar or shell group → free thermal strain); a free structure is held without
    reactions meanwhile.
    """

    acceleration: tuple[float, float, float] = (0.0, 0.0, 0.0)
    strains: tuple[tuple[int, float], ...] = ()


@dataclass(frozen=True, eq=False)
class Truth:
    """Everything that differs from the deck; `factors` scale a group's thickness or bar modulus.

    `links` are springs along the line between two nodes [N/mm]; `eccentric` says by how much of
    its height the bars of a line lie beside their nodes; a `suspended` structure has six modes on
    its `springs` that the test leaves out.
    """

    factors: dict[int, float] = field(default_factory=dict)
    modulus: float = 1.0
    patches: tuple[Patchwork, ...] = ()
    masses: tuple[tuple[int, float], ...] = ()
    springs: tuple[tuple[int, int, float], ...] = ()
    absorbers: tuple[Absorber, ...] = ()
    soft: tuple[Soft, ...] = ()
    dampers: tuple[tuple[int, int, float], ...] = ()
    freed: tuple[tuple[int, int], ...] = ()
    fields: tuple[Field, ...] = ()
    stands: tuple[Stand, ...] = ()
    links: tuple[tuple[int, int, float], ...] = ()
    eccentric: dict[int, float] = field(default_factory=dict)
    preload: Preload | None = None
    suspended: bool = False
