"""The fixture whose truth is masses on four groups of rims, made anew; ends with one line of JSON.

``python -m benchmarks.ported_duct [--into DIR]``: the test of ``fixtures/ports`` is solved by
CalculiX (``ccx``) with quadratic shells and solid-like bars on the deck's own division, so its
nodes stand twice as dense. Eight ports in pairs carry equipment that the deck does not know, as the
density of their rims, and both flanges are stiffer than the deck says.
"""

from __future__ import annotations

import argparse
import json
import tempfile
from collections.abc import Callable
from pathlib import Path

import numpy as np

from .discovery import calculix, deck, measure
from .discovery.mesh import Bar, Floats, Line, Mesh, Patch, Structure, mesh
from .discovery.structures import ALUMINIUM
from .discovery.truth import Field, Truth

FLANGES = {11: 1.6, 12: 1.3}
"""Stiffness of front and rear flange over the deck's."""
RIMS = {21: 2.5, 22: 1.8, 23: 3.5, 24: 1.4}
"""Density of the rims of a group over the deck's."""
PORTS = {
    21: ((3, 3), (12, 3)),
    22: ((22, 11), (30, 11)),
    23: ((40, 4), (48, 4)),
    24: ((57, 10), (66, 10)),
}
"""First element around and along of the ports of a group, each 4 by 2 elements."""
AROUND, ALONG, RADIUS, LENGTH = 72, 16, 450.0, 800.0


def _point(u: Floats, v: Floats) -> Floats:
    a = 2.0 * np.pi * u
    return np.stack([RADIUS * np.cos(a), RADIUS * np.sin(a), LENGTH * v], axis=-1)


def _line(i: int, j: int, di: int, dj: int) -> Callable[[Floats], Floats]:
    return lambda t: _point((i + di * t) / AROUND, (j + dj * t) / ALONG)


def _rim(group: int, i: int, j: int) -> list[Line]:
    x, y, _ = _point(np.array((i + 2) / AROUND), np.array(0.0))
    edges = ((i, j, 4, 0), (i, j + 2, 4, 0), (i, j, 0, 2), (i + 4, j, 0, 2))
    return [Line(group, _line(*e), max(e[2:]), (float(x), float(y), 0.0)) for e in edges]


def structure() -> Structure:
    """Return the duct as its deck has it."""
    cut = {(i + a, j + b) for g in PORTS.values() for i, j in g for a in range(4) for b in range(2)}
    ends = ((11, 0), (12, ALONG))
    flanges = [Line(g, _line(0, j, AROUND, 0), AROUND, (0, 0, 1)) for g, j in ends]
    rims = [line for g, ports in PORTS.items() for port in ports for line in _rim(g, *port)]
    return Structure(
        "ports",
        "DUCT WITH PORTS",
        LENGTH,
        ALUMINIUM,
        {1: 1.6},
        {11: Bar(14.0, 14.0), 12: Bar(12.0, 12.0), **dict.fromkeys(PORTS, Bar(9.0, 9.0))},
        (Patch(1, _point, AROUND, ALONG, lambda u, v: (int(u * AROUND), int(v * ALONG)) in cut),),
        (*flanges, *rims),
        24,
        sensors=(70, 71),
    )


def truth(fine: Mesh) -> Truth:
    """Return what the deck lacks."""
    density = np.ones(len(fine.quads) + len(fine.bars))
    density[len(fine.quads) :] = [RIMS.get(int(g), 1.0) for g in fine.bar_group]
    return Truth(factors=FLANGES, fields=(Field(density=density),))


def main() -> None:
    """Make deck and test."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--into", type=Path, default=Path("fixtures/ports"))
    into = parser.parse_args().into
    duct, rng = structure(), np.random.default_rng(16)
    coarse, fine = mesh(duct, 1, False), mesh(duct, 1, True)
    deck.write_deck(into, duct, coarse)
    with tempfile.TemporaryDirectory() as cache:
        modes = calculix.solve(duct, fine, truth(fine), Path(cache), duct.modes)
    nodes = measure.sensors(duct, coarse, coarse, rng)
    at = np.argmin(np.linalg.norm(fine.xyz - coarse.xyz[nodes][:, None], axis=2), axis=1)
    test = measure.measure(duct, fine, at, Truth(), modes, measure.Noise(), rng)
    measure.write_test(into / "ports_test.unv", duct, test, np.eye(3), np.zeros(3))
    said = {"flanges": FLANGES, "rims": RIMS, "hz": np.round(modes.hz, 3).tolist()}
    print(json.dumps({"benchmark": "ported_duct", **said}))  # noqa: T201


if __name__ == "__main__":
    main()
