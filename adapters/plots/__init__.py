"""Pictures of a run as matplotlib figures."""

from .bars import frequencies
from .matrix import mac
from .structure import PairedShapes, misfit, shapes

__all__ = ["PairedShapes", "frequencies", "mac", "misfit", "shapes"]
