"""Analysis modes from the user's own Nastran run, in basic axes."""

from collections.abc import Callable, Collection, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

from ....core.arrays import Ints, Numbers
from ....core.data.modes import Modes
from ....core.errors import Place
from ....core.files import reading
from ..deck.pynastran_bridge import file_of
from ..deck.read_deck import Deck
from ..op4.op4 import is_op4
from ..properties.grids import Points, point_dofs, read_points
from . import hdf5_modes, op2_modes
from .eigenvector_table import ModeHead, ModeTable
from .f06_modes import is_f06, read_f06_tables
from .hdf5_modes import read_hdf5_heads, read_hdf5_tables
from .op2_modes import read_op2_heads, read_op2_tables
from .op4_modes import full_op4_modes, read_op4_modes
from .punch_modes import is_punched_result, read_punch_tables

Reader = Callable[[Path], tuple[list[ModeTable], tuple[str, ...]]]

HDF5, OP2, PUNCH, F06 = "Nastran HDF5", "Nastran OP2", "Nastran punch", "Nastran F06"

READERS: dict[str, Reader] = {
    HDF5: read_hdf5_tables,
    OP2: read_op2_tables,
    PUNCH: read_punch_tables,
    F06: read_f06_tables,
}
"""Readers by kind of file: path to tables and the names of all that the file holds."""

HEAD_READERS: dict[str, Callable[[Path], tuple[Sequence[ModeHead], tuple[str, ...]]]] = {
    **READERS,
    HDF5: read_hdf5_heads,
    OP2: read_op2_heads,
}
"""The same without the values where the kind of file lets them be left in it."""

_HEAD = 20000
_HDF5_SIGNATURE = b"\x89HDF\r\n\x1a\n"
_SAME = 1e-5  # relative difference of eigenvalues that superelements share


def read_modes(
    path: Path | str | Any,
    deck: Deck | None = None,
    subcase: int | None = None,
    modes: Collection[int] | None = None,
) -> Modes:
    """Read normal or complex modes from an OP2, a Nastran HDF5, a punch, an F06 or an OP4 file.

    An OP4 holds shapes and eigenvalues, on the g-set of the deck or as a list beside it says.

    Punch and F06 hold seven digits: take them only where there is no OP2 or HDF5.

    Frequencies are undamped natural frequencies in Hz, from the eigenvalues. Superelements that
    list the same modes are put together, each mode once. Of a conjugate pair of complex roots the
    one with positive imaginary part is taken. Where a file has both real and complex modes of a
    subcase, the real ones are taken.

    Parameters
    ----------
    path : path or pyNastran OP2
        The file; its kind is told by its contents.
    deck : Deck, optional
        The deck of the run: gives the displacement systems (CD), by which the shapes are turned
        to basic axes. Without it the shapes of an OP2 stay along the axes of the file.
    subcase : int, optional
        Which one, where the file has several; default that of the deck.
    modes : collection of int, optional
        Only these mode numbers; of an OP2 or HDF5 nothing else is read. Default: all.

    Returns
    -------
    Modes
        Dofs: six a grid, grids increasing, then scalar points (component 1).

    Raises
    ------
    InputError
        No modes in the file, several subcases to choose from, grids that the deck lacks, a file
        that tells of displacement systems but no deck.
    """
    path = Path(file_of(path))
    if is_op4(path):
        return read_op4_modes(path) if deck is None else full_op4_modes(path, deck)
    kind = kind_of_results(path)
    tables, names = _tables(path, kind, modes)
    if not tables:
        held = ", ".join(names[:8]) or "nothing"
        raise Place(path).fault(
            f"holds no eigenvectors (it holds {held}): ask Nastran for DISPLACEMENT in "
            "a SOL 103 run"
        )
    if deck is None and kind in _OWN_SYSTEMS and not all(t.basic for t in tables):
        turned = _OWN_SYSTEMS[kind](path)
        if len(turned):
            raise Place(path).error(
                f"grid {turned[0]} has a displacement system of its own: name the deck as well"
            )
    chosen = _of_subcase(tables, deck, subcase, path)
    table = _joined([_without_conjugates(t) for t in chosen], path)
    return _modes(table, None if deck is None else read_points(deck.bulk), path)


_OWN_SYSTEMS: dict[str, Callable[[Path], Ints]] = {
    HDF5: hdf5_modes.grids_with_own_systems,
    OP2: op2_modes.grids_with_own_systems,
}


def _tables(
    path: Path, kind: str, modes: Collection[int] | None
) -> tuple[list[ModeTable], tuple[str, ...]]:
    if kind == OP2:
        tables, names = read_op2_tables(path, modes)
    elif kind == HDF5:
        tables, names = read_hdf5_tables(path, modes)
    else:
        tables, names = READERS[kind](path)
        if modes is not None:
            tables = [t.take(slice(None), np.isin(t.numbers, list(modes))) for t in tables]
            tables = [t for t in tables if len(t.numbers)]
    if modes is not None and not tables:
        asked = ", ".join(map(str, sorted(modes)))
        raise Place(path).fault(f"has none of the modes {asked}")
    return tables, names


def kind_of_results(path: Path) -> str:
    """Tell the kind of a results file by its contents: a key of `READERS`.

    Raises
    ------
    InputError
        It cannot be read.
    """
    with reading(path), path.open("rb") as stream:
        head = stream.read(_HEAD)
    if head.startswith(_HDF5_SIGNATURE):
        return HDF5
    if path.suffix.lower() in (".h5", ".hdf5"):
        raise Place(path).fault("is not an HDF5 file, whatever its name says")
    text = "" if b"\0" in head else head.decode("latin-1")
    if is_punched_result(text):
        return PUNCH
    return F06 if is_f06(text) or (text and path.suffix.lower() == ".f06") else OP2


def _of_subcase(
    tables: list[ModeTable], deck: Deck | None, subcase: int | None, path: Path
) -> list[ModeTable]:
    there = sorted({t.subcase for t in tables})
    listed = ", ".join(map(str, there))
    if subcase is not None and subcase not in there:
        raise Place(path).fault(f"has no modes of subcase {subcase}: it has those of {listed}")
    if subcase is None and deck is not None and deck.case.subcase in there:
        subcase = deck.case.subcase
    if subcase is None and len(there) > 1:
        raise Place(path).fault(f"holds modes of subcases {listed}: say which one is meant")
    chosen = [t for t in tables if t.subcase == (there[0] if subcase is None else subcase)]
    real = [t for t in chosen if not t.is_complex]
    return real or chosen


def _without_conjugates(table: ModeTable) -> ModeTable:
    if not table.is_complex or (table.eigenvalues.imag >= 0.0).all():
        return table
    return table.take(slice(None), table.eigenvalues.imag >= 0.0)


def _joined(tables: list[ModeTable], path: Path) -> ModeTable:
    """Put the superelements of one eigensolution together, each point once."""
    tables = sorted(tables, key=lambda t: t.superelement)
    first = tables[0]
    known = set(first.points.tolist())
    parts = [first]
    for table in tables[1:]:
        if table.superelement == first.superelement:
            raise Place(path).fault(
                f"holds modes of subcase {table.subcase} several times (design cycles, "
                "restarts, speeds of a rotor): give the file of one run"
            )
        if not _shares_modes(first, table):
            raise Place(path).error(
                f"superelements {first.superelement} and {table.superelement} hold "
                "different modes: give the modes of the assembled structure"
            )
        new = np.array([p not in known for p in table.points.tolist()], bool)
        known |= set(table.points.tolist())
        parts.append(table.take(new, slice(None)))
    if len(parts) == 1:
        return first
    return replace(
        first,
        points=np.concatenate([t.points for t in parts]),
        scalar=np.concatenate([t.scalar for t in parts]),
        values=np.asfortranarray(np.concatenate([t.values for t in parts])),
    )


def _shares_modes(a: ModeTable, b: ModeTable) -> bool:
    if len(a.eigenvalues) != len(b.eigenvalues) or a.basic != b.basic:
        return False
    scale = float(np.abs(a.eigenvalues).max(initial=0.0))
    return bool(np.allclose(a.eigenvalues, b.eigenvalues, rtol=_SAME, atol=1e-9 * scale))


def _modes(table: ModeTable, points: Points | None, path: Path) -> Modes:
    scalar = table.scalar
    if points is not None:
        _require_same_points(table, points, path)
        scalar = np.isin(table.points, points.scalar_ids)
    grids, scalars = np.flatnonzero(~scalar), np.flatnonzero(scalar)
    grids = grids[np.argsort(table.points[grids], kind="stable")]
    scalars = scalars[np.argsort(table.points[scalars], kind="stable")]
    ids = table.points[grids]
    as_it_is = not len(scalars) and np.array_equal(grids, np.arange(len(grids)))
    shapes = table.values if as_it_is else _ordered(table, grids, scalars)
    shapes.flags.writeable = True  # the table is not used any more
    if points is not None and not table.basic:
        for mode in range(len(table.numbers)):  # one by one: peak memory
            _turn_to_basic(ids, shapes[: 6 * len(grids), mode].reshape(-1, 6), points)
    shapes.flags.writeable = False
    return Modes(
        frequencies_hz=table.frequencies_hz,
        shapes=shapes,
        dofs=point_dofs(ids, table.points[scalars]),
        damping=table.damping,
        generalized_mass=table.generalized_mass,
        source=path.name,
    )


def _require_same_points(table: ModeTable, points: Points, path: Path) -> None:
    unknown = ~np.isin(table.points, np.concatenate([points.ids, points.scalar_ids]))
    if unknown.any():
        raise Place(path).fault(
            f"holds point {table.points[unknown][0]}, which the deck does not have: "
            "it is not a run of this deck"
        )


def _ordered(table: ModeTable, grids: Ints, scalars: Ints) -> Numbers:
    """Return the values of grids in some order, then those of scalar points."""
    n = 6 * len(grids)
    shapes = np.empty((n + len(scalars), len(table.numbers)), table.values.dtype, order="F")
    for mode in range(len(table.numbers)):
        vector = table.vector(mode)
        shapes[:n, mode] = vector[grids].reshape(-1)
        shapes[n:, mode] = vector[scalars, 0]
    return shapes


def _turn_to_basic(ids: Ints, vector: Numbers, points: Points) -> None:
    """Turn a vector (n_grid, 6) from the displacement systems to the basic axes, in place."""
    rows = np.searchsorted(points.ids, ids)
    turned = np.flatnonzero(points.rotated[rows])
    R = points.directions[rows[turned]]  # rows are the displacement directions
    for three in (slice(0, 3), slice(3, 6)):
        vector[turned, three] = np.einsum("gki,gk->gi", R, vector[turned, three])
