"""Sums and parts of many sparse matrices, whether or not they share a pattern."""

import numpy as np
import scipy.sparse as sp

from trueup.core.numerics.shared_pattern_sum import same_pattern, select, shared, weighted_sum


def _matrices():
    rng = np.random.default_rng(1)
    pattern = sp.random(30, 30, 0.2, random_state=rng, format="csr")
    alike = shared([rng.normal(size=pattern.nnz) for _ in range(3)], pattern)
    other = sp.random(30, 30, 0.1, random_state=rng, format="csr")
    return [*alike, other, sp.csr_matrix((30, 30)), alike[0]]


def test_shared_matrices_share_their_indices():
    matrices = _matrices()
    assert same_pattern(matrices[0], matrices[2])
    assert not same_pattern(matrices[0], matrices[3])


def test_a_sum_is_the_sum_and_leaves_its_terms_alone():
    matrices = _matrices()
    before = [m.toarray() for m in matrices]
    weights = [0.5, -2.0, 0.0, 3.0, 1.0, 1.0]
    total = weighted_sum(zip(weights, matrices, strict=True), 30)
    np.testing.assert_allclose(
        total.toarray(), sum(w * m for w, m in zip(weights, before, strict=True)), atol=1e-14
    )
    for matrix, values in zip(matrices, before, strict=True):
        np.testing.assert_array_equal(matrix.toarray(), values)


def test_the_sum_of_nothing_is_zero():
    assert weighted_sum([(0.0, _matrices()[0])], 30).nnz == 0


def test_parts_are_parts_and_still_share():
    matrices = _matrices()
    kept = np.array([3, 4, 9, 17, 28])
    parts = select(matrices, kept)
    for part, matrix in zip(parts, matrices, strict=True):
        np.testing.assert_array_equal(part.toarray(), matrix.toarray()[np.ix_(kept, kept)])
    assert same_pattern(parts[0], parts[1])
