"""A unit of 200 modes, 20 inputs and 300 outputs: how long its export and its steps take.

Beside it the same steps by numpy, as a unit that runs Python would take them at best, and scipy's
`lsim`. Ends with one line of JSON: seconds of the export (compiling the kernel included, which
happens once a process, and without), microseconds of a step with all inputs set and all outputs
read, and the largest difference of an output to numpy's over its largest value.
"""

from __future__ import annotations

import ctypes
import json
import time
import zipfile
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import numpy as np
from scipy.linalg import expm
from scipy.signal import lsim

from trueup.adapters.fmu import write_unit
from trueup.adapters.fmu.build_kernel import PLATFORMS
from trueup.core.statespace.channels import read_channels
from trueup.core.statespace.modal_plant import ModalPlant

MODES, INPUTS, OUTPUTS, STEPS, STEP = 200, 20, 300, 2000, 1e-3


def plant() -> ModalPlant:
    """Return modes and shapes by chance."""
    r = np.random.default_rng(0)
    kinds = ("", ":vel", ":acc")
    inputs = read_channels([f"{k}:Z" for k in range(1, INPUTS + 1)], "input")
    outputs = read_channels([f"{k}:Z{kinds[k % 3]}" for k in range(1, OUTPUTS + 1)], "output")
    drive, sense = r.normal(size=(MODES, INPUTS)), r.normal(size=(OUTPUTS, MODES))
    hz = np.sort(r.uniform(5.0, 400.0, MODES))
    return ModalPlant(hz, np.full(MODES, 0.02), drive, sense, inputs, outputs)


def timed(what: Any) -> tuple[float, Any]:
    """Return seconds and the result."""
    began = time.perf_counter()
    result = what()
    return time.perf_counter() - began, result


def by_unit(unit: Path, platform: str, u: np.ndarray) -> tuple[float, np.ndarray]:
    """Step a unit of FMI 2.0 through ctypes."""
    with zipfile.ZipFile(unit) as archive:
        archive.extractall(unit.parent)
        text = archive.read("modelDescription.xml").decode()
    token = text.split('guid="')[1].split('"')[0].encode()
    library = ctypes.CDLL(str(unit.parent / f"binaries/{platform}/unit{PLATFORMS[platform][2]}"))
    library.fmi2Instantiate.restype = ctypes.c_void_p
    where = (unit.parent / "resources").as_uri().encode()
    one = ctypes.c_void_p(library.fmi2Instantiate(b"unit", 1, token, where, None, 0, 0))
    into = np.arange(INPUTS, dtype=np.uint32)
    out = np.arange(INPUTS, INPUTS + OUTPUTS, dtype=np.uint32)
    y = np.zeros((len(u), OUTPUTS))
    address = [a.ctypes.data for a in (into, out, u, y)]
    n_in, n_out = ctypes.c_size_t(INPUTS), ctypes.c_size_t(OUTPUTS)
    vr_in, vr_out = (ctypes.c_void_p(a) for a in address[:2])
    began = time.perf_counter()
    for k in range(len(u)):
        now, then = ctypes.c_void_p(address[2] + 160 * k), ctypes.c_void_p(address[3] + 2400 * k)
        library.fmi2SetReal(one, vr_in, n_in, now)
        library.fmi2DoStep(one, ctypes.c_double(k * STEP), ctypes.c_double(STEP), 1)
        library.fmi2GetReal(one, vr_out, n_out, then)
    return time.perf_counter() - began, y


def by_numpy(of: ModalPlant, u: np.ndarray) -> tuple[float, np.ndarray]:
    """Step with one matrix exponential of all states."""
    A, B, C, D = of.matrices()
    n, m = B.shape
    E = expm(np.block([[A, B], [np.zeros((m, n + m))]]) * STEP)[:n]
    F, G = np.ascontiguousarray(E[:, :n]), np.ascontiguousarray(E[:, n:])
    x, y = np.zeros(n), np.zeros((len(u), len(C)))
    began = time.perf_counter()
    for k, now in enumerate(u):
        x = F @ x + G @ now
        y[k] = C @ x + D @ now
    return time.perf_counter() - began, y


def main() -> None:
    """Measure and print."""
    made, u = plant(), np.random.default_rng(1).normal(size=(STEPS, INPUTS))
    with TemporaryDirectory() as folder:
        unit = Path(folder) / "unit.fmu"
        first, platforms = timed(lambda: write_unit(unit, made, 2))
        again, _ = timed(lambda: write_unit(unit, made, 2))
        size = unit.stat().st_size
        seconds, y = by_unit(unit, platforms[0], u)
    python, exact = by_numpy(made, u)
    of_scipy, _ = timed(lambda: lsim(made.matrices(), u, np.arange(STEPS) * STEP, interp=False))
    told = {
        "export_seconds": round(first, 3),
        "export_again_seconds": round(again, 3),
        "unit_bytes": size,
        "step_microseconds": round(1e6 * seconds / STEPS, 2),
        "numpy_step_microseconds": round(1e6 * python / STEPS, 2),
        "lsim_step_microseconds": round(1e6 * of_scipy / STEPS, 2),
        "difference": float((np.abs(y - exact).max(axis=0) / np.abs(exact).max(axis=0)).max()),
    }
    print(json.dumps(told))  # noqa: T201


if __name__ == "__main__":
    main()
