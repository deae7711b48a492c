"""Elements: from node positions and constants to matrices, vectorised over elements.

An element is one file that declares its facts in an `Element`, and one line here;
`register_element` adds one from outside.
"""

from ..errors import InputError, require_kind
from .connectors.lumped import BUSH, GENERAL, GROUNDED_BUSH, MASS, SPRING
from .connectors.patches import PATCH_CONNECTOR
from .element import Element
from .lines.bar import BAR, ROD
from .lines.beam import BEAM
from .lines.beam3 import BEAM3
from .lines.bend import BEND
from .surfaces.axisymmetric import QUADX4, QUADX8, TRIAX3, TRIAX6
from .surfaces.curved_shell import QUAD8, TRIA6
from .surfaces.quad4 import QUAD4
from .surfaces.quadr import QUADR, TRIAR
from .surfaces.shear import SHEAR_PANEL
from .surfaces.tria3 import TRIA3
from .volumes.hexa import HEXA8, HEXA20
from .volumes.penta import PENTA6, PENTA15
from .volumes.pointed import PYRAMID5, PYRAMID13, TETRA4, TETRA10

__all__ = ["ELEMENTS", "Element", "register_element"]

ELEMENTS = {e.name: e for e in tuple(vars().values()) if isinstance(e, Element)}
"""Every element that is imported above, by name."""


def register_element(element: Element) -> None:
    """Add an element; ``del ELEMENTS[name]`` undoes it.

    Raises
    ------
    InputError
        Its name is taken.
    """
    require_kind(element, Element, "what is registered")
    if element.name in ELEMENTS:
        raise InputError(f"there is an element {element.name!r} already")
    ELEMENTS[element.name] = element
