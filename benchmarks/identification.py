"""Identification of large surveys, and beside sdypy-EMA on the survey that it can do.

    python benchmarks/identification.py [--quick]

First: surveys of 4 references, 8,000 lines, 60 modes and 125, 250, 500 responses (--quick: 2,000
lines, 20 modes, 25, 50, 100); processor time and memory per response must not grow with their
number (`time_growth`, `memory_growth`: 1 is linear). Then, where sdypy-EMA is installed (it is no
dependency): one reference, 60 responses, 2,000 lines, 12 modes, 1 % noise, each the best of three
runs; it is told the true frequencies to pick its poles near, which trueup is not. Ends with one
line of JSON; `..._over_ours` above 1 is in trueup's favour.
"""

from __future__ import annotations

import argparse
import json
import sys
import time
import tracemalloc
from collections.abc import Callable
from typing import Any

import numpy as np

from trueup.core.data.dofs import Dofs
from trueup.core.data.frfs import Frfs
from trueup.core.identification.identify import identify
from trueup.core.identification.survey.modal_synthesis import modal_response, poles_from

_BAND = (10.0, 810.0)


def survey(
    n_response: int, n_reference: int, n_line: int, n_mode: int, noise: float
) -> tuple[Frfs, np.ndarray, np.ndarray]:
    """Random modes, evenly spread with jitter; returns functions, frequencies and damping."""
    rng = np.random.default_rng(1)
    low, high = _BAND
    step = (high - low) / n_mode
    hz = low + step * (np.arange(n_mode) + 0.5 + rng.uniform(-0.45, 0.45, n_mode))
    zeta = rng.uniform(0.002, 0.01, n_mode)
    shapes = rng.standard_normal((n_response, n_mode)).astype(complex)
    driven = np.linspace(0, n_response - 1, n_reference).astype(int)
    poles = poles_from(hz, zeta)
    f = np.linspace(low, high, n_line)
    values = modal_response(f, poles, shapes, shapes[driven] / (2j * poles.imag))
    for function in values:
        rms = np.sqrt(np.mean(np.abs(function) ** 2, axis=1, keepdims=True))
        e = rng.standard_normal(function.shape) + 1j * rng.standard_normal(function.shape)
        function += noise * rms / np.sqrt(2.0) * e
    dofs = Dofs(np.arange(1, n_response + 1), np.full(n_response, 3))
    return Frfs(f, dofs, dofs.take(driven), values, "acceleration", "survey"), hz, zeta


def _say(text: str) -> None:
    sys.stderr.write(text + "\n")


def growth(quick: bool) -> dict[str, Any]:
    """Time, and peak memory above the functions themselves, for three numbers of responses."""
    n_line, n_mode = (2000, 20) if quick else (8000, 60)
    rows = []
    for n_response in (25, 50, 100) if quick else (125, 250, 500):
        frfs, hz, _ = survey(n_response, 4, n_line, n_mode, 0.02)
        since = time.process_time()
        result = identify(frfs)
        seconds = time.process_time() - since
        tracemalloc.start()
        identify(frfs)
        peak = tracemalloc.get_traced_memory()[1] / 1e9
        tracemalloc.stop()
        found = len(result.modes)
        error = float(np.abs(result.modes.frequencies_hz / hz - 1).max()) if found == len(hz) else 1
        _say(
            f"{n_response:4d} responses {seconds:7.1f} s, peak {peak:.2f} GB beside "
            f"{frfs.values.nbytes / 1e9:.2f}, {found} of {len(hz)} modes, worst frequency "
            f"{100 * error:.4f} %"
        )
        rows.append((n_response, seconds, peak, found))
    first, last = rows[0], rows[-1]
    return {
        "responses": last[0],
        "lines": n_line,
        "modes_found": last[3],
        "modes": n_mode,
        "seconds": round(last[1], 1),
        "time_growth": round(last[1] / first[1] / (last[0] / first[0]), 2),
        "peak_gb": round(last[2], 2),
        "memory_growth": round(last[2] / first[2] / (last[0] / first[0]), 2),
    }


def beside_sdypy(quick: bool) -> dict[str, Any]:
    """Accuracy and time of both on one single-reference survey."""
    frfs, hz, zeta = survey(20 if quick else 60, 1, 2000, 12, 0.01)
    ours, seconds = _best(lambda: identify(frfs))
    result: dict[str, Any] = {"single_reference_seconds": round(seconds, 2)}

    def errors(f: np.ndarray, z: np.ndarray) -> tuple[float, float]:
        off_f, off_z = np.abs(f / hz - 1), np.abs(z / zeta - 1)
        return float(np.sqrt(np.mean(off_f**2))), float(np.sqrt(np.mean(off_z**2)))

    if len(ours.modes) == len(hz):
        f, z = errors(ours.modes.frequencies_hz, ours.modes.damping)
        result |= {"frequency_rms": f, "damping_rms": z}
        _say(f"trueup    {seconds:6.2f} s, frequency rms {f:.2e}, damping rms {z:.2e}")
    try:
        from sdypy import EMA
    except ImportError:
        _say("sdypy-EMA is not installed: no comparison")
        return result

    def theirs() -> Any:
        model = EMA.Model(
            frfs.values[:, 0],
            frfs.frequencies_hz,
            lower=_BAND[0],
            upper=_BAND[1],
            pol_order_high=60,
        )
        model.get_poles(method="lscf", show_progress=False)
        model.select_closest_poles(list(hz), f_window=5)
        model.get_constants()
        return model

    model, seconds = _best(theirs)
    f, z = errors(np.array(model.nat_freq), np.array(model.nat_xi))
    _say(f"sdypy-EMA {seconds:6.2f} s, frequency rms {f:.2e}, damping rms {z:.2e}")
    return result | {
        "sdypy_seconds": round(seconds, 2),
        "sdypy_frequency_rms": f,
        "sdypy_damping_rms": z,
        "sdypy_time_over_ours": round(seconds / result["single_reference_seconds"], 2),
        "sdypy_frequency_error_over_ours": round(f / result.get("frequency_rms", np.nan), 1),
        "sdypy_damping_error_over_ours": round(z / result.get("damping_rms", np.nan), 1),
    }


def _best(run: Callable[[], Any]) -> tuple[Any, float]:
    """Return the outcome of the last of three runs, and the shortest time."""
    times = []
    for _ in range(3):
        since = time.perf_counter()
        outcome = run()
        times.append(time.perf_counter() - since)
    return outcome, min(times)


def main() -> None:
    """Run and print."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--quick", action="store_true")
    quick = parser.parse_args().quick
    sys.stdout.write(json.dumps(growth(quick) | beside_sdypy(quick)) + "\n")


if __name__ == "__main__":
    main()
