"""Matrices in Nastran's HDF5: written here as MSC lays them out, one after another."""

import h5py
import numpy as np
import pytest
import scipy.sparse as sp

from trueup.adapters.nastran import describe_results, model_of_matrices, read_matrices
from trueup.core.errors import InputError

IDENTITY = [
    ("NAME", "S8"), ("ROW", "<i8"), ("COLUMN", "<i8"), ("COLUMN_POS", "<i8"), ("DATA_POS", "<i8"),
    ("NON_ZERO", "<i8"), ("DOMAIN_ID", "<i8"),
]  # fmt: skip


def write(path, matrices, grids=(), shift=0, kind="<f8"):
    """All values and columns of a file stand in one table each."""
    identities, positions, rows, values = [], [], [], []
    for name, dense in matrices.items():
        matrix = sp.csc_matrix(dense)
        identities.append((name.encode(), *matrix.shape, len(positions), len(rows), matrix.nnz, 1))
        positions += (matrix.indptr + len(rows)).tolist()
        rows += (matrix.indices + shift).tolist()
        values += matrix.data.tolist()
    data = np.zeros(len(rows), [("ROW", "<i8"), ("VALUE", kind)])
    data["ROW"], data["VALUE"] = rows, values
    with h5py.File(path, "w") as file:
        group = file.create_group("NASTRAN/RESULT/MATRIX/GENERAL")
        group["IDENTITY"] = np.array(identities, IDENTITY)
        group["COLUMN"] = np.array([(p,) for p in positions], [("POSITION", "<i8")])
        group["DATA"] = data
        if len(grids):
            table = np.zeros(len(grids), [("ID", "<i8"), ("CD", "<i8")])
            table["ID"] = grids
            file["NASTRAN/INPUT/NODE/GRID"] = table


@pytest.fixture
def pair():
    rng = np.random.default_rng(1)
    a = rng.normal(size=(12, 12)) * (rng.random((12, 12)) < 0.4)
    return {"KGG": a + a.T + 20 * np.eye(12), "MGG": np.diag(rng.random(12) + 1.0)}


def test_matrices_with_the_dof_map_of_the_grids(tmp_path, pair):
    path = tmp_path / "a.mtx.h5"
    write(path, pair, grids=[20, 3])
    K, M = read_matrices(path)
    assert (K.name, M.name) == ("KGG", "MGG")
    assert np.array_equal(K.matrix.toarray(), pair["KGG"])
    assert np.array_equal(M.matrix.toarray(), pair["MGG"])
    assert K.rows.point.tolist() == [3] * 6 + [20] * 6
    assert model_of_matrices([K], [M]).n_free == 12


def test_rows_counted_from_one_are_seen_by_the_last_row(tmp_path, pair):
    path = tmp_path / "a.h5"
    write(path, pair, shift=1)
    assert np.array_equal(read_matrices(path)[0].matrix.toarray(), pair["KGG"])


def test_rectangular_and_complex(tmp_path):
    dense = np.array([[1.0 + 2.0j, 0.0, 3.0], [0.0, 0.0, -1.0j]])
    path = tmp_path / "a.h5"
    write(path, {"GM": dense}, kind="<c16")
    (matrix,) = read_matrices(path)
    assert np.array_equal(matrix.matrix.toarray(), dense)
    assert matrix.rows is None


def test_inspect_lists_them_without_their_values(tmp_path, pair):
    path = tmp_path / "a.h5"
    write(path, pair)
    told = describe_results(path)
    assert told["contents"]["matrices"] == {"KGG": "12 x 12", "MGG": "12 x 12"}
    assert told["skipped"] == []


@pytest.mark.parametrize("field", ["COLUMN_POS", "DATA_POS", "NON_ZERO", "ROW", "COLUMN"])
def test_tables_that_do_not_agree(tmp_path, pair, field):
    path = tmp_path / "a.h5"
    write(path, {"KGG": pair["KGG"]})
    with h5py.File(path, "r+") as file:
        table = file["NASTRAN/RESULT/MATRIX/GENERAL/IDENTITY"]
        values = table[()]
        values[field] = values[field] + 3 if field != "ROW" else 5
        table[...] = values
    with pytest.raises(InputError, match="KGG"):
        read_matrices(path)


def test_a_file_of_modes_alone_says_so(tmp_path):
    path = tmp_path / "a.h5"
    with h5py.File(path, "w") as file:
        file.create_group("NASTRAN/RESULT")
    with pytest.raises(InputError, match="no matrices"):
        read_matrices(path)
