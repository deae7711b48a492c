"""Products of large matrices: numpy's, whatever the layout and whoever makes them."""

import numpy as np
import pytest
import scipy.sparse as sp

from trueup.core.arrays import Floats
from trueup.core.numerics.products import product, sparse_product

_N, _K, _M = 3000, 40, 30  # more than small


def _drawn(*shape: int) -> Floats:
    return np.random.default_rng(0).standard_normal(shape)


def _layouts(a: Floats) -> dict[str, Floats]:
    n, k = a.shape
    wide, every_second = np.zeros((n, 2 * k)), np.zeros((2 * n, 2 * k))
    wide[:, 1 : 1 + k], every_second[::2, ::2] = a, a
    return {
        "rows": np.ascontiguousarray(a),
        "columns": np.asfortranarray(a),
        "columns of a wider one": wide[:, 1 : 1 + k],
        "rows of a longer one": np.asfortranarray(np.vstack([a, a]))[:n],
        "neither": every_second[::2, ::2],
        "upside down": a[::-1].copy()[::-1],
    }


@pytest.mark.parametrize("left", _layouts(_drawn(2, 2)))
@pytest.mark.parametrize("right", _layouts(_drawn(2, 2)))
def test_a_product_is_that_of_numpy_in_any_layout(left: str, right: str) -> None:
    a, b = _drawn(_N, _K), _drawn(_K, _M)
    found = product(_layouts(a)[left], _layouts(b)[right])
    np.testing.assert_allclose(found, a @ b, rtol=0, atol=1e-11)


@pytest.mark.parametrize("layout", _layouts(_drawn(2, 2)))
def test_a_product_goes_where_it_is_wanted(layout: str) -> None:
    a, b, out = _drawn(_N, _K), _drawn(_K, _M), _layouts(np.zeros((_N, _M)))[layout]
    assert product(a, b, out) is out
    np.testing.assert_allclose(out, a @ b, rtol=0, atol=1e-11)


@pytest.mark.parametrize("layout", _layouts(_drawn(2, 2)))
def test_a_product_is_added_to_what_is_there(layout: str) -> None:
    a, b, out = _drawn(_N, _K), _drawn(_K, _M), _layouts(np.ones((_N, _M)))[layout]
    assert product(a, b, out, add=True) is out
    np.testing.assert_allclose(out, 1.0 + a @ b, rtol=0, atol=1e-11)


@pytest.mark.parametrize("order", ["C", "F"])
def test_a_part_of_a_matrix_takes_a_product_and_leaves_the_rest(order: str) -> None:
    a, b, whole = _drawn(_N, _K), _drawn(_K, _M), np.zeros((_N, 2 * _M), order=order)
    product(a, b, whole[:, :_M])
    np.testing.assert_allclose(whole[:, :_M], a @ b, rtol=0, atol=1e-11)
    assert not whole[:, _M:].any()


@pytest.mark.parametrize("index", [np.int32, np.int64])
@pytest.mark.parametrize("order", ["C", "F"])
def test_a_sparse_product_is_that_of_scipy(order: str, index: type) -> None:
    a = sp.random(_N, _N, 0.02, "csr", random_state=1)
    a.indices, a.indptr = a.indices.astype(index), a.indptr.astype(index)
    x = np.asarray(_drawn(_N, 30), order=order)
    np.testing.assert_allclose(sparse_product(a, x), a @ x, rtol=0, atol=1e-12)


def test_a_product_with_nothing_is_nothing() -> None:
    assert product(_drawn(_N, _K), np.zeros((_K, 0))).shape == (_N, 0)
    assert not product(np.zeros((_N, 0)), np.zeros((0, _M))).any()
    assert not sparse_product(sp.csr_matrix((_N, _N)), _drawn(_N, _K)).any()
