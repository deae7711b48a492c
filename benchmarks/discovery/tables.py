"""``python -m benchmarks.discovery.tables FOLDER``: what a run came to, as tables.

Reads what ``python -m benchmarks.discovery --cache FOLDER`` has left there.
"""

from __future__ import annotations

import argparse
import json
import sys
from collections import Counter
from collections.abc import Callable, Iterable
from pathlib import Path
from typing import Any

from .outcome import Outcome, read
from .score import Named, Score


def _word(n: Named) -> str:
    size = f" x{n.ratio:.2f}" if n.ratio is not None else ""
    away = f" at {100 * n.distance:.0f} %" if n.distance is not None else ""
    sure = f" p={n.confidence:.2f}" if n.confidence is not None else ""
    return f"{n.kind} -> {n.found or 'nothing'}{away}{size}{sure}"


def line(o: Outcome) -> str:
    """Return one row of the table."""
    if o.score is None:
        return f"failed  {o.name:52s} {o.seconds:6.1f} s  {o.note}"
    s = o.score
    mark = "SOLVED" if s.solved else "safe  " if s.safe else "missed"
    words = [_word(n) for n in s.named]
    words += [f"FALSE {kind} p={sure:.2f}" for kind, sure in s.false_alarms]
    if s.verdict not in s.expected.split("/"):
        words.insert(0, f"verdict {s.verdict}, expected {s.expected}")
    return f"{mark}  {o.name:52s} {o.seconds:6.1f} s  " + "; ".join(words)


def confusion(pairs: Iterable[tuple[str, str]], title: str) -> str:
    """Return a table of counts: hidden in rows, named in columns."""
    counts = Counter(pairs)
    rows = sorted({a for a, _ in counts})
    columns = sorted({b for _, b in counts})
    width = max([len(r) for r in rows] + [8])
    out = [f"{title}\n" + " " * (width + 2) + "  ".join(columns)]
    for r in rows:
        cells = [f"{counts[r, c] or '·':>{len(c)}}" for c in columns]
        out.append(f"{r:<{width}}  " + "  ".join(cells))
    return "\n".join(out) + "\n"


def _median(values: Iterable[float]) -> float | None:
    v = sorted(values)
    return v[len(v) // 2] if v else None


def calibration(done: list[Score]) -> list[tuple[str, int, float, float]]:
    """Return rows (band, number, mean confidence, share right) over all findings."""
    points = [
        (n.confidence, n.found == n.kind and n.placed)
        for s in done
        for n in s.named
        if n.confidence is not None
    ]
    points += [(sure, False) for s in done for _, sure in s.false_alarms]
    rows = []
    for low, high in ((0.0, 0.5), (0.5, 0.8), (0.8, 0.95), (0.95, 1.01)):
        band = [(c, r) for c, r in points if low <= c < high]
        if band:
            mean = sum(c for c, _ in band) / len(band)
            right = sum(r for _, r in band) / len(band)
            rows.append((f"{low:.2f}-{min(high, 1.0):.2f}", len(band), mean, right))
    return rows


def summary(outcomes: list[Outcome]) -> dict[str, Any]:
    """Return the figures of a run, plain for JSON."""
    done = [o.score for o in outcomes if o.score is not None]
    quiet = [
        o for o in outcomes if o.scenario in ("nothing", "scatter", "fault") and o.score is not None
    ]
    alarms = [o for o in quiet if o.score is not None and o.score.verdict == "effect"]
    named = [n for s in done for n in s.named]
    effects = [n for n in named if not n.kind.startswith("sensor_")]
    right = [n for n in effects if n.found == n.kind and n.placed]
    inside = [n.in_interval for n in right if n.in_interval is not None]
    by = {
        scenario: [
            sum(bool(o.score and o.score.solved) for o in outcomes if o.scenario == scenario),
            sum(o.scenario == scenario for o in outcomes),
        ]
        for scenario in sorted({o.scenario for o in outcomes})
    }
    return {
        "cases": len(outcomes),
        "failed": len(outcomes) - len(done),
        "solved": sum(s.solved for s in done),
        "solved_or_safely_undecided": sum(s.safe for s in done),
        "by_scenario": by,
        "quiet_cases": len(quiet),
        "false_alarm_rate": round(len(alarms) / len(quiet), 3) if quiet else None,
        "false_findings": sum(len(s.false_alarms) for s in done),
        "effects": len(effects),
        "effects_right_kind_and_place": len(right),
        "median_place_error": _median(n.distance for n in right if n.distance is not None),
        "median_magnitude_ratio": _median(n.ratio for n in right if n.ratio is not None),
        "interval_coverage": round(sum(inside) / len(inside), 3) if inside else None,
        "median_seconds_per_1000_dofs": _median(
            round(1000.0 * o.seconds / o.dofs, 2) for o in outcomes if o.dofs
        ),
        "median_seconds": _median(round(o.seconds, 1) for o in outcomes),
        "worst_seconds": max((round(o.seconds, 1) for o in outcomes), default=None),
    }


def say(text: str) -> None:
    """Print at once."""
    sys.stdout.write(text + "\n")
    sys.stdout.flush()


def hidden(o: Outcome) -> str:
    """Return what a case hides, as a row of the table."""
    if o.scenario in ("nothing", "scatter", "fault", "two effects", "several masses"):
        words = {"scatter": "wrong properties only", "fault": "faults of sensors only"}
        return words.get(o.scenario, o.scenario)
    kinds = [] if o.score is None else [n.kind for n in o.score.named]
    return (kinds[0] if kinds else "effect") + (" and a fault" if "fault" in o.scenario else "")


def worth(outcomes: Iterable[Outcome], row: Callable[[Outcome], str]) -> str:
    """Return a Markdown table of how many were solved, by what `row` says of a case.

    Safe is undecided with the truth among the places told; a false finding is one that is not
    there, besides or instead of what is.
    """
    rows: dict[str, list[Outcome]] = {}
    for o in outcomes:
        rows.setdefault(row(o), []).append(o)
    rows = {**dict(sorted(rows.items())), "all": [o for mine in rows.values() for o in mine]}
    out = ["| hidden | cases | solved | undecided, truth told | missed or wrong | false findings |"]
    out.append("|---|---:|---:|---:|---:|---:|")
    for name, mine in rows.items():
        scores = [o.score for o in mine if o.score is not None]
        solved, safe = sum(s.solved for s in scores), sum(s.safe for s in scores)
        false = sum(len(s.false_alarms) for s in scores)
        counts = (len(mine), solved, safe - solved, len(mine) - safe, false)
        out.append(f"| {name} | " + " | ".join(str(c) for c in counts) + " |")
    return "\n".join(out) + "\n"


def report(outcomes: list[Outcome]) -> None:
    """Print the tables and the line of JSON."""
    say("\n" + worth(outcomes, hidden))
    say(worth(outcomes, lambda o: o.structure))
    done = [x.score for x in outcomes if x.score is not None]
    kinds = [(n.kind, n.found or "nothing") for s in done for n in s.named]
    kinds += [("nothing", kind) for s in done for kind, _ in s.false_alarms]
    say(confusion(kinds, "hidden (rows) and named (columns)"))
    say(confusion([(s.expected, s.verdict) for s in done], "verdict expected (rows) and given"))
    say("confidence  number  mean  right (kind and place)")
    for band, number, mean, right in calibration(done):
        say(f"{band}   {number:6d}  {mean:4.2f}  {right:4.2f}")
    say(json.dumps(summary(outcomes)))


def main() -> int:
    """Print the rows and tables of the cases in a folder."""
    a = argparse.ArgumentParser(prog="python -m benchmarks.discovery.tables", description=__doc__)
    a.add_argument("folder", type=Path)
    a.add_argument("--every", type=int, default=1, help="only every so many, of the sorted names")
    a.add_argument("--start", type=int, default=0, help="from which one on")
    o = a.parse_args()
    places = sorted(p.parent for p in o.folder.rglob("run.json"))[o.start :: o.every]
    outcomes = [read(place) for place in places]
    for one in outcomes:
        say(line(one))
    report(outcomes)
    return 0


if __name__ == "__main__":
    sys.exit(main())
