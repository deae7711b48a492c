"""``python -m benchmarks.discovery.calibrate FOLDER``: what share of findings is right.

Fits the two figures of `trueup.core.discovery.narrative.build_findings` that turn a posterior
into a confidence, by maximum likelihood over findings whose truth is known (Platt 1999 with the
posterior and the noise that is left as features), from a folder of cases with ``truth.json`` and
``result.json``.
"""

from __future__ import annotations

import argparse
import json
import sys
from collections.abc import Iterable
from pathlib import Path
from typing import Any

import numpy as np
from scipy.optimize import minimize

from .score import score

_FAULT = "sensor_"


def findings(places: Iterable[Path]) -> list[tuple[float, float, bool]]:
    """Return posterior, noise scale and whether it is right of every finding of the model side."""
    out = []
    for place in places:
        result: dict[str, Any] = json.loads((place / "result.json").read_text())
        if result is None or "judgement" not in result:
            continue
        s = score(json.loads((place / "truth.json").read_text()), result)
        posterior, scale = result["judgement"]["posterior"], result["noise_scale"]
        named = [n for n in s.named if n.found and not n.found.startswith(_FAULT)]
        out += [(posterior, scale, n.found == n.kind and n.placed) for n in named]
        out += [(posterior, scale, False) for k, _ in s.false_alarms if not k.startswith(_FAULT)]
    return out


def fitted(known: list[tuple[float, float, bool]]) -> tuple[float, float]:
    """Return (a, b) of ``posterior a / (1 + b (scale − 1))`` that make the outcomes likeliest."""
    posterior, scale, right = (np.array(column, dtype=float) for column in zip(*known, strict=True))

    def unlikely(x: np.ndarray[Any, Any]) -> float:
        a, b = 1.0 / (1.0 + np.exp(-x[0])), np.exp(x[1])
        p = np.clip(posterior * a / (1.0 + b * (scale - 1.0)), 1e-3, 1.0 - 1e-3)
        return float(-np.sum(right * np.log(p) + (1.0 - right) * np.log(1.0 - p)))

    best = minimize(unlikely, np.array([2.0, -3.0]), method="Nelder-Mead").x
    return float(1.0 / (1.0 + np.exp(-best[0]))), float(np.exp(best[1]))


def main() -> int:
    """Print the two figures and how many findings they come of."""
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
    share, fall = fitted(known)
    sys.stdout.write(
        json.dumps(
            {
                "findings": len(known),
                "right": sum(r for _, _, r in known),
                "share": round(share, 3),
                "fall_with_noise": round(fall, 4),
            }
        )
        + "\n"
    )
    return 0


if __name__ == "__main__":
    sys.exit(main())
