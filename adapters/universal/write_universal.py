"""Write universal files that other programs open."""

from __future__ import annotations

import os
import tempfile
from collections.abc import Iterator, Sequence
from datetime import datetime
from pathlib import Path

from ...core.arrays import Floats
from ...core.errors import InputError
from ...core.frfs import Frfs
from ...core.geometry import Geometry
from ...core.modes import Modes
from .content import Function, Units
from .printing import dataset, name_field, text_line
from .vectors import node_systems
from .writing_frfs import frf_datasets
from .writing_functions import function_datasets
from .writing_geometry import geometry_datasets
from .writing_modes import mode_datasets

UNITS = {
    "m": Units(1, "SI: Meter (newton)", 1.0, length_unit="m"),
    "mm": Units(10, "MN: mm (newton)", 1000.0, length_unit="mm"),
    "in": Units(7, "IN: Inch (pound f)", 1 / 0.0254, 0.2248089430997105, 1.8, 459.67, "in"),
    "ft": Units(2, "BG: Foot (pound f)", 1 / 0.3048, 0.2248089430997105, 1.8, 459.67, "ft"),
}


def write_universal(
    path: Path,
    *,
    geometry: Geometry | None = None,
    modes: Modes | None = None,
    frfs: Frfs | None = None,
    functions: Sequence[Function] = (),
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
    if geometry is None and modes is None and frfs is None and not functions:
        raise InputError(f"nothing to write to {target}: give a geometry, modes or responses")
    if node_dataset not in (15, 2411):
        raise InputError(f"nodes are written as dataset 2411 or 15, not {node_dataset}")
    systems = {} if frfs is None else node_systems(frfs.responses, frfs.references)
    if systems and geometry is None:
        raise InputError(
            f"{target}: responses along axes that are not basic need a geometry, whose nodes "
            "carry the coordinate systems"
        )
    parts = _parts(
        target, geometry, modes, frfs, functions, _units_of(units, geometry), systems, binary,
        single, node_dataset, description,
    )  # fmt: skip
    _write(target, parts)


def _units_of(units: Units | str | None, geometry: Geometry | None) -> Units | None:
    if isinstance(units, Units):
        return units
    unit = units or (geometry.length_unit if geometry else None)
    if unit is None:
        return None
    if unit not in UNITS:
        raise InputError(f"length unit {unit!r} is none of {', '.join(UNITS)}")
    return UNITS[unit]


def _parts(
    target: Path,
    geometry: Geometry | None,
    modes: Modes | None,
    frfs: Frfs | None,
    functions: Sequence[Function],
    units: Units | None,
    systems: dict[int, Floats],
    binary: bool,
    single: bool,
    node_dataset: int,
    description: str,
) -> Iterator[bytes]:
    yield _header(target.name, description)
    if units is not None:
        yield _unit_lines(units)
    if geometry is not None:
        yield from geometry_datasets(geometry, node_dataset, systems)
    if modes is not None:
        yield from mode_datasets(modes, systems)
    if frfs is not None:
        yield from frf_datasets(frfs, systems, binary, single)
    yield from function_datasets(functions, binary, single)


def _header(name: str, description: str) -> bytes:
    now = datetime.now().strftime("%d-%b-%y %H:%M:%S")
    saved = f"{now[:9]:10}{now[10:]:10}".encode()
    return dataset(
        151,
        text_line(name),
        text_line(description),
        text_line("trueup"),
        saved + b"%10d%10d%10d\n" % (0, 0, 0),
        saved + b"\n",
        text_line("trueup"),
        saved + b"\n",
    )


def _unit_lines(units: Units) -> bytes:
    factors = (
        units.length_factor,
        units.force_factor,
        units.temperature_factor,
        units.temperature_offset,
    )
    printed = [(b"%25.17E" % f).replace(b"E", b"D") for f in factors]
    head = b"%10d" % units.code + name_field(units.name, 20) + b"%10d\n" % 2
    return dataset(164, head, b"".join(printed[:3]) + b"\n", printed[3] + b"\n")


def _write(target: Path, parts: Iterator[bytes]) -> None:
    """Write all parts beside the target, then give them its name."""
    try:
        handle, name = tempfile.mkstemp(prefix=f".{target.name}.", dir=target.parent)
    except OSError as error:
        raise InputError(f"cannot write {target}: {error.strerror or error}") from error
    try:
        with os.fdopen(handle, "wb") as stream:
            for part in parts:
                stream.write(part)
        os.chmod(name, 0o666 & ~_umask())
        os.replace(name, target)
    except OSError as error:
        raise InputError(f"cannot write {target}: {error.strerror or error}") from error
    finally:
        if os.path.exists(name):
            os.unlink(name)


def _umask() -> int:
    mask = os.umask(0)
    os.umask(mask)
    return mask
