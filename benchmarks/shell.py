"""A free barrel shell as a Nastran deck, any size, for the benchmarks."""

from __future__ import annotations

import tempfile
from pathlib import Path

import numpy as np

from trueup.adapters.nastran import build_model, parse_parameter, read_deck
from trueup.core.data.parametric_model import Model

SIZES = {18_000: (60, 50), 120_000: (200, 100), 1_000_000: (500, 334)}
"""Grids around and along, by degrees of freedom."""


def deck_text(around: int, along: int, panels: int = 1) -> str:
    """Bulk of a barrel of CQUAD4, 0.5 m wide and 0.6 m long, in millimetres, tonnes, newtons.

    Its elements share `panels` properties, in bands along the axis, each 2 mm of aluminium.
    """
    angle = 2.0 * np.pi * np.arange(around) / around
    z = np.linspace(0.0, 600.0, along)
    radius = 250.0 * (1.0 + 0.2 * np.sin(np.pi * z / 600.0))
    x = np.outer(radius, np.cos(angle)).ravel()
    y = np.outer(radius, np.sin(angle)).ravel()
    ids = np.arange(1, around * along + 1).reshape(along, around)
    corner = np.stack([ids[:-1], np.roll(ids, -1, 1)[:-1], np.roll(ids, -1, 1)[1:], ids[1:]], -1)
    band = np.repeat(np.arange(along - 1) * panels // (along - 1) + 1, around)
    lines = ["SOL 103", "CEND", "METHOD = 1", "BEGIN BULK", "EIGRL,1,,,36"]
    lines += [f"MAT1,{k},7.+4,,.33,2.7-9" for k in range(1, panels + 1)]
    lines += [f"PSHELL,{k},{k},2.,{k},,{k}" for k in range(1, panels + 1)]
    points = zip(ids.ravel(), x, y, np.repeat(z, around), strict=True)
    lines += [f"GRID*,{i},,{a:.9f},{b:.9f}\n*,{c:.9f}" for i, a, b, c in points]
    quads = zip(range(1, len(band) + 1), band, *corner.reshape(-1, 4).T, strict=True)
    lines += [f"CQUAD4,{e},{p},{a},{b},{c},{d}" for e, p, a, b, c, d in quads]
    return "\n".join([*lines, "ENDDATA", ""])


def shell_model(around: int, along: int, panels: int = 1, parameters: int = 0) -> Model:
    """Read and assemble the barrel; the moduli of its first panels may be parameters."""
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "barrel.bdf"
        path.write_text(deck_text(around, along, panels))
        wanted = [parse_parameter(f"MAT1 {k} E") for k in range(1, parameters + 1)]
        return build_model(read_deck(path), wanted)
