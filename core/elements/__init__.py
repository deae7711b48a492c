"""Element matrices, vectorised over elements."""

from .bar import (
    bar_axes,
    bar_mass,
    bar_stiffness,
    offset_transform,
    rod_mass,
    rod_stiffness,
)
from .shell import (
    ShellSection,
    corner_normals,
    grid_normals,
    isotropic_section,
    quad4_axes,
    quad4_corner_jacobians,
    quad4_mass,
    quad4_stiffness,
    rotate_section,
    tria3_area,
    tria3_axes,
    tria3_mass,
    tria3_stiffness,
)

__all__ = [
    "ShellSection",
    "bar_axes",
    "bar_mass",
    "bar_stiffness",
    "corner_normals",
    "grid_normals",
    "isotropic_section",
    "offset_transform",
    "quad4_axes",
    "quad4_corner_jacobians",
    "quad4_mass",
    "quad4_stiffness",
    "rod_mass",
    "rod_stiffness",
    "rotate_section",
    "tria3_area",
    "tria3_axes",
    "tria3_mass",
    "tria3_stiffness",
]
