"""Element families: one module each, from cards to element matrices."""

from __future__ import annotations

from collections.abc import Callable

from .bars import bars, rods
from .beams import beams
from .bushes import bushes
from .common import Context, Group, Key, Settings
from .masses import masses
from .panels import panels
from .shells import shells
from .solids import solids
from .springs import springs

FAMILIES: dict[str, Callable[[Context], list[Group]]] = {
    "shells": shells,
    "panels": panels,
    "solids": solids,
    "bars": bars,
    "beams": beams,
    "rods": rods,
    "bushes": bushes,
    "springs": springs,
    "masses": masses,
}
"""Everything that makes element matrices, by name."""

SUPPORTED = frozenset(
    (
        *("CQUAD4", "CTRIA3", "CQUADR", "CTRIAR", "CQUAD8", "CTRIA6", "CSHEAR"),
        *("CBAR", "CBEAM", "CROD", "CONROD", "CTUBE"),
        *("CHEXA", "CPENTA", "CTETRA", "CPYRAM", "CBUSH", "CBUSH1D"),
        *("CELAS1", "CELAS2", "CELAS3", "CELAS4"),
        *("CMASS1", "CMASS2", "CMASS3", "CMASS4", "CONM1", "CONM2"),
    )
)
"""Element cards that some family reads."""

__all__ = ["FAMILIES", "SUPPORTED", "Context", "Group", "Key", "Settings"]
