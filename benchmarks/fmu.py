"""A unit of 200 modes, 20 inputs and 300 outputs: how long its export and its steps take.

Beside it the same steps by numpy, by a unit of pythonfmu that runs them (where that is installed),
and by scipy's `lsim`. Ends with one line of JSON: seconds of the export (with the kernel compiled,
and with the compiled kernel kept), microseconds of a step with all inputs set and all outputs read,
and the largest difference of an output to numpy's over its largest value.
"""

from __future__ import annotations

import ctypes
import json
import os
import time
import zipfile
from importlib.util import find_spec
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import numpy as np
from scipy.linalg import expm
from scipy.signal import lsim

from trueup.adapters.fmu import write_unit
from trueup.adapters.fmu.build_kernel import PLATFORMS, _own_platform
from trueup.core.statespace.channels import read_channels
from trueup.core.statespace.modal_plant import ModalPlant

MODES, INPUTS, OUTPUTS, STEPS, STEP = 200, 20, 300, 2000, 1e-3
LOGGER = ctypes.CFUNCTYPE(None, ctypes.c_void_p)(lambda environment: None)


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
    """Step a unit of FMI 2.0 through ctypes; its value references are inputs, then outputs."""
    folder = unit.with_suffix("")
    with zipfile.ZipFile(unit) as archive:
        archive.extractall(folder)
        text = archive.read("modelDescription.xml").decode()
    token = text.split('guid="')[1].split('"')[0].encode()
    (binary,) = (folder / "binaries" / platform).glob(f"*{PLATFORMS[platform][2]}")
    library = ctypes.CDLL(str(binary))
    library.fmi2Instantiate.restype = ctypes.c_void_p
    where = (folder / "resources").as_uri().encode()
    back = (ctypes.c_void_p * 5)(ctypes.cast(LOGGER, ctypes.c_void_p).value)
    one = ctypes.c_void_p(library.fmi2Instantiate(b"unit", 1, token, where, back, 0, 0))
    library.fmi2SetupExperiment(one, 0, ctypes.c_double(), ctypes.c_double(), 0, ctypes.c_double())
    library.fmi2EnterInitializationMode(one)
    library.fmi2ExitInitializationMode(one)
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


SCRIPT = """import numpy as np
from pythonfmu import Fmi2Causality, Fmi2Slave, Real

class unit(Fmi2Slave):
    def __init__(self, **given):
        super().__init__(**given)
        held = np.load(r"{arrays}")
        self.F, self.G, self.C, self.D = (held[k] for k in "FGCD")
        self.x = np.zeros(len(self.F))
        for word, names in (("input", "u"), ("output", "y")):
            for k in range(self.D.shape[word == "input"]):
                setattr(self, names + str(k), 0.0)
                kind = getattr(Fmi2Causality, word)
                self.register_variable(Real(names + str(k), causality=kind))

    def do_step(self, time, step):
        u = np.array([getattr(self, "u" + str(k)) for k in range(self.D.shape[1])])
        self.x = self.F @ self.x + self.G @ u
        for k, y in enumerate(self.C @ self.x + self.D @ u):
            setattr(self, "y" + str(k), float(y))
        return True
"""


def python_unit(of: ModalPlant, folder: Path) -> Path:
    """Write a unit that runs Python."""
    from pythonfmu.builder import FmuBuilder

    _, _, C, D = of.matrices()
    np.savez(folder / "arrays.npz", **dict(zip("FGCD", (*propagation(of), C, D), strict=True)))
    (folder / "unit.py").write_text(SCRIPT.format(arrays=folder / "arrays.npz"))
    made = FmuBuilder.build_FMU(folder / "unit.py", dest=folder)
    return Path(made).rename(folder / "python.fmu")


def propagation(of: ModalPlant) -> tuple[np.ndarray, np.ndarray]:
    """Return what a step makes of all states, and what it adds for held inputs."""
    A, B, _, _ = of.matrices()
    n, m = B.shape
    E = expm(np.block([[A, B], [np.zeros((m, n + m))]]) * STEP)[:n]
    return np.ascontiguousarray(E[:, :n]), np.ascontiguousarray(E[:, n:])


def by_numpy(of: ModalPlant, u: np.ndarray) -> tuple[float, np.ndarray]:
    """Step with one matrix exponential of all states."""
    _, _, C, D = of.matrices()
    F, G = propagation(of)
    x, y = np.zeros(len(F)), np.zeros((len(u), len(C)))
    began = time.perf_counter()
    for k, now in enumerate(u):
        x = F @ x + G @ now
        y[k] = C @ x + D @ now
    return time.perf_counter() - began, y


def main() -> None:
    """Measure and print."""
    made, u = plant(), np.random.default_rng(1).normal(size=(STEPS, INPUTS))
    own, pythons = [_own_platform() or "linux64"], None
    with TemporaryDirectory() as folder:
        os.environ["XDG_CACHE_HOME"] = folder  # nothing is compiled yet
        unit = Path(folder) / "unit.fmu"
        first, platforms = timed(lambda: write_unit(unit, made, 2, own))
        again, _ = timed(lambda: write_unit(unit, made, 2, own))
        size = unit.stat().st_size
        seconds, y = by_unit(unit, platforms[0], u)
        if find_spec("pythonfmu") is not None:
            pythons, same = by_unit(python_unit(made, Path(folder)), platforms[0], u)
            assert np.abs(same - y).max() < 1e-9 * np.abs(y).max()
    python, exact = by_numpy(made, u)
    of_scipy, _ = timed(lambda: lsim(made.matrices(), u, np.arange(STEPS) * STEP, interp=False))
    told = {
        "export_seconds": round(first, 3),
        "export_again_seconds": round(again, 3),
        "unit_bytes": size,
        "step_microseconds": round(1e6 * seconds / STEPS, 2),
        "python_unit_step_microseconds": None
        if pythons is None
        else round(1e6 * pythons / STEPS, 2),
        "numpy_step_microseconds": round(1e6 * python / STEPS, 2),
        "lsim_step_microseconds": round(1e6 * of_scipy / STEPS, 2),
        "difference": float((np.abs(y - exact).max(axis=0) / np.abs(exact).max(axis=0)).max()),
    }
    print(json.dumps(told))  # noqa: T201


if __name__ == "__main__":
    main()
