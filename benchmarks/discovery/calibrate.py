"""``python -m benchmarks.discovery.calibrate FOLDER``: what share of findings is right.

The figures of `trueup.core.discovery.narrative.build_findings` that turn a posterior into a
confidence: by how much less than their posterior findings are right, of those that are claimed,
those that are proposed and the others, from a folder of cases with ``truth.json`` and
``result.json``.
"""

from __future__ import annotations

import argparse
import json
import sys
from collections.abc import Iterable
from pathlib import Path
from typing import Any

from .score import score

_FAULT = "sensor_"


def findings(places: Iterable[Path]) -> list[tuple[str, float, bool]]:
    """Return of every finding of the model side how it is told, its posterior, if it is right."""
    out = []
    for place in places:
        result: dict[str, Any] = json.loads((place / "result.json").read_text())
        if result is None or "judgement" not in result:
            continue
        told = result["verdict"] if result["verdict"] == "effect" else "other"
        if result["judgement"]["proposal"]:
            told = "proposal"
        as_claimed = {**result, "verdict": "effect"}
        s = score(json.loads((place / "truth.json").read_text()), as_claimed)
        posterior = result["judgement"]["posterior"]
        named = [n for n in s.named if n.found and not n.found.startswith(_FAULT)]
        out += [(told, posterior, n.found == n.kind and n.placed) for n in named]
        out += [(told, posterior, False) for k, _ in s.false_alarms if not k.startswith(_FAULT)]
    return out


def shares(known: list[tuple[str, float, bool]]) -> dict[str, tuple[int, int, float]]:
    """Return how many findings of each way of telling there are, are right, and the share."""
    out = {}
    for way in sorted({told for told, _, _ in known}):
        own = [(posterior, right) for told, posterior, right in known if told == way]
        right = sum(r for _, r in own)
        out[way] = len(own), right, round(min(right / sum(p for p, _ in own), 1.0), 3)
    return out


def main() -> int:
    """Print the figures and how many findings they come of."""
    a = argparse.ArgumentParser(
        prog="python -m benchmarks.discovery.calibrate", description=__doc__
    )
    a.add_argument("folder", type=Path)
    a.add_argument("--every", type=int, default=1, help="only every so many, of the sorted names")
    a.add_argument("--start", type=int, default=0, help="from which one on")
    o = a.parse_args()
    places = sorted(p.parent for p in o.folder.rglob("result.json"))
    known = findings(p for p in places[o.start :: o.every] if (p / "truth.json").exists())
    if not known:
        sys.stderr.write("no folder holds a truth.json beside a result.json with a judgement\n")
        return 1
    sys.stdout.write(json.dumps(shares(known)) + "\n")
    return 0


if __name__ == "__main__":
    sys.exit(main())
