"""Speed and memory of universal files beside pyuff, in one run; ends with one line of JSON.

``python benchmarks/universal.py [--quick]``: writes surveys of random frequency responses in a
temporary folder, as ASCII and as 58b, reads them back with both, and reports megabytes a second,
ratios, selective reads and the peak memory of a fresh process.
"""

from __future__ import annotations

import argparse
import json
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable
from pathlib import Path

import numpy as np

from trueup.adapters.universal import read_universal, write_universal
from trueup.core.data.dofs import Dofs
from trueup.core.data.frfs import Frfs

_PEAK = """
import sys
from pathlib import Path
from trueup.adapters.universal import read_universal
def high():
    lines = Path("/proc/self/status").read_text().splitlines()
    return 1024 * int(next(line.split()[1] for line in lines if line.startswith("VmHWM")))
read_universal(Path(sys.argv[2]))
before = high()
frfs = read_universal(Path(sys.argv[1])).frfs
print((high() - before) / frfs.values.nbytes)
"""


def survey(n_response: int, n_reference: int, n_line: int) -> Frfs:
    """Random responses of the given size."""
    rng = np.random.default_rng(1)
    values = rng.normal(size=(n_response, n_reference, n_line, 2)).view(np.complex128)[..., 0]
    return Frfs(
        5.0 + 0.125 * np.arange(n_line),
        Dofs(np.arange(1, n_response + 1), np.full(n_response, 3)),
        Dofs(np.arange(1, n_reference + 1), np.full(n_reference, 3)),
        values,
    )


def seconds(work: Callable[[], object], repeats: int = 3) -> float:
    """Best of a few runs."""
    best = float("inf")
    for _ in range(repeats):
        start = time.perf_counter()
        work()
        best = min(best, time.perf_counter() - start)
    return best


def pyuff_sets(frfs: Frfs) -> list[dict[str, object]]:
    """Return the same survey as pyuff wants it."""
    return [
        {"type": 58, "binary": 0, "func_type": 4, "rsp_node": int(r), "rsp_dir": 3,
         "ref_node": int(q), "ref_dir": 3, "data": frfs.values[i, j], "x": frfs.frequencies_hz,
         "id1": f"{r}/{q}", "rsp_ent_name": "NONE", "ref_ent_name": "NONE",
         "abscissa_spacing": 1, "abscissa_spec_data_type": 18, "ordinate_spec_data_type": 12,
         "orddenom_spec_data_type": 13}
        for i, r in enumerate(frfs.responses.node)
        for j, q in enumerate(frfs.references.node)
    ]  # fmt: skip


def compare(folder: Path, frfs: Frfs) -> dict[str, float]:
    """Write and read the same ASCII 58 with pyuff and with trueup."""
    import pyuff

    theirs, ours, single = (folder / f"{n}.unv" for n in ("pyuff", "trueup", "single"))
    sets = pyuff_sets(frfs)
    write_theirs = seconds(lambda: pyuff.UFF(str(theirs)).write_sets(sets, "overwrite"), 1)
    write_ours = seconds(lambda: write_universal(ours, frfs=frfs))
    write_single = seconds(lambda: write_universal(single, frfs=frfs, single=True))
    found = {
        "write_ascii_pyuff_mb_s": theirs.stat().st_size / write_theirs,
        "write_ascii_mb_s": ours.stat().st_size / write_ours,
        "write_ascii_single_mb_s": single.stat().st_size / write_single,
    }
    for name, path in (("double", ours), ("single", single)):
        size = path.stat().st_size
        read_theirs = seconds(lambda p=path: pyuff.UFF(str(p)).read_sets())
        read_ours = seconds(lambda p=path: read_universal(p))
        found[f"read_ascii_{name}_pyuff_mb_s"] = size / read_theirs
        found[f"read_ascii_{name}_mb_s"] = size / read_ours
    return {k: v / 1e6 for k, v in found.items()}


def large(folder: Path, frfs: Frfs) -> dict[str, float]:
    """Read large files whole and in part, and measure the memory of a fresh process."""
    ascii_file, binary, small = (folder / f"{n}.unv" for n in ("large", "large58b", "small"))
    write_universal(small, frfs=survey(1, 1, 8))
    write_universal(ascii_file, frfs=frfs, single=True)
    found = {
        "ascii_mb": ascii_file.stat().st_size / 1e6,
        "read_ascii_large_mb_s": ascii_file.stat().st_size
        / seconds(lambda: read_universal(ascii_file), 1)
        / 1e6,
    }
    write = seconds(lambda: write_universal(binary, frfs=frfs, binary=True), 1)
    size = binary.stat().st_size
    raw = seconds(lambda: np.fromfile(binary, np.uint8))
    whole = seconds(lambda: read_universal(binary))
    found |= {
        "binary_mb": size / 1e6,
        "write_58b_mb_s": size / write / 1e6,
        "read_58b_mb_s": size / whole / 1e6,
        "read_58b_over_raw_bytes": whole / raw,
    }
    one = frfs.references.node[:1].tolist()
    for name, path in (("ascii", ascii_file), ("58b", binary)):
        everything = seconds(lambda p=path: read_universal(p), 1)
        some = seconds(lambda p=path: read_universal(p, references=one))
        nothing = seconds(lambda p=path: read_universal(p, values=False))
        found[f"{name}_one_reference_of_{len(frfs.references)}_over_whole"] = some / everything
        found[f"{name}_headers_only_over_whole"] = nothing / everything
        if Path("/proc/self/status").exists():
            command = [sys.executable, "-c", _PEAK, str(path), str(small)]
            peak = subprocess.run(command, capture_output=True, text=True, check=True)
            found[f"{name}_peak_memory_over_data"] = float(peak.stdout)
    return found


def main() -> None:
    """Run all comparisons."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--quick", action="store_true", help="smaller files")
    quick = parser.parse_args().quick
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        result = compare(folder, survey(20, 2, 2000))
        result |= large(folder, survey(100 if quick else 500, 4, 4000 if quick else 8000))
    result["write_over_pyuff"] = result["write_ascii_mb_s"] / result["write_ascii_pyuff_mb_s"]
    for form in ("single", "double"):
        ratio = result[f"read_ascii_{form}_mb_s"] / result[f"read_ascii_{form}_pyuff_mb_s"]
        result[f"read_{form}_over_pyuff"] = ratio
    for key, value in result.items():
        sys.stdout.write(f"{key:45s} {value:10.3f}\n")
    sys.stdout.write(json.dumps({k: round(v, 3) for k, v in result.items()}) + "\n")


if __name__ == "__main__":
    main()
