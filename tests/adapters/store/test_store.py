"""The neutral store: what is written reads back equal, foreign files are refused."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import h5py
import numpy as np
import pytest
import scipy.sparse as sp
from hypothesis import HealthCheck, given, settings, strategies as st
from hypothesis.extra import numpy as hnp

from trueup.adapters.store import describe_store, is_store, read_store, write_store
from trueup.core.data.dofs import Dofs
from trueup.core.data.frfs import Frfs
from trueup.core.data.geometry import Geometry
from trueup.core.data.modes import Modes
from trueup.core.errors import InputError

finite = st.floats(allow_nan=False, allow_infinity=False)
maybe = st.one_of(st.just(float("nan")), finite)
words = st.text(st.characters(exclude_characters="/\0", exclude_categories=["Cs"]), min_size=1)
names = st.lists(words.filter(lambda w: w not in (".", "..")), min_size=1, max_size=3).map("/".join)
texts = st.text(st.characters(exclude_characters="\0", exclude_categories=["Cs"]), max_size=20)
whole = st.integers(-(2**62), 2**62)
on_disk = settings(
    max_examples=40, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture]
)


@st.composite
def dofs(draw: st.DrawFn, n: int | None = None) -> Dofs:
    n = draw(st.integers(0, 5)) if n is None else n
    return Dofs(
        draw(hnp.arrays(np.int64, n, elements=whole)),
        draw(hnp.arrays(np.int64, n, elements=st.integers(1, 6))),
        draw(hnp.arrays(float, (n, 3), elements=finite)),
    )


@st.composite
def geometries(draw: st.DrawFn) -> Geometry:
    ids = draw(st.lists(whole, unique=True, max_size=6))
    shapes = st.sampled_from(["point", "line", "tria", "quad", "tetra", "hexa"])
    tables = {
        shape: draw(hnp.arrays(np.int64, (draw(st.integers(0, 3)), 2), elements=whole))
        for shape in draw(st.sets(shapes))
    }
    return Geometry(
        np.array(ids, dtype=np.int64),
        draw(hnp.arrays(float, (len(ids), 3), elements=finite)),
        draw(st.sampled_from(["m", "mm", "in", "ft", None])),
        tables,
        {shape: np.arange(len(t)) for shape, t in tables.items()},
    )


@st.composite
def modes(draw: st.DrawFn) -> Modes:
    at, n = draw(dofs()), draw(st.integers(0, 4))
    number = st.complex_numbers(allow_nan=False, allow_infinity=False)
    kind = draw(st.sampled_from([np.float64, np.complex128]))
    return Modes(
        draw(hnp.arrays(float, n, elements=finite)),
        draw(hnp.arrays(kind, (len(at), n), elements=finite if kind is np.float64 else number)),
        at,
        draw(hnp.arrays(float, n, elements=maybe)),
        draw(hnp.arrays(float, n, elements=maybe)),
        draw(texts),
        draw(hnp.arrays(bool, n)),
    )


@st.composite
def frfs(draw: st.DrawFn) -> Frfs:
    responses, references, n = draw(dofs()), draw(dofs()), draw(st.integers(0, 4))
    shape = (len(responses), len(references), n)
    return Frfs(
        draw(hnp.arrays(float, n, elements=finite)),
        responses,
        references,
        draw(hnp.arrays(np.complex128, shape, elements=st.complex_numbers())),
        draw(st.sampled_from(["displacement", "velocity", "acceleration"])),
        draw(texts),
    )


def same(a: Any, b: Any) -> bool:
    """Equal nouns: same type, same arrays of the same dtype, bit by bit (NaN equals NaN)."""
    if isinstance(a, np.ndarray):
        return a.dtype == b.dtype and np.array_equal(a, b, equal_nan=a.dtype.kind in "fc")
    if hasattr(a, "__dataclass_fields__"):
        return type(a) is type(b) and all(
            same(getattr(a, f), getattr(b, f)) for f in a.__dataclass_fields__
        )
    if isinstance(a, dict):
        return a.keys() == b.keys() and all(same(a[k], b[k]) for k in a)
    return bool(a == b)


@given(geometry=geometries(), test=geometries())
@on_disk
def test_geometries_read_back_equal(tmp_path: Path, geometry: Geometry, test: Geometry) -> None:
    write_store(tmp_path / "a.h5", geometry=geometry, test_geometry=test)
    content = read_store(tmp_path / "a.h5")
    assert same(content.geometry, geometry)
    assert same(content.test_geometry, test)


@given(name=names, noun=modes())
@on_disk
def test_modes_read_back_equal_under_any_name(tmp_path: Path, name: str, noun: Modes) -> None:
    write_store(tmp_path / "a.h5", modes={name: noun})
    content = read_store(tmp_path / "a.h5")
    assert same(content.modes, {name: noun})
    assert content.geometry is None


@given(name=names, noun=frfs(), at=dofs())
@on_disk
def test_frfs_and_dofs_read_back_equal(tmp_path: Path, name: str, noun: Frfs, at: Dofs) -> None:
    write_store(tmp_path / "a.h5", frfs={name: noun}, dofs={name: at})
    content = read_store(tmp_path / "a.h5")
    assert same(content.frfs, {name: noun})
    assert same(content.dofs, {name: at})


@given(
    dense=hnp.arrays(
        st.sampled_from([np.float64, np.float32, np.complex128, np.int64, np.bool_]),
        hnp.array_shapes(min_dims=0, max_dims=3, min_side=0),
    )
)
@on_disk
def test_dense_matrices_read_back_equal(tmp_path: Path, dense: np.ndarray[Any, Any]) -> None:
    write_store(tmp_path / "a.h5", matrices={"a": dense})
    assert same(read_store(tmp_path / "a.h5").matrices["a"], dense)


def test_sparse_matrices_stay_sparse(tmp_path: Path) -> None:
    n = 2_000_000  # dense it would take 32 TB
    matrix = sp.coo_matrix(([3.0, 4.0], ([1, n - 1], [n - 2, 0])), shape=(n, n))
    write_store(tmp_path / "a.h5", matrices={"K/stiffness": matrix, "empty": sp.csc_matrix((3, 0))})
    read = read_store(tmp_path / "a.h5").matrices
    assert sp.issparse(read["K/stiffness"])
    assert read["K/stiffness"].shape == (n, n)
    assert (read["K/stiffness"] != matrix).nnz == 0
    assert read["empty"].shape == (3, 0)


cells = st.one_of(
    st.none(), st.booleans(), whole, finite, texts, st.lists(st.one_of(st.none(), finite)),
    st.dictionaries(texts, finite, max_size=3),
)  # fmt: skip


@given(rows=st.lists(st.dictionaries(texts, cells, max_size=4), max_size=5))
@on_disk
def test_tables_of_anything_read_back_equal(tmp_path: Path, rows: list[dict[str, Any]]) -> None:
    write_store(tmp_path / "a.h5", history=rows)
    assert list(read_store(tmp_path / "a.h5").history) == rows


PAIRS = [
    {"test": 1, "analysis": 1, "test_hz": 33.9, "mac": 0.98, "cluster": None},
    {"test": 2, "analysis": 3, "test_hz": 35.4, "mac": None, "cluster": 4},
]


def test_pairs_are_plain_columns_that_other_programs_read(tmp_path: Path) -> None:
    write_store(tmp_path / "a.h5", pairs=PAIRS)
    assert list(read_store(tmp_path / "a.h5").pairs) == PAIRS
    with h5py.File(tmp_path / "a.h5") as file:
        columns = {d.attrs["name"]: d for d in file["pairs"].values()}
        assert columns["test_hz"].attrs["units"] == "Hz"
        assert columns["test_hz"][()].tolist() == [33.9, 35.4]
        assert np.isnan(columns["mac"][1])


def test_mac_keeps_its_modes_and_unknown_values(tmp_path: Path) -> None:
    given_mac = {"test": [1, 2], "analysis": [7, 9, 12], "values": [[1, 0, None], [0, 0.5, 0.25]]}
    write_store(tmp_path / "a.h5", mac={"mac_rotated": given_mac})
    read = read_store(tmp_path / "a.h5").mac["mac_rotated"]
    assert read["analysis"].tolist() == [7, 9, 12]
    np.testing.assert_array_equal(read["values"], [[1, 0, np.nan], [0, 0.5, 0.25]])


def example() -> dict[str, Any]:
    at = Dofs(np.array([1, 2]), np.array([1, 3]))
    return {
        "geometry": Geometry(np.array([1, 2]), np.zeros((2, 3)), "mm", {"line": [[0, 1]]}),
        "modes": {"analysis": Modes(np.array([10.0, 20.0]), np.eye(2), at, source="deck")},
        "matrices": {"K": sp.eye(2, format="csr")},
        "pairs": PAIRS,
    }


def test_units_are_told_beside_the_numbers(tmp_path: Path) -> None:
    write_store(tmp_path / "a.h5", **example())
    with h5py.File(tmp_path / "a.h5") as file:
        assert file.attrs["format"] == "trueup"
        assert file.attrs["version"] == 1
        assert file["geometry/xyz"].attrs["units"] == "mm"
        assert file["modes/analysis/frequencies_hz"].attrs["units"] == "Hz"
        bare: list[str] = []
        file.visititems(
            lambda name, item: (
                bare.append(name)
                if isinstance(item, h5py.Dataset) and "units" not in item.attrs
                else None
            )
        )
        assert bare == []


def test_description_counts_what_is_there(tmp_path: Path) -> None:
    write_store(tmp_path / "a.h5", **example())
    told = describe_store(tmp_path / "a.h5")
    assert told["format"] == "trueup store, version 1"
    by_what = {c["what"]: c for c in told["contents"]}
    assert by_what["geometry"]["nodes"] == 2
    assert by_what["geometry"]["elements"] == {"line": 1}
    assert by_what["modes"] | {"source": ""} == {
        "what": "modes", "name": "analysis", "modes": 2, "dofs": 2, "complex": False,
        "from_hz": 10.0, "to_hz": 20.0, "source": "",
    }  # fmt: skip
    assert by_what["matrix"]["storage"] == "csr"
    assert by_what["pairs"]["rows"] == 2


def test_a_failed_write_leaves_the_old_store_and_no_litter(tmp_path: Path) -> None:
    path = tmp_path / "a.h5"
    write_store(path, **example())
    before = path.read_bytes()
    with pytest.raises(InputError, match="cannot be written"):
        write_store(path, matrices={"good": np.eye(2), "bad": np.array([object()])})
    assert path.read_bytes() == before
    assert [p.name for p in tmp_path.iterdir()] == ["a.h5"]


def test_the_same_content_gives_the_same_bytes(tmp_path: Path) -> None:
    for name in ("a.h5", "b.h5"):
        write_store(tmp_path / name, **example())
    assert (tmp_path / "a.h5").read_bytes() == (tmp_path / "b.h5").read_bytes()


@pytest.mark.parametrize("name", ["", "/", "a//b", "../up", "a/.", "nul\0"])
def test_names_that_hdf5_would_bend_are_refused(tmp_path: Path, name: str) -> None:
    with pytest.raises(InputError, match="no name for matrices"):
        write_store(tmp_path / "a.h5", matrices={name: np.eye(2)})
    assert list(tmp_path.iterdir()) == []


def test_a_name_under_another_is_refused(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="'a/data' of matrices lies under 'a'"):
        write_store(tmp_path / "a.h5", matrices={"a/data": np.eye(2), "a": np.eye(2)})


def test_missing_folder(tmp_path: Path) -> None:
    with pytest.raises(InputError, match=r"a\.h5 cannot be written: No such file"):
        write_store(tmp_path / "no" / "a.h5")


def test_unreadable_and_foreign_files_are_told_apart(tmp_path: Path) -> None:
    path = tmp_path / "a.h5"
    with pytest.raises(InputError, match="does not exist"):
        read_store(path)
    path.write_bytes(b"not HDF5 at all")
    with pytest.raises(InputError, match="is not an HDF5 file"):
        read_store(path)
    assert not is_store(path)
    with h5py.File(path, "w") as file:
        file["data"] = [1.0]
    with pytest.raises(InputError, match="HDF5 file but no store of trueup"):
        read_store(path)
    assert not is_store(path)
    with h5py.File(path, "w") as file:
        file.attrs["format"], file.attrs["version"] = "trueup", 99
    with pytest.raises(InputError, match="version 99; this trueup reads version 1"):
        read_store(path)
    assert is_store(path)


def test_damaged_stores_are_one_sentence(tmp_path: Path) -> None:
    path = tmp_path / "a.h5"
    write_store(path, **example())
    whole_file = path.read_bytes()
    for cut in (len(whole_file) // 2, len(whole_file) - 1):
        path.write_bytes(whole_file[:cut])
        with pytest.raises(InputError, match="damaged store"):
            read_store(path)
    path.write_bytes(whole_file)
    with h5py.File(path, "a") as file:
        del file["modes/analysis/shapes"]
    with pytest.raises(InputError, match=r"a\.h5 is a damaged store: .*shapes"):
        read_store(path)
    path.write_bytes(whole_file)
    with h5py.File(path, "a") as file:
        del file["modes/analysis/shapes"]
        file["modes/analysis/shapes"] = np.eye(3)
    with pytest.raises(InputError, match=r"damaged store: mode shapes of deck has shape"):
        read_store(path)


def test_a_store_cut_anywhere_ends_in_content_or_one_sentence(tmp_path: Path) -> None:
    """Not with bytes changed at random: HDF5 itself can hang on those (H5Aread)."""
    good, path = tmp_path / "good.h5", tmp_path / "bad.h5"
    write_store(good, **example())
    raw = good.read_bytes()
    for cut in range(1, len(raw), max(len(raw) // 80, 1)):
        path.write_bytes(raw[:cut])
        is_store(path)
        for read in (read_store, describe_store):
            with pytest.raises(InputError):
                read(path)


def test_whatever_is_missing_ends_in_content_or_one_sentence(tmp_path: Path) -> None:
    """Each data set, group and attribute taken away in turn."""
    good, path = tmp_path / "good.h5", tmp_path / "bad.h5"
    write_store(good, **example())
    items: list[tuple[str, str]] = []
    with h5py.File(good) as file:
        items += [("/", a) for a in file.attrs]
        file.visititems(lambda n, o: items.extend([(n, ""), *((n, a) for a in o.attrs)]))
    refused = 0
    for name, attribute in items:
        path.write_bytes(good.read_bytes())
        with h5py.File(path, "r+") as file:
            if attribute:
                del file[name].attrs[attribute]
            else:
                del file[name]
        for read in (read_store, describe_store):
            try:
                read(path)
            except InputError as error:
                refused += 1
                assert "\n" not in str(error)  # noqa: PT017
    assert refused > 20


def test_functions_read_back_equal(tmp_path: Path) -> None:
    said = {
        "abscissa": np.arange(5) / 8.0, "values": np.arange(5) + 1j, "response": (3, -1),
        "reference": (0, 0), "function": "spectrum", "quantity": "acceleration", "per": "unknown",
        "over": "frequency", "abscissa_unit": "Hz", "ordinate_unit": "m/s²", "ids": ("a", ""),
    }  # fmt: skip
    path = tmp_path / "a.h5"
    write_store(path, functions={"spectrum/00001": said})
    (again,) = read_store(path).functions.values()
    assert np.array_equal(again["values"], said["values"])
    assert np.array_equal(again["abscissa"], said["abscissa"])
    assert {k: v for k, v in again.items() if k not in ("values", "abscissa")} == {
        k: v for k, v in said.items() if k not in ("values", "abscissa")
    }
