"""Print mode shapes (dataset 55)."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping

import numpy as np

from ...core.arrays import Floats
from ...core.modes import Modes
from .printing import dataset, text_line, tight
from .vectors import node_vectors


def mode_datasets(modes: Modes, systems: Mapping[int, Floats]) -> Iterator[bytes]:
    """Print each mode as a dataset 55; nodes in `systems` have displacement axes of their own.

    Complex modes are written by their eigenvalue (analysis type 3), or as type 2 with complex
    data where modal masses are known, which type 3 has no place for.
    """
    nodes, vectors = node_vectors(modes.dofs, modes.shapes)
    for row, node in enumerate(nodes.tolist()):
        if node in systems:
            for half in range(vectors.shape[1] // 3):
                part = slice(3 * half, 3 * half + 3)
                vectors[row, part] = systems[node] @ vectors[row, part]
    width = vectors.shape[1]
    n_value = width * (2 if modes.is_complex else 1)
    lines = "".join("%13.5E" * min(6, n_value - k) + "\n" for k in range(0, n_value, 6))
    form = "".join(f"{node:10d}\n{lines}" for node in nodes.tolist())
    for k in range(len(modes)):
        values = np.ascontiguousarray(vectors[:, :, k])
        if modes.is_complex:
            values = values.view(np.float64)
        kind, head = _modal_lines(modes, k)
        ids = (modes.source or "NONE", "NONE", "NONE", f"mode {k + 1}",
               f"{modes.frequencies_hz[k]:.6f} Hz")  # fmt: skip
        yield dataset(
            55,
            *(text_line(said) for said in ids),
            b"%10d%10d%10d%10d%10d%10d\n"
            % (1, kind, 2 if width == 3 else 3, 8, 5 if modes.is_complex else 2, width),
            *head,
            (form % tuple(values.ravel().tolist())).encode("ascii"),
        )


def _modal_lines(modes: Modes, k: int) -> tuple[int, tuple[bytes, bytes]]:
    """Analysis type and records 7 and 8 of a mode."""
    frequency, damping = float(modes.frequencies_hz[k]), float(modes.damping[k])
    mass = float(modes.generalized_mass[k])
    known = [0.0 if math.isnan(v) else v for v in (damping, mass)]
    if modes.is_complex and math.isnan(mass) and abs(known[0]) < 1.0:
        omega = 2.0 * math.pi * frequency
        pole = (-known[0] * omega, omega * math.sqrt(1.0 - known[0] ** 2))
        reals = (*pole, 0.0, 0.0, 0.0, 0.0)
        return 3, (_integers(2, 6, 1, k + 1), b"".join(map(tight, reals)) + b"\n")
    reals4 = (frequency, known[1], known[0], 0.0)
    return 2, (_integers(2, 4, 1, k + 1), b"".join(map(tight, reals4)) + b"\n")


def _integers(*numbers: int) -> bytes:
    return b"".join(b"%10d" % n for n in numbers) + b"\n"
