"""An update beside one eigensolution of the same model, in one run; ends with one line of JSON.

``python benchmarks/updating.py [--quick] [--dofs N] [--no-scipy] [--growth]``: twenty moduli of a
free barrel shell of 120,000 degrees of freedom are moved to a test of 36 modes at 200 sensors, made
by the same model with other moduli and 0.2 % of noise; ten iterations on frequencies and shapes,
the check at full order included. Ratios are of the time that passes and of processor time, which
other work on the machine disturbs less. ``--quick`` runs each part once, otherwise the two take
turns three times and the median ratio counts: one core gives a tenth more or less from minute to
minute; ``--dofs`` goes up to 1,000,000; ``--no-scipy`` leaves out scipy's
``eigsh``, which takes minutes; ``--growth`` tells how the cost grows with parameters and modes, at
18,000 degrees of freedom.
"""

from __future__ import annotations

import argparse
import json
import sys
import time
from collections.abc import Callable

import numpy as np
import scipy.sparse as sp
import scipy.sparse.linalg as spla
from eigensolution import peak_gib
from shell import SIZES, shell_model

from trueup.core.arrays import Floats
from trueup.core.correlation.criteria import Criteria
from trueup.core.data.parametric_model import Model
from trueup.core.eigen.normal_modes import Eigensolution, solve
from trueup.core.updating.update import Stage, Target, update

_MODES = 36
_PARAMETERS = 20
_ITERATIONS = 10
_SENSORS = 200
_SIGMA = -((2.0 * np.pi * 20.0) ** 2)


def measured(model: Model, seed: int = 0, modes: int = _MODES) -> Target:
    """Return a test of the model with other factors."""
    rng = np.random.default_rng(seed)
    truth = rng.uniform(0.8, 1.25, len(model.parameters))
    solution = solve(model, modes, p=truth)
    grids = rng.choice(len(model.geometry.xyz), _SENSORS // 2, replace=False)
    rows = model.expansion[np.concatenate([6 * grids, 6 * grids + 1])]
    elastic = slice(solution.rigid_body_modes, None)
    hz = solution.frequencies_hz[elastic] * (1.0 + 0.002 * rng.standard_normal(modes - 6))
    shapes = np.asarray(rows @ solution.vectors[:, elastic])
    shapes = shapes + 0.01 * np.abs(shapes).max(axis=0) * rng.standard_normal(shapes.shape)
    return Target(hz, shapes, sp.csr_matrix(rows))


def clocked(what: str, work: Callable[[], object]) -> tuple[Floats, object]:
    """Time one piece of work: seconds that pass, and of processor time, (2,)."""
    began = np.array([time.perf_counter(), time.process_time()])
    outcome = work()
    seconds = np.array([time.perf_counter(), time.process_time()]) - began
    sys.stderr.write(f"{what:<28}{seconds[0]:8.2f} s, of the processor {seconds[1]:8.2f} s\n")
    return seconds, outcome


def cost(parameters: int, modes: int, dofs: int = 18_000) -> float:
    """Return the processor time of an update over that of an eigensolution."""
    model = shell_model(*SIZES[dofs], panels=parameters, parameters=parameters)
    target = measured(model, modes=modes)
    name = f"{parameters} parameters, {modes} modes"
    one, _ = clocked(f"{name}: solution", lambda: solve(model, modes))
    stage = Stage(tuple(range(parameters)), "both", _ITERATIONS)
    whole, _ = clocked(
        f"{name}: update",
        lambda: update(model, target, [stage], Criteria(), n_modes=modes, tolerance=1e-9),
    )
    return round(float(whole[1] / one[1]), 2)


def main() -> None:
    """Run and print."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--quick", action="store_true")
    parser.add_argument("--no-scipy", action="store_true")
    parser.add_argument("--growth", action="store_true")
    parser.add_argument("--dofs", type=int, default=120_000, choices=sorted(SIZES))
    chosen = parser.parse_args()
    model = shell_model(*SIZES[chosen.dofs], panels=_PARAMETERS, parameters=_PARAMETERS)
    target = measured(model)
    stage = Stage(tuple(range(_PARAMETERS)), "both", _ITERATIONS)
    solutions, updates = [], []
    for _ in range(1 if chosen.quick else 3):
        solutions.append(clocked("eigensolution", lambda: solve(model, _MODES)))
        updates.append(
            clocked(
                "update",
                lambda: update(model, target, [stage], Criteria(), n_modes=_MODES, tolerance=1e-9),
            )
        )
    ratios = np.array([u / s for (s, _), (u, _) in zip(solutions, updates, strict=True)])
    done = updates[0][1]
    result = {
        "benchmark": "updating",
        "update_over_eigensolution": round(float(np.median(ratios[:, 0])), 2),
        "by_processor_time": round(float(np.median(ratios[:, 1])), 2),
        "each_by_processor_time": [round(float(r), 2) for r in ratios[:, 1]],
        "peak_gib": round(peak_gib(), 1),
        "dofs": model.n_free,
        "parameters": _PARAMETERS,
        "iterations": len(done.history) - 1,
        "eigensolutions": done.eigensolutions,
        "pairs": len(done.after.correlation.pairs),
        "mean_abs_deviation_percent": [
            round(s.correlation.mean_abs_deviation_percent or np.nan, 3)
            for s in (done.before, done.after)
        ],
        "stopped": done.stopped.sentence,
    }
    if chosen.growth:
        sizes = ((5, _MODES), (10, _MODES), (20, _MODES), (40, _MODES), (20, 18))
        result["growth"] = {f"{k} parameters, {m} modes": cost(k, m) for k, m in sizes}
    if not chosen.no_scipy:
        result["scipy_over_ours"] = round(_scipy(model, solutions[0][1]) / solutions[0][0][0], 2)
    sys.stdout.write(json.dumps(result) + "\n")


def _scipy(model: Model, ours: Eigensolution) -> float:
    K, M = model.K(), model.M()
    seconds, (values, _) = clocked("scipy", lambda: spla.eigsh(K, _MODES, M, sigma=_SIGMA))
    elastic = slice(ours.rigid_body_modes, None)
    np.testing.assert_allclose(np.sort(values)[elastic], ours.eigenvalues[elastic], rtol=1e-5)
    return float(seconds[0])


if __name__ == "__main__":
    main()
