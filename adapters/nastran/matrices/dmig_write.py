"""Write DMIG cards as Nastran punches them: large field, one column a card."""

from collections.abc import Iterable, Iterator

import numpy as np
import scipy.sparse as sp

from ....core.errors import InputError
from ..text.real_numbers import format_real
from .exported_matrix import SYMMETRIC, DofMap, NastranMatrix

_SQUARE, _RECTANGULAR = 1, 9
_FIELD = 16


def dmig_text(matrices: Iterable[NastranMatrix]) -> Iterator[bytes]:
    """Yield DMIG cards; numbers have as many digits as 16 columns take (11 to 14).

    Of a symmetric matrix the upper triangle is written.

    Raises
    ------
    InputError
        A matrix without dof map: DMIG names points and components; a name of Nastran's that is
        too long.
    """
    for m in matrices:
        yield from _one(m)


def _one(m: NastranMatrix) -> Iterator[bytes]:
    if m.rows is None:
        raise InputError(
            f"matrix {m.name} has no dof map and DMIG needs one: name the deck as a source too"
        )
    if len(m.name) > 8:
        raise InputError(f"{m.name!r} is longer than the 8 characters of a matrix name in Nastran")
    complex_ = np.iscomplexobj(m.matrix.data)
    form = SYMMETRIC if m.form == SYMMETRIC else _RECTANGULAR
    square = m.matrix.shape[0] == m.matrix.shape[1]
    if form != SYMMETRIC and square and m.columns is not None:
        form = _SQUARE if np.array_equal(m.rows.keys, m.columns.keys) else _RECTANGULAR
    number = np.arange(1, m.matrix.shape[1] + 1)
    columns = m.columns or DofMap(number, np.zeros_like(number))
    matrix = sp.csc_matrix(sp.triu(m.matrix) if form == SYMMETRIC else m.matrix)
    matrix.sort_indices()
    kind = 4 if complex_ else 2
    yield f"DMIG    {m.name:8}{0:8d}{form:8d}{kind:8d}{0:8d}{'':16}{len(columns):8d}\n".encode()
    point, component = m.rows.point.tolist(), m.rows.component.tolist()
    for j in range(matrix.shape[1]):
        at = slice(matrix.indptr[j], matrix.indptr[j + 1])
        rows, values = matrix.indices[at].tolist(), matrix.data[at].tolist()
        if not rows:
            continue
        lines = [f"DMIG*   {m.name:16}{columns.point[j]:16d}{columns.component[j]:16d}"]
        for i, value in zip(rows, values, strict=True):
            lines.append(f"*       {point[i]:16d}{component[i]:16d}{_printed(value)}")
        yield ("\n".join(lines) + "\n").encode()


def _printed(value: complex) -> str:
    if isinstance(value, complex):
        return f"{format_real(value.real):>{_FIELD}}{format_real(value.imag):>{_FIELD}}"
    return f"{format_real(value):>{_FIELD}}"
