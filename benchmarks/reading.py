"""A shell deck of 200,000 cards read beside pyNastran in one run; ends with one line of JSON.

``python benchmarks/reading.py [SIDE]``: SIDE grids a side (316). Times are of the processor, the
best of three.
"""

from __future__ import annotations

import json
import sys
import tempfile
import time
from collections.abc import Callable
from pathlib import Path

from trueup.adapters.nastran import read_deck


def plate(path: Path, side: int) -> int:
    """Write a square plate of shells in fields of eight columns; return its number of cards."""
    lines = ["SOL 103", "CEND", "METHOD = 1", "BEGIN BULK", f"EIGRL   {1:<8}{'':16}{10:8}"]
    for k in range(side * side):
        row, column = divmod(k, side)
        lines.append(f"GRID    {k + 1:<8d}        {column:<8.2f}{row:<8.2f}{0.0:<8.1f}")
    corners = [k + 1 for k in range(side * (side - 1)) if (k + 1) % side]
    for number, a in enumerate(corners, start=1):
        grids = "".join(f"{g:<8d}" for g in (a, a + 1, a + side + 1, a + side))
        lines.append(f"CQUAD4  {number:<8d}{1:<8d}{grids}")
    lines += ["PSHELL,1,1,1.,1,,1", "MAT1,1,2.1+5,,.3,7.85-9", "ENDDATA", ""]
    path.write_text("\n".join(lines))
    return side * side + len(corners) + 3


def seconds(work: Callable[[], object]) -> float:
    """Best of three."""
    taken = []
    for _ in range(3):
        start = time.process_time()
        work()
        taken.append(time.process_time() - start)
    return min(taken)


def main() -> None:
    """Print the figures."""
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "plate.bdf"
        cards = plate(path, int(sys.argv[1]) if len(sys.argv) > 1 else 316)
        found = {"cards": cards, "read_seconds": seconds(lambda: read_deck(path))}
        try:
            from pyNastran.bdf.bdf import read_bdf
        except ImportError:
            print(json.dumps(found))  # noqa: T201
            return
        theirs = seconds(lambda: read_bdf(str(path), xref=False, debug=None))
    print(json.dumps({**found, "read_over_pynastran": found["read_seconds"] / theirs}))  # noqa: T201


if __name__ == "__main__":
    main()
