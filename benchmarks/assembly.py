"""Assembly with derivatives beside one eigensolution, in one run; ends with one line of JSON.

``python benchmarks/assembly.py [--quick] [--wide]``: 100,000 CQUAD4 in twenty properties are
read, assembled with the thickness of each property free to move between half and twice its value
(``--wide``: a fifth and five times), and the derivatives of stiffness and mass by all twenty
formed; then 36 modes of the same model are found. ``--quick`` takes 10,000 elements.
"""

from __future__ import annotations

import argparse
import json
import sys
import tempfile
import time
from pathlib import Path

import numpy as np
from shell import deck_text

from trueup.adapters.nastran import build_model, parse_parameter, read_deck
from trueup.core.eigen.normal_modes import solve

_MODES = 36
_PROPERTIES = 20


def main() -> None:
    """Run and print."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--quick", action="store_true")
    parser.add_argument("--wide", action="store_true")
    chosen = parser.parse_args()
    around, along = (200, 51) if chosen.quick else (500, 201)
    bounds = [0.2, 5.0] if chosen.wide else [0.5, 2.0]
    seconds = {}

    def clock(what: str, since: float) -> float:
        seconds[what] = round(time.perf_counter() - since, 2)
        sys.stderr.write(f"{what:<30}{seconds[what]:8.2f} s\n")
        return time.perf_counter()

    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "barrel.bdf"
        path.write_text(deck_text(around, along, _PROPERTIES))
        start = time.perf_counter()
        deck = read_deck(path)
        start = clock("read", start)
        build_model(deck)
        start = clock("assemble", start)
        names = [f"PSHELL {k} T {bounds}" for k in range(1, _PROPERTIES + 1)]
        model = build_model(deck, [parse_parameter(name) for name in names])
        start = clock("assemble with parameters", start)
        ones = np.ones(_PROPERTIES)
        for k in range(_PROPERTIES):
            model.dK(k, ones)
            model.dM(k, ones)
        start = clock("derivatives", start)
        solve(model, _MODES)
        clock("eigensolution", start)
    ours = seconds["assemble with parameters"] + seconds["derivatives"]
    result = {
        "benchmark": "assembly",
        "elements": around * (along - 1),
        "properties": _PROPERTIES,
        "bounds": bounds,
        "dofs": model.n_free,
        "terms": len(model.stiffness),
        "assembly_over_eigensolution": round(ours / seconds["eigensolution"], 3),
        "seconds": seconds,
    }
    sys.stdout.write(json.dumps(result) + "\n")


if __name__ == "__main__":
    main()
