"""Files beside pyuff, pyNastran and pyyeti in one run; ends with one line of JSON.

``python benchmarks/files.py [--quick] [--pyyeti PYTHON]``: writes universal files, OP4, OP2 and
Nastran HDF5 of random numbers in a temporary folder and reads them with trueup and with the
others. pyyeti needs a newer numpy than pyNastran takes: PYTHON is an interpreter that has it
(default: this one, left out where it has not). Megabytes are of the file; ``peak_memory_over_data``
is what reading adds to a fresh process over the bytes of the arrays it returns.
"""

from __future__ import annotations

import argparse
import json
import struct
import subprocess
import sys
import tempfile
import warnings
from collections.abc import Iterator
from pathlib import Path

import h5py
import numpy as np
import scipy.sparse as sp
from universal import compare as compare_universal, large as large_universal, seconds, survey

from trueup.adapters.nastran import NastranMatrix, read_modes, read_op4, write_op4

_PEAK = """
import sys
from pathlib import Path
from trueup.adapters.nastran import read_modes, read_op4
def high():
    lines = Path("/proc/self/status").read_text().splitlines()
    return 1024 * int(next(line.split()[1] for line in lines if line.startswith("VmHWM")))
def size(path):
    if path.endswith(".op4"):
        found = [m.matrix for m in read_op4(path)]
        return sum(m.data.nbytes + m.indices.nbytes + m.indptr.nbytes for m in found)
    return read_modes(path).shapes.nbytes
size(sys.argv[2])
before = high()
data = size(sys.argv[1])
print((high() - before) / data)
"""

_PYYETI = """
import json, sys, time
from pyyeti.nastran import op4
done = {}
for name in sys.argv[1:]:
    start = time.perf_counter()
    op4.load(name, into="list", sparse=True)
    done[name] = time.perf_counter() - start
print(json.dumps(done))
"""


def megabytes(path: Path) -> float:
    """Size of a file."""
    return path.stat().st_size / 1e6


def peak(path: Path, small: Path) -> float:
    """Return the peak memory of reading in a fresh process, over the data returned."""
    command = [sys.executable, "-c", _PEAK, str(path), str(small)]
    return float(subprocess.run(command, capture_output=True, text=True, check=True).stdout)


def matrices(n: int, n_dense: int) -> dict[str, sp.csc_matrix]:
    """Return a band matrix with a far diagonal, and a full one."""
    rng = np.random.default_rng(1)
    offsets = [-300, -2, -1, 0, 1, 2, 300]
    band = sp.diags([rng.normal(size=n - abs(k)) for k in offsets], offsets, format="csc")
    return {"sparse": band, "dense": sp.csc_matrix(rng.normal(size=(n_dense, n_dense)))}


def op4(folder: Path, quick: bool, pyyeti: str) -> Iterator[tuple[str, float]]:
    """OP4, sparse and full, binary and as text; a matrix of ten million rows."""
    from pyNastran.op4.op4 import read_op4 as by_pynastran

    small = folder / "small.op4"
    write_op4(small, [NastranMatrix("K", sp.eye(3, format="csc"))])
    files = []
    for name, matrix in matrices(*((100_000, 1000) if quick else (1_000_000, 4000))).items():
        for form in ("binary", "text"):
            if form == "text" and not quick:
                continue
            path, key = folder / f"{name}_{form}.op4", f"op4_{name}_{form}"
            one = [NastranMatrix("K", matrix)]
            wrote = seconds(lambda p=path, m=one, f=form: write_op4(p, m, f == "text"), 1)
            yield f"{key}_mb", megabytes(path)
            yield f"{key}_write_mb_s", megabytes(path) / wrote
            ours = seconds(lambda p=path: read_op4(p))
            yield f"{key}_read_mb_s", megabytes(path) / ours
            theirs = seconds(lambda p=path: by_pynastran(str(p), debug=None), 1)
            yield f"{key}_read_over_pynastran", theirs / ours
            if form == "binary":
                yield f"{key}_peak_memory_over_data", peak(path, small)
            files.append((key, path, ours))
    command = [pyyeti, "-c", _PYYETI, *(str(p) for _, p, _ in files)]
    run = subprocess.run(command, capture_output=True, text=True, check=False)
    if run.returncode == 0:
        other = json.loads(run.stdout.splitlines()[-1])
        for key, path, ours in files:
            yield f"{key}_read_over_pyyeti", other[str(path)] / ours
    else:
        sys.stderr.write("pyyeti is left out: give --pyyeti an interpreter that has it\n")
    long = sp.random(10_000_000, 50, 1e-4, "csc", random_state=1)
    path = folder / "long.op4"
    write_op4(path, [NastranMatrix("PHI", long)])
    yield "op4_ten_million_rows_read_s", seconds(lambda: read_op4(path), 1)
    (again,) = read_op4(path)
    yield "op4_ten_million_rows_is_sparse_and_equal", float((again.matrix != long).nnz == 0)


def op2_of_modes(path: Path, n_grid: int, n_mode: int) -> None:
    """Write a modal OP2 as MSC Nastran does, 32 bit."""
    rng = np.random.default_rng(1)

    def record(data: bytes) -> bytes:
        mark = struct.pack("<i", len(data))
        return mark + data + mark

    def markers(*values: int) -> bytes:
        return b"".join(record(struct.pack("<i", v)) for v in values)

    table = np.zeros(n_grid, [("id", "<i4"), ("kind", "<i4"), ("u", "<f4", 6)])
    table["id"], table["kind"] = 10 * np.arange(1, n_grid + 1) + 2, 1
    with path.open("wb") as out:
        out.write(markers(3) + record(bytes(12)))
        out.write(markers(7) + record(b"NASTRAN FORT TAPE ID CODE - "))
        out.write(markers(2) + record(b"XXXXXXXX") + markers(-1, 0))
        out.write(markers(2) + record(b"OUGV1   ") + markers(-1, 7))
        out.write(record(struct.pack("<7i", 101, 0, 0, 0, 0, 0, 1)))
        out.write(markers(-2, 1, 0, 2) + record(b"OUGV1   "))
        for k in range(n_mode):
            head = np.zeros(146, "<i4")
            head[[0, 1, 3, 4, 8, 9]] = 22, 7, 1, k + 1, 1, 8
            head[5:6].view("<f4")[:] = (2 * np.pi * (5.0 + k)) ** 2
            head[50:] = int.from_bytes(b"    ", "little")
            out.write(markers(-3 - 2 * k, 1, 0, 146) + record(head.tobytes()))
            table["u"] = rng.normal(size=(n_grid, 6))
            data = table.tobytes()
            out.write(markers(-4 - 2 * k, 1, 0, len(data) // 4) + record(data))
        out.write(markers(-3 - 2 * n_mode, 1, 0, 0, 0))


def hdf5_of_modes(path: Path, n_grid: int, n_mode: int) -> None:
    """Write modal HDF5 as MSC Nastran lays it out."""
    rng = np.random.default_rng(1)
    columns = [("ID", "<i8"), *((c, "<f8") for c in ("X", "Y", "Z", "RX", "RY", "RZ"))]
    rows = np.zeros(n_grid, [*columns, ("DOMAIN_ID", "<i8")])
    rows["ID"] = np.arange(1, n_grid + 1)
    names = ("ID", "SUBCASE", "ANALYSIS", "MODE", "SE")
    domains = np.zeros(n_mode, [*((c, "<i8") for c in names), ("TIME_FREQ_EIGR", "<f8"),
                                ("EIGI", "<f8")])  # fmt: skip
    domains["ID"] = np.arange(2, n_mode + 2)
    domains["SUBCASE"], domains["ANALYSIS"] = 1, 2
    domains["MODE"] = np.arange(1, n_mode + 1)
    domains["TIME_FREQ_EIGR"] = (2 * np.pi * (5.0 + np.arange(n_mode))) ** 2
    index = np.zeros(n_mode, [(c, "<i8") for c in ("DOMAIN_ID", "POSITION", "LENGTH")])
    index["DOMAIN_ID"], index["LENGTH"] = domains["ID"], n_grid
    index["POSITION"] = n_grid * np.arange(n_mode)
    with h5py.File(path, "w") as file:
        file["NASTRAN/RESULT/DOMAINS"] = domains
        file["INDEX/NASTRAN/RESULT/NODAL/EIGENVECTOR"] = index
        vectors = file.create_dataset(
            "NASTRAN/RESULT/NODAL/EIGENVECTOR", (n_grid * n_mode,), rows.dtype
        )
        for k in range(n_mode):
            for c, _ in columns[1:]:
                rows[c] = rng.normal(size=n_grid)
            rows["DOMAIN_ID"] = k + 2
            vectors[k * n_grid : (k + 1) * n_grid] = rows


def modes(folder: Path, quick: bool) -> Iterator[tuple[str, float]]:
    """Modes of OP2 and HDF5: whole, one mode of many, memory."""
    from cpylog import SimpleLogger
    from pyNastran.op2.op2 import OP2

    def by_pynastran(path: Path) -> None:
        model = OP2(log=SimpleLogger("critical", log_func=lambda *_: None))
        model.include_exclude_results(include_results=["eigenvectors"])
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            model.read_op2(str(path), build_dataframe=False)

    size = (20_000, 60) if quick else (100_000, 300)
    for name, write in (("op2", op2_of_modes), ("hdf5", hdf5_of_modes)):
        path, small = folder / f"modes.{name}", folder / f"small.{name}"
        write(path, *size)
        write(small, 4, 2)
        yield f"{name}_modes_mb", megabytes(path)
        whole = seconds(lambda p=path: read_modes(p))
        yield f"{name}_modes_read_mb_s", megabytes(path) / whole
        one = seconds(lambda p=path: read_modes(p, modes=[3]))
        yield f"{name}_one_mode_of_{size[1]}_over_whole", one / whole
        if name == "op2":
            yield "op2_modes_read_over_pynastran", seconds(lambda p=path: by_pynastran(p)) / whole
        yield f"{name}_modes_peak_memory_over_data", peak(path, small)
        path.unlink()


def main() -> None:
    """Run all comparisons."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--quick", action="store_true", help="smaller files")
    parser.add_argument("--pyyeti", default=sys.executable, metavar="PYTHON")
    given = parser.parse_args()
    result: dict[str, float] = {}
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        for k, v in compare_universal(folder, survey(20, 2, 2000)).items():
            result[f"universal_{k}"] = v
        size = (100, 4, 4000) if given.quick else (500, 16, 8000)
        for k, v in large_universal(folder, survey(*size)).items():
            result[f"universal_{k}"] = v
        for path in folder.iterdir():
            path.unlink()
        result |= dict(op4(folder, given.quick, given.pyyeti))
        result |= dict(modes(folder, given.quick))
    write = "universal_write_ascii"
    result["write_58_over_pyuff"] = result[f"{write}_mb_s"] / result[f"{write}_pyuff_mb_s"]
    for form in ("single", "double"):
        read = f"universal_read_ascii_{form}"
        result[f"read_58_{form}_over_pyuff"] = result[f"{read}_mb_s"] / result[f"{read}_pyuff_mb_s"]
    for key, value in result.items():
        sys.stdout.write(f"{key:50s} {value:10.3f}\n")
    sys.stdout.write(json.dumps({k: round(v, 3) for k, v in result.items()}) + "\n")


if __name__ == "__main__":
    main()
