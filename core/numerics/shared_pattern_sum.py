"""Many sparse matrices on few patterns: sums and parts that keep what they share.

Matrices of the same elements at different parameter values have their entries at the same
places; such matrices share their index arrays, so that a sum is one of data and a part is found
once for all of them.
"""

from collections.abc import Iterable, Sequence

import numpy as np
import scipy.sparse as sp

from ..arrays import Floats, Ints


def shared(data: Sequence[Floats], pattern: sp.csr_matrix) -> list[sp.csr_matrix]:
    """Return matrices with given entries on the pattern of another, whose indices they share."""
    parts = (pattern.indices, pattern.indptr)
    return [sp.csr_matrix((values, *parts), shape=pattern.shape, copy=False) for values in data]


def same_pattern(a: sp.csr_matrix, b: sp.csr_matrix) -> bool:
    """Whether two matrices share their index arrays."""
    return all(
        getattr(a, name).ctypes.data == getattr(b, name).ctypes.data
        and len(getattr(a, name)) == len(getattr(b, name))
        for name in ("indices", "indptr")
    )


def weighted_sum(terms: Iterable[tuple[float, sp.csr_matrix]], n: int) -> sp.csr_matrix:
    """Return the sum of c A over pairs (c, A) of matrices (n, n).

    Neighbours on one pattern are summed entry by entry, the rest in pairs, so that many matrices
    with few entries each cost no more than one with many. A lone matrix as it is comes back as
    a view that cannot be written to.
    """
    pairs = [(c, matrix) for c, matrix in terms if c != 0.0]
    if len(pairs) == 1 and pairs[0][0] == 1.0:
        lone = pairs[0][1].tocsr()
        view = lone.data.view()
        view.flags.writeable = False
        return shared([view], lone)[0]
    parts: list[sp.csr_matrix] = []
    pattern = None
    scaled = np.zeros(0)
    for c, matrix in pairs:
        if pattern is not None and same_pattern(pattern, matrix):
            scaled = scaled if len(scaled) == matrix.nnz else np.empty(matrix.nnz)
            parts[-1].data += np.multiply(matrix.data, c, out=scaled)
        else:
            parts += shared([c * matrix.data], matrix)
            pattern = matrix
    while len(parts) > 1:
        paired = [a + b for a, b in zip(parts[::2], parts[1::2], strict=False)]
        parts = paired + parts[2 * len(paired) :]
    return parts[0].tocsr() if parts else sp.csr_matrix((n, n))


def select(matrices: Sequence[sp.csr_matrix], kept: Ints) -> list[sp.csr_matrix]:
    """Return the rows and columns `kept` of each matrix; those that share a pattern still do."""
    out: list[sp.csr_matrix] = []
    before: sp.csr_matrix | None = None
    places: sp.csr_matrix | None = None
    for matrix in matrices:
        if before is None or places is None or not same_pattern(before, matrix):
            number = np.arange(1.0, matrix.nnz + 1.0)  # exact in a float up to 2**53
            places = shared([number], matrix)[0][kept][:, kept].tocsr()
            position = places.data.astype(np.int64) - 1
            before = matrix
        out += shared([matrix.data[position]], places)
    return out
