"""Universal files (.unv, .uff): modal tests, geometry, frequency responses."""

from .datasets.dataset_kind import DatasetKind, Gathered, Outgoing
from .datasets.known_datasets import DATASETS, register_dataset
from .describe_universal import describe_universal
from .modal_test import ModalTest, read_pyuff, read_test
from .pyuff_bridge import is_pyuff
from .read_universal import read_universal
from .systems import CoordinateSystem
from .universal_content import Dataset, Function, Header, Skipped, Trace, Units, UniversalContent
from .write_universal import write_universal

__all__ = [
    "DATASETS",
    "CoordinateSystem",
    "Dataset",
    "DatasetKind",
    "Function",
    "Gathered",
    "Header",
    "ModalTest",
    "Outgoing",
    "Skipped",
    "Trace",
    "Units",
    "UniversalContent",
    "describe_universal",
    "is_pyuff",
    "read_pyuff",
    "read_test",
    "read_universal",
    "register_dataset",
    "write_universal",
]
