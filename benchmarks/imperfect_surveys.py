"""Identification of surveys that are measured, not simulated: what goes wrong in each, counted.

    python benchmarks/imperfect_surveys.py [--first 1000] [--surveys 13] [--kind NAME]

Every survey has 40 points, 3 references, 8 modes between 20 and 180 Hz of 0.1 to 0.9 % damping,
two of them a close pair (0.5 to 1 %), lines of 0.125 Hz, and noise of 0.5 %. Besides, by kind:

- scatter: each point has frequencies of its own, standard deviation 0.04 %
- roving_mass: a sensor's mass lowers a frequency where the mode moves, by up to about 0.5 %
- merged_runs: three runs whose frequencies differ by 0.1 % and whose damping by 20 %
- windows: lines blurred as by a Hann window
- nonlinear: frequencies fall by up to 1 % and damping rises with the force at a point
- flipped: one function has the wrong sign
- coherent_noise: noise that all points of a reference share, 2 % of the level
- machine: lines of 50 Hz and its harmonics and of a machine at 29.3 Hz, 5 % of the level, one shape
  each and another phase before each reference
- all: scatter, roving mass, windows and coherent noise together

A mode counts as found within 0.5 %; as doubled where another found one stands there already; as
invented elsewhere. Ends with one line of JSON. Seeds from 1000 are those of docs/validation.md and
were not looked at before.
"""

from __future__ import annotations

import argparse
import json
import sys
import time

import numpy as np
from scipy.optimize import linear_sum_assignment

from trueup.core.data.dofs import Dofs
from trueup.core.data.frfs import Frfs
from trueup.core.identification.identify import identify
from trueup.core.identification.survey.modal_synthesis import poles_from

_POINTS, _REFERENCES, _MODES = 40, 3, 8
_BAND = (20.0, 180.0)
_WITHIN = 0.005
KINDS = (
    "scatter", "roving_mass", "merged_runs", "windows", "nonlinear", "flipped", "coherent_noise",
    "machine", "all",
)  # fmt: skip


def survey(seed: int, kind: str) -> tuple[Frfs, np.ndarray]:
    """Return a survey that is imperfect in one way (or all), and the frequencies in its band."""
    rng = np.random.default_rng(seed)
    hz, zeta = _modes(rng)
    shapes = rng.standard_normal((_POINTS, len(hz)))
    driven = rng.choice(_POINTS, _REFERENCES, replace=False)
    of_point, damping = np.tile(hz, (_POINTS, 1)), np.tile(zeta, (_POINTS, 1))
    if kind in ("scatter", "all"):
        of_point *= 1.0 + 4e-4 * rng.standard_normal(of_point.shape)
    if kind in ("roving_mass", "all"):
        of_point *= 1.0 - 0.5e-3 * shapes**2
    if kind == "merged_runs":
        run = np.arange(_POINTS) * 3 // _POINTS
        of_point *= (1.0 + 1e-3 * rng.standard_normal((3, len(hz))))[run]
        damping *= rng.uniform(0.8, 1.2, (3, len(hz)))[run]
    if kind == "nonlinear":
        force = rng.uniform(0.0, 1.0, (_POINTS, 1)) * np.abs(shapes) / np.abs(shapes).max(axis=0)
        of_point *= 1.0 - 0.01 * force
        damping *= 1.0 + force
    f = np.arange(_BAND[0], _BAND[1], 0.125)
    values = _responses(f, of_point, damping, shapes, driven)
    if kind in ("windows", "all"):
        values = np.apply_along_axis(
            np.convolve, 2, values, np.array([1.0, 4.0, 1.0]) / 6.0, "same"
        )
        f, values = f[1:-1], values[..., 1:-1]
    rms = np.sqrt(np.mean(np.abs(values) ** 2, axis=2, keepdims=True))
    values = values + 0.005 * rms * _noise(rng, values.shape)
    if kind in ("coherent_noise", "all"):
        shared = _noise(rng, (1, _REFERENCES, len(f)))
        kernel = np.hanning(9) / np.linalg.norm(np.hanning(9))
        shared = np.apply_along_axis(np.convolve, 2, shared, kernel, "same")
        values = values + 0.02 * rms * rng.standard_normal((_POINTS, 1, 1)) * shared
    if kind == "machine":
        for line in (50.0, 100.0, 150.0, 29.3, 58.6, 117.2):
            shape = rng.standard_normal((_POINTS, 1, 1)) * np.exp(
                2j * np.pi * rng.uniform(size=(1, _REFERENCES, 1))
            )
            values = values + 0.05 * rms * shape * np.exp(-(((f - line) / 0.125) ** 2))
    if kind == "flipped":
        values[rng.integers(_POINTS), rng.integers(_REFERENCES)] *= -1.0
    dofs = Dofs(np.arange(1, _POINTS + 1), np.full(_POINTS, 3))
    frfs = Frfs(f, dofs, dofs.take(driven), values, "acceleration", f"{kind} {seed}")
    return frfs, np.sort(hz[:_MODES])


def _modes(rng: np.random.Generator) -> tuple[np.ndarray, np.ndarray]:
    """Frequencies and damping: those of the band, two of them close, then one on either side."""
    low, high = _BAND
    step = (high - low) / (_MODES - 1)
    hz = low + step * (np.arange(_MODES - 1) + 0.5 + rng.uniform(-0.35, 0.35, _MODES - 1))
    close = hz[rng.integers(_MODES - 1)] * (1.0 + rng.uniform(0.005, 0.01))
    hz = np.concatenate([hz, [close, 0.5 * low, 1.2 * high]])
    return hz, rng.uniform(0.001, 0.009, len(hz))


def _responses(
    f: np.ndarray, hz: np.ndarray, zeta: np.ndarray, shapes: np.ndarray, driven: np.ndarray
) -> np.ndarray:
    """Return accelerances whose modes each point sees at frequencies and damping of its own."""
    s = 2j * np.pi * f
    values = np.zeros((_POINTS, len(driven), len(f)), complex)
    for o in range(_POINTS):
        poles = poles_from(hz[o], zeta[o])
        residues = shapes[driven] * shapes[o] / (2j * poles.imag)
        near = residues @ (s**2 / (s - poles[:, None]))
        values[o] = near + residues.conj() @ (s**2 / (s - poles.conj()[:, None]))
    return values


def _noise(rng: np.random.Generator, shape: tuple[int, ...]) -> np.ndarray:
    return (rng.standard_normal(shape) + 1j * rng.standard_normal(shape)) / np.sqrt(2.0)


def count(truth: np.ndarray, found: np.ndarray, marked: np.ndarray) -> dict[str, int]:
    """Count modes found, missed, doubled, invented, and of the latter two those with a remark."""
    apart = np.abs(found[:, None] / truth - 1.0)
    rows, columns = linear_sum_assignment(np.minimum(apart, _WITHIN))
    matched = rows[apart[rows, columns] < _WITHIN]
    spare = np.setdiff1d(np.arange(len(found)), matched)
    doubled = np.array([apart[k].min() < _WITHIN for k in spare], bool)
    return {
        "found": len(matched),
        "missed": len(truth) - len(matched),
        "doubled": int(doubled.sum()),
        "invented": int((~doubled).sum()),
        "remarked": int(marked[spare].sum()),
    }


def main() -> None:
    """Run and print."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--first", type=int, default=1000)
    parser.add_argument("--surveys", type=int, default=13)
    parser.add_argument("--kind", choices=KINDS, action="append")
    asked = parser.parse_args()
    table: dict[str, dict[str, float]] = {}
    for kind in asked.kind or KINDS:
        total: dict[str, float] = {}
        since = time.process_time()
        for seed in range(asked.first, asked.first + asked.surveys):
            frfs, truth = survey(seed, kind)
            result = identify(frfs)
            marked = np.array([bool(r) for r in result.remarks], bool)
            for key, value in count(truth, result.modes.frequencies_hz, marked).items():
                total[key] = total.get(key, 0) + value
        total["seconds"] = round((time.process_time() - since) / asked.surveys, 1)
        sys.stderr.write(f"{kind:15s} {total}\n")
        table[kind] = total
    sys.stdout.write(json.dumps(table) + "\n")


if __name__ == "__main__":
    main()
