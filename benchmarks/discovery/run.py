"""``python -m benchmarks.discovery``: generate cases, run `trueup discover` on them, tabulate."""

from __future__ import annotations

import argparse
import json
import os
import resource
import subprocess
import sys
import tempfile
from collections import Counter
from collections.abc import Iterable
from concurrent.futures import ProcessPoolExecutor, as_completed
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from .calculix import CalculixError
from .case import make, plan
from .score import Named, Score, score


@dataclass(frozen=True)
class Outcome:
    """A case and what became of it; `score` is missing where something failed (`note`)."""

    name: str
    scenario: str
    seconds: float
    score: Score | None
    note: str
    gap: tuple[float | None, float | None] = (None, None)
    dofs: int = 0


def attempt(seed: int, folder: Path, cache: Path, timeout: float) -> Outcome:
    """Generate one case, search it and score the answer."""
    p = plan(seed)
    try:
        place = make(p, folder, cache)
    except CalculixError as problem:
        return Outcome(p.name, p.scenario, 0.0, None, f"CalculiX: {problem}"[-300:])
    truth = json.loads((place / "truth.json").read_text())
    return search(place, truth, timeout)


def _spent() -> float:
    """Return the seconds of one core that the children of this process have used."""
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime


def _dofs(place: Path) -> int:
    """Return six for every GRID of the decks of a case."""
    cards = (line for deck in place.glob("*.bdf") for line in deck.read_text().splitlines())
    return 6 * sum(card.startswith("GRID ") for card in cards)


def search(place: Path, truth: dict[str, Any], timeout: float) -> Outcome:
    """Run `trueup discover` on a case folder and score its answer."""
    test = next(place.glob("*_test.unv"))
    deck = place / test.name.replace("_test.unv", ".bdf")
    one_core = {"OMP_NUM_THREADS": "1", "MKL_NUM_THREADS": "1", "OPENBLAS_NUM_THREADS": "1"}
    start = _spent()
    with tempfile.TemporaryDirectory() as work:
        answer = Path(work) / "result.json"
        command = [sys.executable, "-m", "trueup", "discover", str(deck), str(test)]
        command += ["--deck-length-unit", "mm", "--out", f"{work}/run", "--json", str(answer), "-q"]
        try:
            done = subprocess.run(
                command,
                capture_output=True,
                text=True,
                timeout=timeout,
                env={**os.environ, **one_core},
                check=False,
            )
        except subprocess.TimeoutExpired:
            return Outcome(
                place.name, truth["scenario"], timeout, None, f"no answer in {timeout:.0f} s"
            )
        seconds = _spent() - start
        if not answer.exists():
            said = (done.stderr.strip().splitlines() or ["no message"])[-1]
            return Outcome(
                place.name, truth["scenario"], seconds, None, f"exit {done.returncode}: {said}"
            )
        result = json.loads(answer.read_text())
    (place / "result.json").write_text(json.dumps(result))
    gap = result.get("gap") or {}
    before, after = (
        (gap.get(k) or {}).get("mean_abs_deviation_percent") for k in ("before", "after")
    )
    return Outcome(
        place.name,
        truth["scenario"],
        seconds,
        score(truth, result),
        "",
        (before, after),
        _dofs(place),
    )


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


def main() -> int:
    """Run the benchmark; the last line is JSON."""
    a = argparse.ArgumentParser(prog="python -m benchmarks.discovery", description=__doc__)
    a.add_argument("--quick", action="store_true", help="20 cases")
    a.add_argument("--cases", type=int, default=200)
    a.add_argument("--first", type=int, default=0, help="seed of the first case")
    a.add_argument("--seeds", type=int, nargs="*", help="just these seeds")
    a.add_argument("--processes", type=int, default=2)
    a.add_argument("--timeout", type=float, default=300.0)
    a.add_argument("--cache", type=Path, help="where generated cases stay (default: temporary)")
    o = a.parse_args()
    seeds = o.seeds or range(o.first, o.first + (20 if o.quick else o.cases))
    outcomes: list[Outcome] = []
    with tempfile.TemporaryDirectory() as temporary:
        root = o.cache or Path(temporary)
        with ProcessPoolExecutor(o.processes) as pool:
            jobs = [
                pool.submit(attempt, s, root / "cases", root / "modes", o.timeout) for s in seeds
            ]
            for job in as_completed(jobs):
                outcomes.append(job.result())
                say(line(outcomes[-1]))
    report(outcomes)
    return 0


def report(outcomes: list[Outcome]) -> None:
    """Print the tables and the line of JSON."""
    done = [x.score for x in outcomes if x.score is not None]
    kinds = [(n.kind, n.found or "nothing") for s in done for n in s.named]
    kinds += [("nothing", kind) for s in done for kind, _ in s.false_alarms]
    say("\n" + confusion(kinds, "hidden (rows) and named (columns)"))
    say(confusion([(s.expected, s.verdict) for s in done], "verdict expected (rows) and given"))
    say("confidence  number  mean  right (kind and place)")
    for band, number, mean, right in calibration(done):
        say(f"{band}   {number:6d}  {mean:4.2f}  {right:4.2f}")
    say(json.dumps(summary(outcomes)))
