"""Modes of an OP4 file: shapes, their eigenvalues, and a list of degrees of freedom beside it."""

from pathlib import Path

import numpy as np

from ....core.arrays import Floats, Ints, Numbers
from ....core.data.dofs import Dofs
from ....core.data.modes import Modes
from ....core.errors import Place
from ....core.files import reading
from ..deck.read_deck import Deck
from ..op4.op4 import read_op4
from ..properties.grids import Points, point_dofs, read_points

_LIST = ".dofs"
"""Suffix of the list: one line a row of the shapes, POINT COMPONENT."""
_WAYS = {name: k + 1 for k, name in enumerate(("X", "Y", "Z", "RX", "RY", "RZ"))}
_WAYS |= {name: k + 1 for k, name in enumerate(("T1", "T2", "T3", "R1", "R2", "R3"))}


def dof_list(path: Path) -> Path | None:
    """Return the list of degrees of freedom beside an OP4 file; None where there is none."""
    beside = path.with_suffix(_LIST)
    return beside if beside.is_file() else None


def read_op4_modes(path: Path, deck: Deck | None = None) -> Modes:
    """Read modes from an OP4 file.

    Parameters
    ----------
    path : Path
        Holds shapes (n_dof, n_mode) and a vector of as many eigenvalues [rad²/s²], or frequencies
        where its name says FREQ or HZ [Hz]. Beside it, with the suffix ``.dofs``, a list says what
        the rows are, a line each: ``1187 3``, ``1187 T3`` or ``1187:Z``, 0 of a scalar point.
        Without a list they are the g-set of the deck.
    deck : Deck, optional
        Gives the displacement systems (CD) that components belong to; without it they are basic.

    Raises
    ------
    InputError
        No shapes with as many frequencies, rows that are not those of the list or the deck.
    """
    here = Place(path)
    with reading(path):
        held = read_op4(path)
    vectors = [m for m in held if 1 in m.matrix.shape]
    blocks = sorted((m for m in held if m not in vectors), key=lambda m: -m.matrix.shape[0])
    fitting = [
        (block, vector)
        for block in blocks
        for vector in vectors
        if max(vector.matrix.shape) == block.matrix.shape[1]
    ]
    if not fitting:
        raise here.fault("holds no shapes beside a vector of as many eigenvalues or frequencies")
    block, values = fitting[0]
    points = None if deck is None else read_points(deck.bulk)
    shapes = np.asarray(block.matrix.toarray())
    point, component = _rows(path, points, len(shapes))
    number = np.real(values.matrix.toarray().ravel())
    named = any(word in values.name for word in ("FREQ", "HZ"))
    hz = number if named else np.sqrt(np.abs(number)) / (2.0 * np.pi)
    axis = _axes(point, component, points, here)
    return Modes(hz, shapes, Dofs(point, np.maximum(component, 1), axis), source=path.name)


def full_op4_modes(path: Path, deck: Deck) -> Modes:
    """Return modes on all degrees of freedom of a deck, basic axes.

    Raises
    ------
    InputError
        As `read_op4_modes`; degrees of freedom of the deck that the file does not have.
    """
    found, points = read_op4_modes(path, deck), read_points(deck.bulk)
    known = dict.fromkeys(zip(found.dofs.node.tolist(), found.dofs.component.tolist(), strict=True))
    wanted = [(int(g), c) for g in points.ids for c in range(1, 7)]
    lost = [w for w in (*wanted, *((int(s), 1) for s in points.scalar_ids)) if w not in known]
    if lost:
        raise Place(path).fault(
            f"lacks {len(lost)} of the deck's degrees of freedom, the first {lost[0][0]}:"
            f"{lost[0][1]}: modes on a part of them are a test, not the analysis"
        )
    row = {key: k for k, key in enumerate(known)}
    order = np.array([row[w] for w in wanted])
    full: Numbers = found.shapes[order].reshape(len(points.ids), 6, -1).copy()
    R = points.directions[points.rotated]
    for three in (slice(0, 3), slice(3, 6)):
        full[points.rotated, three] = np.einsum("gki,gkm->gim", R, full[points.rotated, three])
    scalar = found.shapes[[row[int(s), 1] for s in points.scalar_ids]]
    shapes = np.vstack([full.reshape(len(order), -1), scalar])
    dofs = point_dofs(points.ids, points.scalar_ids)
    return Modes(found.frequencies_hz, shapes, dofs, source=found.source)


def _rows(path: Path, points: Points | None, count: int) -> tuple[Ints, Ints]:
    listed = dof_list(path)
    if listed is not None:
        return _listed(listed, path, count)
    if points is None or count != 6 * len(points.ids) + len(points.scalar_ids):
        raise Place(path).fault(
            f"holds shapes of {count} rows and nothing says what they are; give a list beside it, "
            f"{path.with_suffix(_LIST).name}, a line POINT COMPONENT each"
        )
    keys = np.sort(np.concatenate([
        (8 * points.ids[:, None] + np.arange(1, 7)).ravel(), 8 * points.scalar_ids,
    ]))  # fmt: skip
    return keys // 8, keys % 8


def _listed(listed: Path, path: Path, count: int) -> tuple[Ints, Ints]:
    rows = []
    with reading(listed):
        text = listed.read_text(encoding="latin-1")
    for number, line in enumerate(text.splitlines(), 1):
        words = line.split("#")[0].replace(",", " ").replace(":", " ").split()
        if not words:
            continue
        try:
            point, way = words
            way = way.upper().lstrip("+")
            rows.append((int(point), _WAYS[way] if way in _WAYS else int(way)))
            if not 0 <= rows[-1][1] <= 6:
                raise ValueError
        except ValueError:
            raise Place(listed, number).error(
                "a point and its component are expected, as 1187 3 or 1187:Z"
            ) from None
    if len(rows) != count:
        raise Place(listed).fault(f"lists {len(rows)} rows; the shapes in {path.name} have {count}")
    point, component = np.array(rows, np.int64).T
    return point, component


def _axes(point: Ints, component: Ints, points: Points | None, here: Place) -> Floats:
    axis = np.array(np.vstack([np.zeros(3), np.eye(3), np.eye(3)])[component])
    if points is None:
        return axis
    row = np.searchsorted(points.ids, point).clip(max=max(len(points.ids) - 1, 0))
    there = (points.ids[row] == point) & (component > 0)
    if not (there | (component == 0)).all():
        raise here.fault(f"names grid {point[~there & (component > 0)][0]}, which the deck lacks")
    axis[there] = points.directions[row[there], (component[there] - 1) % 3]
    return axis
