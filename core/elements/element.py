"""What the rest of trueup asks of an element."""

from collections.abc import Callable
from dataclasses import dataclass, field

import numpy as np

from ..arrays import Bools, Floats, Ints
from ..data.shapes import Shape


@dataclass(frozen=True, eq=False, kw_only=True)
class Element:
    """A kind of element and its facts.

    Parameters
    ----------
    name : str
        Lower case, its own.
    shape : Shape or None
        What is drawn and what a sensor can lie on; None for what stands nowhere (scalar springs).
    freedoms : {1, 3, 6}
        Degrees of freedom a node: any one; u v w; u v w rx ry rz.
    stiffness : callable
        ``stiffness(xyz, ...)``: matrices (n, nodes * freedoms, nodes * freedoms) of n elements in
        the basic frame, from what the law of the element needs, node positions first.
    mass : callable or None
        ``mass(xyz, density, ..., coupled)`` likewise, consistent where `coupled`, else lumped;
        density by volume, area or length as the shape has it. None: without mass.
    edges : (m, 2) int
        Ends of the edges with a middle node, in the order of the middle nodes, which follow the
        corners.
    material : bool
        Whether it is a piece of material, of which some may be missing or too much, and not a
        spring or a mass at a place.
    axes : callable or None
        Element axes (n, 3, 3) from node positions, rows are unit vectors.
    sound : callable or None
        Which elements are neither flat nor turned inside out, (n,), from node positions.
    integrations : tuple of str
        Words for the ways to integrate the stiffness that ``stiffness(..., word)`` knows, the
        usual one first.
    linear_mass : (corners, corners) float or None
        Consistent mass of an element of unit mass by linear interpolation, where the error of a
        mesh is to be estimated by it.
    exact : bool
        Whether the stiffness is exact between the nodes, so that lumping the mass of a straight
        bar (`bar.bar_mass`) is all that a coarse mesh gets wrong.
    curved : bool
        Whether its length is another than that between its ends.
    unknown : str
        What of its stiffness in Nastran is not known, in words, where another law stands for it.
    """

    name: str
    shape: Shape | None
    freedoms: int
    stiffness: Callable[..., Floats]
    mass: Callable[..., Floats] | None = None
    edges: Ints = field(default_factory=lambda: np.zeros((0, 2), np.int64))
    material: bool = True
    axes: Callable[[Floats], Floats] | None = None
    sound: Callable[[Floats], Bools] | None = None
    integrations: tuple[str, ...] = ()
    linear_mass: Floats | None = None
    exact: bool = False
    curved: bool = False
    unknown: str = ""

    @property
    def corners(self) -> int:
        """Number of corners."""
        return self.shape.corners if self.shape else 0

    @property
    def nodes(self) -> int:
        """Number of nodes: corners, then middle nodes."""
        return self.corners + len(self.edges)

    @property
    def dimension(self) -> int:
        """0 for what stands at points: masses and springs, drawn as lines or not."""
        return self.shape.dimension if self.shape and self.material else 0
