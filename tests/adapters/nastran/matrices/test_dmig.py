"""DMIG in every form it is punched or typed in."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
import scipy.sparse as sp
from hypothesis import given, strategies as st

from trueup.adapters.nastran import DofMap, NastranMatrix, read_matrices, write_dmig
from trueup.adapters.nastran.matrices.dmig import read_dmig
from trueup.core.errors import InputError

EXPECTED = np.array([[4.0, -1.5], [-1.5, 7.0]])

FORMS = {
    "punched, glued, D exponents": (
        "DMIG    KAAX           0       6       2       0                       2\n"
        "DMIG*   KAAX                           1               3\n"
        "*                      1               3 4.000000000D+00\n"
        "DMIG*   KAAX                           2               3\n"
        "*                      1               3-1.500000000D+00\n"
        "*                      2               3 7.000000000D+00\n"
    ),
    "lower triangle, free field": (
        "$ a comment\nDMIG,KAAX,0,6,2,0\nDMIG,KAAX,1,3,,1,3,4.0\n"
        ",2,3,-1.5\nDMIG,KAAX,2,3,,2,3,7.+0\n"
    ),
    "small field with a tagged continuation": (
        "DMIG    KAAX    0       6       2       0\n"
        "DMIG    KAAX    1       3               1       3       4.0             +A\n"
        "+A      2       3       -1.5\n"
        "DMIG    KAAX    2       3               2       3       7.0\n"
    ),
    "CRLF and letterless exponents": (
        "DMIG    KAAX           0       6       2       0\r\n"
        "DMIG*   KAAX                           1               3\r\n"
        "*                      1               3            4.+0\r\n"
        "*                      2               3          -15.-1\r\n"
        "DMIG*   KAAX                           2               3\r\n"
        "*                      2               3           7.0+0\r\n"
    ),
}


@pytest.mark.parametrize("text", FORMS.values(), ids=FORMS.keys())
def test_every_form_gives_the_same_matrix(tmp_path: Path, text: str) -> None:
    path = tmp_path / "a.pch"
    path.write_bytes(text.encode())
    (found,) = read_dmig(path)
    assert found.name == "KAAX"
    assert found.rows is not None
    np.testing.assert_array_equal(found.rows.point, [1, 2])
    np.testing.assert_array_equal(found.rows.component, [3, 3])
    np.testing.assert_array_equal(found.matrix.toarray(), EXPECTED)


def test_mass_may_name_fewer_degrees_of_freedom_than_stiffness(data: Path) -> None:
    path = data / "matrices" / "dmig_punch_swept" / "sol103_swept_plane.pch1"
    found = {m.name: m for m in read_matrices(path)}
    assert list(found) == ["KAAX", "MAAX", "VAX"]
    assert found["KAAX"].matrix.shape == (45, 45)
    assert found["MAAX"].matrix.shape == (41, 41)
    assert found["VAX"].matrix.shape == (45, 1)
    assert abs(found["KAAX"].matrix - found["KAAX"].matrix.T).max() == 0.0


def test_complex_and_rectangular_matrices(tmp_path: Path) -> None:
    (tmp_path / "a.pch").write_text(
        "DMIG    B              0       9       4       0                       2\n"
        "DMIG*   B                              1               0\n"
        "*                     11               2 1.000000000D+00-2.000000000D+00\n"
        "*                    101               0 3.000000000D+00 0.000000000D+00\n"
    )
    (found,) = read_dmig(tmp_path / "a.pch")
    assert found.rows is not None
    np.testing.assert_array_equal(found.matrix.toarray(), [[1.0 - 2.0j], [3.0]])
    np.testing.assert_array_equal(found.rows.keys, [8 * 11 + 2, 8 * 101])


@st.composite
def matrices(draw: st.DrawFn) -> NastranMatrix:
    n = draw(st.integers(1, 6))
    keys = sorted(draw(st.sets(st.integers(8, 8_000_000), min_size=n, max_size=n)))
    rows = DofMap.of_keys(np.array([k - k % 8 + k % 7 for k in keys]))
    rows = DofMap.of_keys(np.unique(rows.keys))
    n = len(rows)
    exponent = draw(st.integers(-8, 12))
    rng = np.random.default_rng(draw(st.integers(0, 2**32 - 1)))
    A = rng.standard_normal((n, n)) * 10.0**exponent
    form = draw(st.sampled_from([1, 6]))
    if draw(st.booleans()):
        A = A + 1j * rng.standard_normal((n, n))
    A = A + A.T if form == 6 else A
    return NastranMatrix("AMAT", sp.csc_matrix(A), form, rows, rows)


@given(m=matrices())
def test_what_is_written_reads_back(
    tmp_path_factory: pytest.TempPathFactory, m: NastranMatrix
) -> None:
    path = tmp_path_factory.mktemp("dmig") / "a.pch"
    write_dmig(path, [m])
    assert max(len(x) for x in path.read_text().splitlines()) <= 72
    (found,) = read_dmig(path)
    assert found.rows is not None
    assert m.rows is not None
    np.testing.assert_array_equal(found.rows.keys, m.rows.keys)
    np.testing.assert_allclose(found.matrix.toarray(), m.matrix.toarray(), rtol=1e-9)


@pytest.mark.parametrize(
    ("text", "why"),
    [
        ("DMIG*   K                              1               3\n", "before its header"),
        ("DMIG    K       0       6       2\nDMIG*   K                              x       3\n",
         "line 2: this DMIG card cannot be read"),
        ("nothing\n", "no DMIG"),
    ],
)  # fmt: skip
def test_faults_are_one_sentence_with_the_line(tmp_path: Path, text: str, why: str) -> None:
    (tmp_path / "a.pch").write_text(text)
    with pytest.raises(InputError, match=why):
        read_matrices(tmp_path / "a.pch")


def test_a_matrix_without_dof_map_cannot_be_punched(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="no dof map"):
        write_dmig(tmp_path / "a.pch", [NastranMatrix("K", sp.csc_matrix(np.eye(2)))])
    assert not list(tmp_path.iterdir())


@pytest.mark.parametrize("complex_", [False, True])
@pytest.mark.parametrize("number", ["{:16.9E}", "{:<16.9E}", "D", "letterless"])
def test_columns_read_at_once_equal_those_read_card_by_card(
    tmp_path: Path, complex_: bool, number: str
) -> None:
    """A comment among the cards sends all of them the slow way."""
    rng = np.random.default_rng(8)

    def printed(value: float) -> str:
        if number == "D":
            return f"{value:16.9E}".replace("E", "D")
        if number == "letterless":
            return f"{value:16.9E}".replace("E", "").rjust(16)
        return number.format(value)

    lines = [f"DMIG    KAAX           0       6       {4 if complex_ else 2}       0"]
    for j in range(1, 6):
        lines.append(f"DMIG*   KAAX            {j:16d}{1 + j % 3:16d}")
        for i in range(1, j + 1):
            values = [printed(v) for v in rng.normal(size=2 if complex_ else 1) * 10.0 ** (9 * j)]
            component = f"{1 + i % 3:16d}"
            lines.append(f"*       {i:16d}{component}{''.join(values)}")
    lines.append(f"DMIG*   KAAX            {100001:16d}{0:16d}")
    lines.append(f"*       {100001:16d}{'':16}{printed(4.0)}")
    fast, slow = tmp_path / "fast.pch", tmp_path / "slow.pch"
    fast.write_text("\n".join(lines) + "\n")
    slow.write_text("\n".join([*lines[:-2], "$ by hand", *lines[-2:]]) + "\n")
    (a,), (b,) = read_matrices(fast), read_matrices(slow)
    assert np.array_equal(a.rows.keys, b.rows.keys)
    assert np.array_equal(a.matrix.toarray(), b.matrix.toarray())
    assert a.matrix.nnz == 5 * 5 + 1


def test_a_file_of_several_parts_names_the_line_of_a_fault(tmp_path: Path) -> None:
    lines = ["DMIG    KAAX           0       6       2       0"]
    for j in range(1, 30_000):
        lines += [f"DMIG*   KAAX            {j:16d}{1:16d}", f"*       {j:16d}{1:16d}{1.5:16.9E}"]
    path = tmp_path / "big.pch"
    path.write_text("\n".join(lines) + "\n")
    (found,) = read_matrices(path)
    assert found.matrix.shape == (29_999, 29_999)
    at = 2 * 25_000
    lines[at] = lines[at].replace("1.5", "abc")
    path.write_text("\n".join(lines) + "\n")
    with pytest.raises(InputError, match=f"line {at}: this DMIG"):
        read_matrices(path)


def test_magnitudes_and_phases(tmp_path: Path) -> None:
    path = tmp_path / "polar.bdf"
    path.write_text(
        "DMIG,B,0,1,3,0,1\n"
        "DMIG*   B                              1               1\n"
        "*                      1               1   2.0000000E+00   9.0000000E+01\n"
    )
    (found,) = read_matrices(path)
    np.testing.assert_allclose(found.matrix.toarray(), [[2j]], atol=1e-15)


def test_a_matrix_that_begins_twice_is_refused(tmp_path: Path) -> None:
    """A punch file that a second run was appended to."""
    once = (
        "DMIG    KAAX           0       6       2       0\n"
        "DMIG*   KAAX                           1               1\n"
        "*                      1               1   2.0000000E+00\n"
    )
    path = tmp_path / "twice.pch"
    path.write_text(once + once)
    with pytest.raises(InputError, match="line 4: matrix KAAX begins a second time"):
        read_matrices(path)
