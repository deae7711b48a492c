"""A fill-reducing order found on nodes."""

import numpy as np
import pytest
import scipy.sparse as sp
import scipy.sparse.linalg as spla

from trueup.core.numerics.fill_reducing_ordering import nodal_order
from trueup.core.numerics.nested_dissection import dissected


def _grid(nx, ny, per_node, rng=None, nz=1):
    """Matrix of a grid of nodes, dense blocks between neighbours; nodes shuffled with `rng`."""
    line = [sp.diags([1.0, 1.0, 1.0], [-1, 0, 1], shape=(n, n)) for n in (nx, ny, nz)]
    graph = sp.kron(line[2], sp.kron(line[1], line[0])).tocsr()
    if rng is not None:
        shuffled = rng.permutation(nx * ny * nz)
        graph = graph[shuffled][:, shuffled]
    full = sp.kron(graph, np.ones((per_node, per_node))).tocsr()
    return (full + sp.diags(np.full(full.shape[0], 100.0 * per_node))).tocsr()


def _fill(a, order=None):
    options = {"diag_pivot_thresh": 0.0, "options": {"SymmetricMode": True}}
    if order is None:
        return spla.splu(a.tocsc(), permc_spec="MMD_AT_PLUS_A", **options).L.nnz
    return spla.splu(a[order][:, order].tocsc(), permc_spec="NATURAL", **options).L.nnz


@pytest.mark.parametrize("shuffle", [False, True])
@pytest.mark.parametrize("given", [False, True])
def test_it_fills_less_than_the_rows_one_by_one(shuffle, given):
    a = _grid(20, 15, 4, np.random.default_rng(1) if shuffle else None)
    groups = np.arange(a.shape[0]) // 4 if given else None
    order = nodal_order(a, groups)
    assert np.array_equal(np.sort(order), np.arange(a.shape[0]))
    assert _fill(a, order) < 1.02 * _fill(a)
    assert _fill(a, order) < 0.7 * _fill(a, np.arange(a.shape[0]))


def test_what_is_bulky_is_dissected():
    """A cube of 4,096 nodes: minimum degree fills half as much again."""
    a = _grid(16, 16, 1, np.random.default_rng(3), nz=16)
    order = nodal_order(a)
    assert np.array_equal(np.sort(order), np.arange(a.shape[0]))
    assert _fill(a, order) < 0.7 * _fill(a)


def test_pieces_are_ordered_one_after_the_other():
    one = _grid(12, 12, 1, nz=12)
    order = nodal_order(sp.block_diag([one, one], format="csr"), np.arange(2 * one.shape[0]))
    assert np.array_equal(np.sort(order), np.arange(2 * one.shape[0]))
    assert np.count_nonzero(np.diff(order < one.shape[0])) == 1


def test_rows_of_a_node_stay_together():
    a = _grid(9, 7, 3, np.random.default_rng(2))
    node = nodal_order(a) // 3
    assert np.count_nonzero(np.diff(node)) == 9 * 7 - 1


def test_matrices_without_any_structure():
    for a in (sp.identity(1), sp.identity(5), sp.csr_matrix(np.ones((4, 4)))):
        order = nodal_order(sp.csr_matrix(a))
        assert sorted(order) == list(range(a.shape[0]))


def test_many_small_pieces_are_ordered_at_once():
    """Held rows of a model are pieces of their own: thousands of orders of one row take seconds."""
    asked = []

    def undivided(graph, weight):
        asked.append(graph.shape[0])
        return np.arange(graph.shape[0])

    graph = sp.block_diag([_grid(20, 20, 1), sp.eye(3000)], format="csr")
    order = dissected(graph, np.ones(3400, np.int64), undivided)
    assert np.array_equal(np.sort(order), np.arange(3400))
    assert sorted(asked) == [400, 3000]
