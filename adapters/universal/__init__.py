"""Universal files (.unv, .uff): modal tests, geometry, frequency responses."""

from .content import Dataset, Function, Header, Skipped, Trace, Units, UniversalContent
from .describing import describe_universal
from .measurement import read_test
from .reading import read_universal
from .systems import CoordinateSystem
from .writing import write_universal

__all__ = [
    "CoordinateSystem",
    "Dataset",
    "Function",
    "Header",
    "Skipped",
    "Trace",
    "Units",
    "UniversalContent",
    "describe_universal",
    "read_test",
    "read_universal",
    "write_universal",
]
