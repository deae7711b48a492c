"""Eigenvectors from OP2 files of MSC, NX, OptiStruct and MYSTRAN, 32 and 64 bit."""

import re
from collections import Counter
from collections.abc import Collection, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from ....core.arrays import Floats, Ints, Numbers
from ....core.errors import InputError, Place
from .eigenvector_table import ModeHead, ModeTable, generalized_mass, room, rows_of
from .op2_records import Op2Block, Op2File, Op2Record

_GRID, _SCALAR = 1, 2
_REAL, _COMPLEX = 2, 9  # analysis codes of normal and of complex modes
_DISPLACEMENTS, _EIGENVECTORS = 1, 7  # table codes
_MAGNITUDE_PHASE = 3  # format code
_VECTORS = re.compile(r"[BR]?O(UG|PHIG)(?!.*F$)")
"""Names of blocks with displacements of all points; those that end in F are of the fluid."""
_GRID_CARD = (4501, 45, 1)
"""Key of the GRID cards in GEOM1."""
_SUPERELEMENT = re.compile(r"SUPERELEMENT\s+(\d+)")
_TITLES = (50, 96)  # first word and number of words of title, subtitle and label
_LAMA_WIDTH = 7
_WIDTHS = {False: 8, True: 14}


@dataclass(frozen=True)
class _Vector:
    """One eigenvector: where its values stand, and what its header says."""

    name: str
    subcase: int
    superelement: int
    number: int
    eigenvalue: complex
    is_complex: bool
    polar: bool
    data: Op2Record

    @property
    def basic(self) -> bool:
        return self.name.startswith("B")

    @property
    def rank(self) -> int:
        """Which of several sets of eigenvectors is taken: the lowest."""
        return {"B": 0, "O": 1, "R": 2}[self.name[0]]


def read_op2_tables(
    path: Path, modes: Collection[int] | None = None
) -> tuple[list[ModeTable], tuple[str, ...]]:
    """Read the eigenvectors of an OP2 file, all or those of some mode numbers.

    Frequencies come from the eigenvalues (in the header of each eigenvector, where the LAMA table
    may be missing), never from what the file calls cycles: that is rad/s in some.

    Returns
    -------
    tables : list of ModeTable
    names : tuple of str
        All data blocks of the file, for inspection.

    Raises
    ------
    InputError
        The file cannot be read as OP2.
    """
    with Op2File(path) as file:
        groups = [[v for v in g if modes is None or v.number in modes] for g in _groups(file)]
        tables = [_table(file, group, _head(file, group)) for group in groups if group]
        return tables, _names(file)


def read_op2_heads(path: Path) -> tuple[list[ModeHead], tuple[str, ...]]:
    """Read what `read_op2_tables` gives but the values: costs what it reads."""
    with Op2File(path) as file:
        return [_head(file, group) for group in _groups(file)], _names(file)


def grids_with_own_systems(path: Path) -> Ints:
    """Return the grids whose displacement system (CD) is not basic, where the file says so."""
    with Op2File(path) as file:
        for block in file.blocks:
            for record in block.records if block.name.startswith("GEOM1") else ():
                words = file.integers(record)
                if tuple(words[:3].tolist()) == _GRID_CARD:
                    return _own_systems(words[3:])
    return np.zeros(0, np.int64)


def _own_systems(words: Ints) -> Ints:
    """Grids out of rows ID, CP, X, Y, Z, CD, PS, SEID; positions take one word each or two."""
    for width, cd in ((8, 5), (11, 8)):
        if len(words) % width:
            continue
        table = words.reshape(-1, width)
        ids, systems = table[:, 0], table[:, cd]
        if (ids > 0).all() and (np.diff(ids) > 0).all() and (systems >= -1).all():
            return np.asarray(ids[systems > 0])
    return np.zeros(0, np.int64)


def _names(file: Op2File) -> tuple[str, ...]:
    return tuple(dict.fromkeys(block.name for block in file.blocks))


def unread_op2_blocks(path: Path) -> dict[str, str]:
    """Return the blocks of displacements that hold modes trueup does not read, and why."""
    found: dict[str, str] = {}
    with Op2File(path) as file:
        for block in file.blocks:
            if block.name.lstrip("BR").startswith(("OUG", "OPHIG")) and block.records:
                head = file.integers(block.records[0])
                if not _VECTORS.match(block.name):
                    found[block.name] = "modes of the fluid"
                elif len(head) > 1 and int(head[1]) // 1000 & 2:
                    found[block.name] = "sorted by points; ask Nastran for SORT1"
                elif len(head) > 1 and int(head[0]) // 10 not in (_REAL, _COMPLEX):
                    found[block.name] = "displacements that are no modes"
    return found


def _groups(file: Op2File) -> list[list[_Vector]]:
    """Return the eigenvectors by subcase and superelement, from the blocks that suit best.

    A mode number that comes again starts a group of its own: the next speed of a rotor, the next
    design cycle.
    """
    vectors = [v for b in file.blocks if _VECTORS.match(b.name) for v in _vectors(file, b)]
    best = min((v.rank for v in vectors), default=0)
    times: Counter[tuple[int, int, bool, int]] = Counter()
    groups: dict[tuple[int, int, bool, int], list[_Vector]] = {}
    for v in vectors:
        if v.rank == best:
            key = (v.subcase, v.superelement, v.is_complex)
            again = times[*key, v.number]
            times[*key, v.number] += 1
            groups.setdefault((*key, again), []).append(v)
    return [groups[k] for k in sorted(groups)]


def _vectors(file: Op2File, block: Op2Block) -> list[_Vector]:
    """Return the eigenvectors of a block: pairs of a header record and a record of values."""
    found = []
    for head, data in zip(block.records[::2], block.records[1::2], strict=False):
        words, reals = file.integers(head), file.reals(head)
        if len(words) < _TITLES[0]:
            raise file.damaged(head.parts[0][0], f"a header of {block.name} is too short")
        analysis, (sort, table) = int(words[0]) // 10, divmod(int(words[1]), 1000)
        modal = analysis in (_REAL, _COMPLEX) and table in (_DISPLACEMENTS, _EIGENVECTORS)
        if not modal or sort & 2:  # sorted by points, not by modes: not asked for by any deck
            continue
        is_complex = int(words[9]) == _WIDTHS[True]
        if int(words[9]) not in _WIDTHS.values():
            raise file.damaged(head.parts[0][0], f"{block.name} has {words[9]} words a point")
        root = analysis == _COMPLEX
        said = _SUPERELEMENT.search(file.text(head, *_TITLES))
        found.append(
            _Vector(
                block.name,
                int(words[3]),
                int(said[1]) if said else 0,
                int(words[4]),
                complex(float(reals[5]), float(reals[6])) if root else complex(float(reals[5])),
                root,
                is_complex and int(words[8]) == _MAGNITUDE_PHASE,
                data,
            )
        )
    return found


def _head(file: Op2File, group: Sequence[_Vector]) -> ModeHead:
    first = group[0]
    integers = file.integers(first.data).reshape(-1, _width(file, first))
    kinds = integers[:, 1]
    rows = np.flatnonzero((kinds == _GRID) | (kinds == _SCALAR))
    numbers = np.array([v.number for v in group], np.int64)
    roots = np.array([v.eigenvalue for v in group])
    eigenvalues: Numbers = roots if first.is_complex else roots.real.copy()
    summaries = _summaries(file)
    if not first.is_complex and not eigenvalues.any():
        eigenvalues = _listed(summaries, numbers, eigenvalues)
    return ModeHead(
        subcase=first.subcase,
        superelement=first.superelement,
        points=integers[rows, 0] // 10,
        scalar=kinds[rows] == _SCALAR,
        numbers=numbers,
        eigenvalues=eigenvalues,
        generalized_mass=generalized_mass(summaries, numbers, eigenvalues),
        basic=first.basic,
    )


def _width(file: Op2File, vector: _Vector) -> int:
    """Words a point of an eigenvector: 8 real, 14 complex."""
    words = vector.data.size // file.word
    fitting = [w for w in _WIDTHS.values() if words % w == 0]
    own = _WIDTHS[vector.is_complex]
    if own in fitting:
        return own
    if not fitting:
        raise file.damaged(vector.data.parts[0][0] if vector.data.parts else 0,
                           f"mode {vector.number} does not hold whole points")  # fmt: skip
    return fitting[0]


def _table(file: Op2File, group: Sequence[_Vector], head: ModeHead) -> ModeTable:
    """Read the values; every eigenvector must list the same points."""
    width = _width(file, group[0])
    is_complex = width == _WIDTHS[True]
    all_rows = file.integers(group[0].data).reshape(-1, width)[:, 1]
    rows: Ints | slice = np.flatnonzero((all_rows == _GRID) | (all_rows == _SCALAR))
    if len(head.points) == len(all_rows):
        rows = slice(None)
    values = room(len(head.points), len(group), is_complex)
    for k, v in enumerate(group):
        if v.data.size != group[0].data.size:
            raise _other_points(file)
        table = file.reals(v.data).reshape(-1, width)
        points = table.view(table.dtype.str.replace("f", "i"))[rows, 0] // 10
        if not np.array_equal(points, head.points):
            raise _other_points(file)
        column = values[:, k].reshape(-1, 6)
        if not is_complex:
            column[:] = table[rows, 2:8]
        elif v.polar:
            column[:] = table[rows, 2:8] * np.exp(1j * np.deg2rad(table[rows, 8:14]))
        else:
            column[:] = table[rows, 2:8] + 1j * table[rows, 8:14]
        file.release(v.data)
    return ModeTable(**vars(head), values=values)


def _other_points(file: Op2File) -> InputError:
    return Place(file.path).error(
        "the eigenvectors of one subcase list different points: the file is damaged"
    )


def _summaries(file: Op2File) -> list[Floats]:
    """Return the LAMA tables: mode number, eigenvalue and generalized mass, (n_mode, 3) each."""
    found = []
    for block in file.blocks:
        if not block.name.startswith(("LAMA", "BLAMA")):
            continue
        for data in block.records[1::2]:
            if data.size % (_LAMA_WIDTH * file.word):
                continue
            numbers = file.integers(data).reshape(-1, _LAMA_WIDTH)[:, 0]
            reals = file.reals(data).reshape(-1, _LAMA_WIDTH)
            found.append(np.column_stack([numbers, reals[:, 2], reals[:, 5]]))
    return found


def _listed(summaries: list[Floats], numbers: Ints, eigenvalues: Numbers) -> Numbers:
    """Eigenvalues of the one summary that has these modes, for headers that leave them out."""
    found = [rows for s in summaries if (rows := rows_of(s, numbers)) is not None]
    return found[0][:, 1] if len(found) == 1 else eigenvalues
