"""The datasets of universal files that are read and written, one line each."""

from ....core.errors import InputError, require_kind
from .coordinate_systems import SYSTEMS_18, SYSTEMS_2420
from .dataset_kind import DatasetKind
from .elements import ELEMENTS
from .functions import FUNCTIONS_58
from .headers import HEADER, MODEL_HEADER
from .mode_shapes import SHAPES_55, SHAPES_2414
from .nodes import NODES_15, NODES_2411
from .trace_lines import TRACE_LINES
from .units import UNITS_164

DATASETS: list[DatasetKind] = [
    HEADER,
    MODEL_HEADER,
    UNITS_164,
    SYSTEMS_18,
    SYSTEMS_2420,
    NODES_15,
    NODES_2411,
    ELEMENTS,
    TRACE_LINES,
    SHAPES_55,
    SHAPES_2414,
    FUNCTIONS_58,
]
"""In the order in which they are written and told."""


def register_dataset(kind: DatasetKind) -> None:
    """Read, tell and write a further kind of dataset; ``DATASETS.remove(kind)`` undoes it.

    Raises
    ------
    InputError
        Its number is taken.
    """
    require_kind(kind, DatasetKind, "what is registered")
    taken = dataset_of(kind.number)
    if taken is not None:
        raise InputError(f"dataset {kind.number} is taken: {taken.name}")
    DATASETS.append(kind)


def dataset_of(number: int) -> DatasetKind | None:
    """Return the kind of dataset of a number; None where it is not read."""
    return next((kind for kind in DATASETS if kind.number == number), None)


def name_of(number: int) -> str:
    """Name of a dataset, or that it is not known."""
    kind = dataset_of(number)
    return kind.name if kind else _NOT_READ.get(number, "unknown to trueup")


_NOT_READ = {
    **dict.fromkeys(
        (752, 770, 772, 2417, 2429, 2430, 2432, 2435, 2452, 2467, 2477), "permanent groups"
    ),
    **dict.fromkeys((789, 2437, 2448, 2470), "physical properties"),
    56: "data at element centres", 57: "data at nodes on elements", 90: "model lists",
    152: "optimisation", 666: "history", 735: "nodes on surfaces", 756: "trace lines",
    757: "constraints", 758: "loads", 780: "elements", 781: "nodes", 790: "load sets",
    791: "restraint sets", 1710: "materials", 1858: "qualifiers of a function", 3033: "tables",
}  # fmt: skip
"""Names of datasets that are listed as skipped."""
