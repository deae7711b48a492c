"""Universal files (.unv, .uff): modal tests, geometry, frequency responses."""

from .content import Dataset, Function, Header, Skipped, Trace, Units, UniversalContent
from .measurement import read_test
from .reading import read_universal
from .systems import CoordinateSystem

__all__ = [
    "CoordinateSystem",
    "Dataset",
    "Function",
    "Header",
    "Skipped",
    "Trace",
    "Units",
    "UniversalContent",
    "read_test",
    "read_universal",
]
