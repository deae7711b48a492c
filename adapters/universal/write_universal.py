"""Write universal files that other programs open."""

from collections.abc import Sequence
from pathlib import Path

from ...core.data.frfs import Frfs
from ...core.data.geometry import Geometry
from ...core.data.modes import Modes
from ...core.errors import InputError, Place
from ...core.files import replacing
from .datasets.axis_components import node_systems
from .datasets.dataset_kind import Outgoing
from .datasets.known_datasets import DATASETS
from .datasets.units import UNITS
from .universal_content import Function, Units


def write_universal(
    path: Path,
    *,
    geometry: Geometry | None = None,
    modes: Modes | None = None,
    frfs: Frfs | None = None,
    functions: Sequence[Function] = (),
    extensions: Sequence[object] = (),
    units: Units | str | None = None,
    binary: bool = False,
    single: bool = False,
    node_dataset: int = 2411,
    description: str = "",
) -> None:
    """Write a universal file; it takes its name only when it is whole.

    Parameters
    ----------
    path : Path
        Replaced if it exists.
    geometry : Geometry, optional
        Nodes as dataset 2411 (or 15), lines as trace lines (82), other elements as 2412.
    modes : Modes, optional
        Dataset 55, one each: vectors in the basic frame, directions that are not among the dofs
        zero. The format keeps six digits.
    frfs : Frfs, optional
        Dataset 58, or 58b with `binary`; combinations that are NaN are not written.
    functions : sequence of Function, optional
        Dataset 58 or 58b each, whatever they are.
    extensions : sequence, optional
        What datasets registered from outside are printed from.
    units : Units or {"m", "mm", "in", "ft"}, optional
        Dataset 164. Default: the length unit of the geometry, with forces in newton (pounds of
        force for in and ft); nothing where that is not known.
    binary : bool
        Responses as 58b (IEEE 754, little endian): exact, and read many times faster.
    single : bool
        Responses in single precision.
    node_dataset : {2411, 15}
        2411 keeps all digits of the positions; 15 is for older programs and keeps six.
    description : str
        Second line of the header.

    Raises
    ------
    InputError
        Nothing to write, a file that cannot be written, or content that the format cannot hold.
    """
    target = Path(path)
    if geometry is None and modes is None and frfs is None and not (functions or extensions):
        raise InputError(
            f"nothing to write to {target}: give a geometry, modes or responses", file=target
        )
    if node_dataset not in (15, 2411):
        raise InputError(f"nodes are written as dataset 2411 or 15, not {node_dataset}")
    systems = {} if frfs is None else node_systems(frfs.responses, frfs.references)
    if systems and geometry is None:
        raise Place(target).error(
            "responses along axes that are not basic need a geometry, whose nodes "
            "carry the coordinate systems"
        )
    out = Outgoing(
        target.name, description, geometry, modes, frfs, tuple(functions),
        _units_of(units, geometry), tuple(extensions), systems, binary, single, node_dataset,
    )  # fmt: skip
    with replacing(target) as fresh, fresh.open("wb") as stream:
        stream.writelines(part for kind in DATASETS for part in kind.write(out))


def _units_of(units: Units | str | None, geometry: Geometry | None) -> Units | None:
    if isinstance(units, Units):
        return units
    unit = units or (geometry.length_unit if geometry else None)
    if unit is None:
        return None
    if unit not in UNITS:
        raise InputError(f"length unit {unit!r} is none of {', '.join(UNITS)}")
    return UNITS[unit]
