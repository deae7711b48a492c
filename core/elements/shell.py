"""The shells in one place."""

from .normals import corner_normals, grid_normals
from .quad4 import quad4_axes, quad4_corner_jacobians, quad4_mass, quad4_stiffness
from .section import ShellSection, isotropic_section, rotate_section
from .tria3 import tria3_area, tria3_axes, tria3_mass, tria3_stiffness

__all__ = [
    "ShellSection",
    "corner_normals",
    "grid_normals",
    "isotropic_section",
    "quad4_axes",
    "quad4_corner_jacobians",
    "quad4_mass",
    "quad4_stiffness",
    "rotate_section",
    "tria3_area",
    "tria3_axes",
    "tria3_mass",
    "tria3_stiffness",
]
