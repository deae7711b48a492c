"""OP4 of every kind, against files of NX and MSC and against files packed number by number."""

from __future__ import annotations

import contextlib
import struct
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pytest
import scipy.sparse as sp
from hypothesis import given, strategies as st

from trueup.adapters.nastran import (
    DofMap,
    NastranMatrix,
    describe_matrices,
    read_matrices,
    read_op4,
    write_op4,
)
from trueup.core.errors import InputError

REAL_FILES = {
    "double_bigmat_ascii": 1e-9,
    "double_bigmat_le": 1e-14,
    "double_dense_ascii": 1e-9,
    "double_dense_ascii_d": 1e-9,
    "double_dense_be": 1e-14,
    "double_dense_le": 0.0,
    "double_nonbigmat_ascii": 1e-13,
    "double_nonbigmat_le": 1e-14,
    "single_bigmat_le": 1e-6,
    "single_dense_ascii": 1e-6,
}


@dataclass(frozen=True)
class Variant:
    """One kind of binary OP4: storage is ``dense``, ``bigmat`` or ``nonbigmat``."""

    storage: str
    order: str
    word: int
    double: bool
    mark: int = 4


def runs(column: np.ndarray) -> Iterator[tuple[int, np.ndarray]]:
    """Yield first row (from 1) and values of each run of entries that are not zero."""
    rows = np.flatnonzero(column)
    for part in np.split(rows, np.flatnonzero(np.diff(rows) != 1) + 1):
        if len(part):
            yield int(part[0]) + 1, column[part]


def packed(name: str, A: np.ndarray, form: int, variant: Variant) -> bytes:
    o, w = variant.order, variant.word
    integer = "i" if w == 4 else "q"
    real = "f" if w == 4 and not variant.double else "d"
    is_complex = np.iscomplexobj(A)
    kind = 1 + variant.double + 2 * is_complex
    nrow = -A.shape[0] if variant.storage == "bigmat" else A.shape[0]

    def record(content: bytes) -> bytes:
        mark = struct.pack(o + ("i" if variant.mark == 4 else "q"), len(content))
        return mark + content + mark

    def numbers(values: np.ndarray) -> bytes:
        flat = np.ravel(np.column_stack([values.real, values.imag])) if is_complex else values
        return struct.pack(f"{o}{len(flat)}{real}", *map(float, flat))

    text = name.ljust(8).encode()
    if w == 8:
        text = text[:4] + b"    " + text[4:] + b"    "
    out = record(struct.pack(f"{o}4{integer}", A.shape[1], nrow, form, kind) + text)
    for j in range(A.shape[1]):
        strings = list(runs(A[:, j]))
        if not strings:
            continue
        if variant.storage == "dense":
            first = strings[0][0]
            last = strings[-1][0] + len(strings[-1][1]) - 1
            row, content = first, numbers(A[first - 1 : last, j])
        else:
            row, content = 0, b""
            for start, values in strings:
                body = numbers(values)
                length = len(body) // w + 1
                if variant.storage == "bigmat":
                    content += struct.pack(f"{o}2{integer}", length, start)
                else:
                    content += struct.pack(f"{o}{integer}", start + 65536 * length)
                content += body
        head = struct.pack(f"{o}3{integer}", j + 1, row, len(content) // w)
        out += record(head + content)
    last_value = struct.pack(f"{o}d", 1.0)
    return out + record(struct.pack(f"{o}3{integer}", A.shape[1] + 1, 1, 1) + last_value)


VARIANTS = st.builds(
    Variant,
    storage=st.sampled_from(["dense", "bigmat", "nonbigmat"]),
    order=st.sampled_from("<>"),
    word=st.sampled_from([4, 8]),
    double=st.booleans(),
    mark=st.sampled_from([4, 8]),
)


@st.composite
def arrays(draw: st.DrawFn) -> np.ndarray:
    rows, columns = draw(st.integers(1, 9)), draw(st.integers(1, 7))
    rng = np.random.default_rng(draw(st.integers(0, 2**32 - 1)))
    A = rng.integers(-999, 999, (rows, columns)) / 8.0
    if draw(st.booleans()):
        A = A + 1j * rng.integers(-999, 999, (rows, columns)) / 8.0
    A[rng.random((rows, columns)) < draw(st.sampled_from([0.0, 0.5, 0.9, 1.0]))] = 0.0
    return np.asarray(A)


@pytest.mark.parametrize(("name", "tolerance"), REAL_FILES.items())
def test_the_same_matrices_are_found_in_every_kind_of_file(
    data: Path, name: str, tolerance: float
) -> None:
    there = data / "matrices" / "op4"
    reference = {m.name: m.matrix for m in read_op4(there / "double_dense_le.op4")}
    assert list(reference) == ["RMAT", "CMAT", "RCMAT"]
    assert np.iscomplexobj(reference["CMAT"].data)
    found = read_op4(there / f"{name}.op4")
    assert [m.name.removesuffix("S") for m in found] == list(reference)
    for m in found:
        A = reference[m.name.removesuffix("S")]
        assert abs(m.matrix - A).max() <= tolerance * abs(A).max()


def test_real_files_agree_with_pynastran_where_it_reads_them(data: Path) -> None:
    pytest.importorskip("pyNastran")
    from pyNastran.op4.op4 import OP4

    for name in ("double_dense_le", "double_dense_be", "double_dense_ascii"):
        path = data / "matrices" / "op4" / f"{name}.op4"
        reference = OP4(log=None, debug=False).read_op4(str(path))
        for m in read_op4(path):
            held = reference[m.name]
            values = getattr(held, "data", held)
            np.testing.assert_array_equal(m.matrix.toarray(), np.asarray(values))


def test_a_matrix_of_ten_million_rows_and_columns_stays_sparse(data: Path) -> None:
    found = read_op4(data / "matrices" / "op4" / "nas_large_dim_bigmat_binary.op4")
    assert [m.name for m in found] == ["MATD", "MATDT", "MATD22A", "MATD21"]
    first, transposed, square, _ = (m.matrix for m in found)
    assert square.shape == (10_000_001, 10_000_001)
    assert square.nnz == 49
    assert (transposed != first.T).nnz == 0


@given(A=arrays(), variant=VARIANTS)
def test_every_kind_of_binary_file_is_read(
    tmp_path_factory: pytest.TempPathFactory, A: np.ndarray, variant: Variant
) -> None:
    path = tmp_path_factory.mktemp("op4") / "a.op4"
    path.write_bytes(packed("ABCDE", A, 2, variant) + packed("B", A, 2, variant))
    for m, name in zip(read_op4(path), ["ABCDE", "B"], strict=True):
        assert m.name == name
        np.testing.assert_array_equal(m.matrix.toarray(), A)


@given(A=arrays(), formatted=st.booleans())
def test_what_is_written_reads_back_equal(
    tmp_path_factory: pytest.TempPathFactory, A: np.ndarray, formatted: bool
) -> None:
    path = tmp_path_factory.mktemp("op4") / "a.op4"
    A = A / 3.0
    write_op4(path, [NastranMatrix("A1", sp.csc_matrix(A)), NastranMatrix("B", sp.csc_matrix(A.T))],
              formatted)  # fmt: skip
    a, b = read_op4(path)
    np.testing.assert_array_equal(a.matrix.toarray(), A)
    np.testing.assert_array_equal(b.matrix.toarray(), A.T)
    assert np.iscomplexobj(a.matrix.data) == np.iscomplexobj(A)


def test_pynastran_reads_what_is_written(tmp_path: Path) -> None:
    pytest.importorskip("pyNastran")
    from pyNastran.op4.op4 import OP4

    A = sp.random(30, 20, 0.2, random_state=1, format="csc")
    write_op4(tmp_path / "a.op4", [NastranMatrix("AMAT", A)], formatted=True)
    held = OP4(log=None, debug=False).read_op4(str(tmp_path / "a.op4"))["AMAT"]
    values = getattr(held, "data", held)
    np.testing.assert_array_equal(np.asarray(values.todense()), A.toarray())


def test_dof_maps_go_along(tmp_path: Path) -> None:
    rows = DofMap(np.array([3, 3, 2_995_001]), np.array([1, 6, 0]))
    K = NastranMatrix("K", sp.csc_matrix(np.diag([1.0, 2.0, 3.0])), 6, rows, rows)
    write_op4(tmp_path / "k.op4", [K])
    (found,) = read_matrices(tmp_path / "k.op4")
    assert found.rows is not None
    np.testing.assert_array_equal(found.rows.keys, rows.keys)


def test_a_symmetric_matrix_given_as_one_triangle_is_completed(tmp_path: Path) -> None:
    A = np.array([[4.0, 1.0, 0.0], [1.0, 5.0, 2.0], [0.0, 2.0, 6.0]])
    for half in (np.triu(A), np.tril(A), A):
        path = tmp_path / "k.op4"
        path.write_bytes(packed("K", half, 6, Variant("bigmat", "<", 4, True)))
        np.testing.assert_array_equal(read_op4(path)[0].matrix.toarray(), A)


def test_exponents_without_letter_are_read(tmp_path: Path) -> None:
    text = (
        f"{1:8d}{2:8d}{2:8d}{2:8d}{'A':8}1P,5E16.9\n{1:8d}{1:8d}{2:8d}\n"
        f"{'-1.234567890-101':>16}{'2.500000000D+00':>16}\n{2:8d}{1:8d}{1:8d}\n{'1.0E+00':>16}\n"
    )
    (tmp_path / "a.op4").write_text(text)
    found = read_op4(tmp_path / "a.op4")[0].matrix.toarray()[:, 0]
    np.testing.assert_array_equal(found, [-1.23456789e-101, 2.5])


@pytest.mark.parametrize("name", ["double_bigmat_le", "double_dense_be", "double_nonbigmat_ascii"])
def test_a_file_cut_anywhere_is_one_sentence(data: Path, tmp_path: Path, name: str) -> None:
    whole = (data / "matrices" / "op4" / f"{name}.op4").read_bytes()
    path = tmp_path / "cut.op4"
    told: list[str] = []
    for end in range(8, len(whole) - 40, 97):
        path.write_bytes(whole[:end])
        try:
            between = len(read_op4(path)) < 3  # cut exactly between two matrices
        except InputError as error:
            told.append(str(error))
            between = True
        assert between
    assert len(told) > 10
    assert all(t.startswith(str(path)) and "\n" not in t for t in told)


@given(at=st.integers(0, 4000), value=st.integers(0, 255))
def test_a_damaged_byte_never_gives_a_traceback(
    data_file: Path, at: int, value: int, tmp_path_factory: pytest.TempPathFactory
) -> None:
    damaged = bytearray(data_file.read_bytes())
    damaged[at % len(damaged)] = value
    path = tmp_path_factory.mktemp("op4") / "bad.op4"
    path.write_bytes(bytes(damaged))
    with contextlib.suppress(InputError):
        read_op4(path)


@pytest.fixture(scope="module", params=[("bigmat", 4), ("nonbigmat", 8), ("dense", 4)])
def data_file(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory) -> Path:
    A = sp.random(12, 9, 0.4, random_state=3).toarray()
    storage, word = request.param
    path = tmp_path_factory.mktemp("op4") / "good.op4"
    path.write_bytes(packed("GOOD", A, 2, Variant(storage, "<", word, True)))
    return path


def test_inspection_reads_headers_only(data: Path) -> None:
    told = describe_matrices(data / "matrices" / "superelements" / "inboard.op4")
    assert told["format"] == "OP4, binary, 32 bit words, little endian"
    assert told["contents"][0] == {
        "what": "matrix", "name": "KXX", "size": "32 x 32", "form": "symmetric",
        "numbers": "real, double",
    }  # fmt: skip


@pytest.mark.parametrize("name", ["1K", "K-1", "TOOLONGNAME", ""])
def test_names_that_nastran_does_not_take_are_refused(tmp_path: Path, name: str) -> None:
    with pytest.raises(InputError, match="name"):
        write_op4(tmp_path / "a.op4", [NastranMatrix(name, sp.csc_matrix(np.eye(2)))])
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize("formatted", [False, True])
def test_only_the_matrices_asked_for_are_read(tmp_path: Path, formatted: bool) -> None:
    path = tmp_path / "two.op4"
    rng = np.random.default_rng(5)
    K, M = (sp.csc_matrix(rng.normal(size=(7, 4))) for _ in range(2))
    write_op4(path, [NastranMatrix("KAA", K), NastranMatrix("MAA", M)], formatted)
    (only,) = read_op4(path, names=["maa"])
    assert only.name == "MAA"
    assert np.array_equal(only.matrix.toarray(), M.toarray())


def test_negative_numbers_with_three_digit_exponents_keep_their_columns(tmp_path: Path) -> None:
    values = np.array([[-1.5e-120, 2.25e200, -1.0 / 3.0], [1.0, -9.5e-101, 1e-300]])
    path = tmp_path / "wide.op4"
    write_op4(path, [NastranMatrix("A", sp.csc_matrix(values))], formatted=True)
    (again,) = read_op4(path)
    np.testing.assert_allclose(again.matrix.toarray(), values, rtol=1e-15)
    assert {len(x) % 23 for x in path.read_text().splitlines()[1:] if "E" in x} == {0}


@pytest.mark.parametrize("storage", ["bigmat", "dense"])
def test_columns_over_several_batches(tmp_path: Path, storage: str) -> None:
    """More bytes than are looked at together; long columns of many strings, and many columns."""
    rng = np.random.default_rng(6)
    tall = sp.random(400_000, 3, 0.2, "csc", random_state=1)
    wide = sp.random(40, 90_000, 0.1, "csc", random_state=2)
    full = sp.csc_matrix(rng.normal(size=(700, 500)))
    for matrix in (tall, wide, full):
        path = tmp_path / "big.op4"
        if storage == "dense" and matrix is not full:
            continue
        if storage == "dense":
            data = packed("A", matrix.toarray(), 2, Variant("dense", "<", 4, True))
            path.write_bytes(data)
        else:
            write_op4(path, [NastranMatrix("A", matrix)])
        (again,) = read_op4(path)
        assert again.matrix.has_sorted_indices
        assert (again.matrix != matrix).nnz == 0


_PEAK = """
import sys
from trueup.adapters.nastran import read_op4
def high():
    lines = open("/proc/self/status").read().splitlines()
    return 1024 * int(next(line.split()[1] for line in lines if line.startswith("VmHWM")))
read_op4(sys.argv[2])
before = high()
m = read_op4(sys.argv[1])[0].matrix
print((high() - before) / (m.data.nbytes + m.indices.nbytes + m.indptr.nbytes), m.nnz)
"""


@pytest.mark.slow
@pytest.mark.skipif(not Path("/proc/self/status").exists(), reason="no /proc on this system")
@pytest.mark.parametrize("formatted", [False, True])
def test_reading_takes_little_more_memory_than_the_matrix(tmp_path: Path, formatted: bool) -> None:
    import subprocess
    import sys

    n = 300_000
    rng = np.random.default_rng(7)
    offsets = [-300, -1, 0, 1, 300]
    band = sp.diags([rng.normal(size=n - abs(k)) for k in offsets], offsets, format="csc")
    write_op4(tmp_path / "band.op4", [NastranMatrix("K", band)], formatted)
    write_op4(tmp_path / "small.op4", [NastranMatrix("K", band[:4, :4])], formatted)
    command = [sys.executable, "-c", _PEAK, tmp_path / "band.op4", tmp_path / "small.op4"]
    said = subprocess.run(command, capture_output=True, text=True, check=True).stdout.split()
    assert int(said[1]) == band.nnz
    assert float(said[0]) < 2.0


@pytest.mark.slow
def test_a_matrix_of_ten_million_rows_stays_sparse(tmp_path: Path) -> None:
    rng = np.random.default_rng(3)
    rows, columns = rng.integers(10_000_000, size=100_000), rng.integers(10_000, size=100_000)
    values = rng.normal(size=100_000)
    matrix = sp.coo_matrix((values, (rows, columns)), shape=(10_000_000, 10_000)).tocsc()
    path = tmp_path / "long.op4"
    write_op4(path, [NastranMatrix("PHI", matrix)])
    (again,) = read_op4(path)
    assert (again.matrix != matrix).nnz == 0
    assert again.matrix.data.nbytes < 2e6


def test_maps_of_one_size_and_matrices_without_any_come_back(tmp_path: Path) -> None:
    one = DofMap(np.array([1, 1, 5]), np.array([1, 3, 0]))
    two = DofMap(np.array([2, 3, 4]), np.array([1, 1, 1]))
    K = sp.csc_matrix(np.diag([1.0, 2.0, 3.0]))
    matrices = [
        NastranMatrix("KAA", K, 6, one, one),
        NastranMatrix("PLAIN", K, 6),
        NastranMatrix("GOA", sp.csc_matrix(np.ones((3, 3))), 2, two, one),
        NastranMatrix("LOOP_END", sp.csc_matrix(np.ones((1, 1))), 2),
    ]
    path = tmp_path / "maps.op4"
    write_op4(path, matrices)
    again = read_matrices(path)
    assert [m.name for m in again] == [m.name for m in matrices]
    for a, b in zip(again, matrices, strict=True):
        for x, y in ((a.rows, b.rows), (a.columns, b.columns)):
            assert (x is None) == (y is None)
            assert x is None or np.array_equal(x.keys, y.keys)


def test_a_header_of_more_rows_than_any_model_has_is_damage(tmp_path):
    path = tmp_path / "a.op4"
    write_op4(path, [NastranMatrix("AMAT", sp.csc_matrix((4, 4)))])
    whole = bytearray(path.read_bytes())
    whole[8:12] = struct.pack("<i", 1_500_000_000)
    path.write_bytes(whole)
    with pytest.raises(InputError, match="AMAT' says that it has 1500000000 rows"):
        read_op4(path)
