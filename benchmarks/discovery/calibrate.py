"""``python -m benchmarks.discovery.calibrate FOLDER``: how often what is told is right.

The shares that stand behind confidences (`trueup.core.discovery.narrative`): of effects that are
claimed, proposed or told in doubt, of answers without any, of faults of sensors, from a folder of
cases with ``truth.json`` and ``result.json``. The share that the next one is expected to have is
(right + 1) / (number + 2): the rule of succession.
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
_LIKE_MODEL = ("sensor_gain", "sensor_axis")


def told(places: Iterable[Path]) -> list[tuple[str, float, bool]]:
    """Return of all that is told the way it is told, how sure it is said to be, if it is right."""
    out = []
    for place in places:
        result: dict[str, Any] = json.loads((place / "result.json").read_text())
        if result is None or "judgement" not in result:
            continue
        truth = json.loads((place / "truth.json").read_text())
        judgement, every = result["judgement"], result["findings"]
        way = result["verdict"] if result["verdict"] == "effect" else "other"
        way = "proposal" if judgement["proposal"] else way
        if result["verdict"] != "undecided" and all(f["side"] == "test" for f in every):
            expected = score(truth, result).expected.split("/")
            right = not truth["effects"] or "effect" not in expected
            out.append(("nothing", float(judgement["posterior"]), right))
        s = score(truth, {**result, "verdict": "effect"})
        known = [
            (n.found, n.confidence, n.found == n.kind and n.placed) for n in s.named if n.found
        ]
        for kind, said, right in [*known, *((k, c, False) for k, c in s.false_alarms)]:
            fault = "fault like an error" if kind in _LIKE_MODEL else "fault"
            out.append((fault if kind.startswith(_FAULT) else way, float(said or 0.0), right))
    return out


def shares(known: list[tuple[str, float, bool]]) -> dict[str, dict[str, float]]:
    """Return of each way of telling the number, the mean said, those right, the share expected."""
    out = {}
    for way in sorted({way for way, _, _ in known}):
        said, right = zip(*((p, r) for w, p, r in known if w == way), strict=True)
        n, hits = len(said), sum(right)
        out[way] = {
            "number": n,
            "said": round(sum(said) / n, 3),
            "right": hits,
            "share": round((hits + 1) / (n + 2), 3),
        }
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
    known = told(p for p in places[o.start :: o.every] if (p / "truth.json").exists())
    if not known:
        sys.stderr.write("no folder holds a truth.json beside a result.json with a judgement\n")
        return 1
    sys.stdout.write(json.dumps(shares(known)) + "\n")
    return 0


if __name__ == "__main__":
    sys.exit(main())
