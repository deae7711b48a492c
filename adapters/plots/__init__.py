"""Pictures of a run as matplotlib figures."""

from .bars import frequencies
from .matrix import mac
from .structure import misfit, shapes

__all__ = ["frequencies", "mac", "misfit", "shapes"]
