"""``python -m benchmarks.discovery.tables FOLDER``: what a run came to, as tables in Markdown.

Reads what ``python -m benchmarks.discovery --cache FOLDER`` or ``--record FILE`` has left there.
"""

from __future__ import annotations

import argparse
import json
import sys
from collections import Counter
from collections.abc import Callable, Iterable
from itertools import pairwise
from pathlib import Path
from typing import Any

from scipy.stats import beta

from .outcome import Outcome, read
from .outside import FAMILIES
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
    """Return a Markdown table of counts: hidden in rows, named in columns."""
    counts = Counter(pairs)
    rows = sorted({a for a, _ in counts})
    columns = sorted({b for _, b in counts})
    out = [f"| {title} | " + " | ".join(columns) + " |", "|---" + "|---:" * len(columns) + "|"]
    for r in rows:
        out.append(f"| {r} | " + " | ".join(str(counts[r, c] or "") for c in columns) + " |")
    return "\n".join(out) + "\n"


def claimed(s: Score) -> str:
    """Return what a case was told to be: the kinds of an effect, else the verdict."""
    if s.verdict != "effect":
        return s.verdict
    kinds = [n.found for n in s.named] + [k for k, _ in s.false_alarms]
    kinds = [k for k in kinds if k and not k.startswith("sensor_")]
    return kinds[0] if len(kinds) == 1 else "several effects" if kinds else "effect"


def share(some: int, of: int) -> str:
    """Return a share with its 95 % interval (Clopper and Pearson 1934)."""
    if not of:
        return "none"
    low = float(beta.ppf(0.025, some, of - some + 1)) if some else 0.0
    high = float(beta.ppf(0.975, some + 1, of - some)) if some < of else 1.0
    return f"{some} of {of} = {some / of:.1%} ({low:.1%} to {high:.1%})"


def listed(o: Outcome) -> bool:
    """Return whether a case hides an effect of the list."""
    return "effect" in o.scenario or o.scenario in ("several masses", "twins")


def goals(outcomes: list[Outcome]) -> str:
    """Return the two figures that the search is judged by, and what became of each cause."""
    done = [(o, o.score) for o in outcomes if o.score is not None]
    quiet = [(o, s) for o, s in done if not listed(o)]
    outside = [(o, s) for o, s in quiet if o.cause]
    held = [s for o, s in done if listed(o)]
    effects = [n for s in held for n in s.named if not n.kind.startswith("sensor_")]
    rows = {
        "false claims where no listed effect is": [s.claims for _, s in quiet],
        "of these, the cause outside the list": [s.claims for _, s in outside],
        "right answers where the cause is outside": [s.solved for _, s in outside],
        "cases with listed effects solved": [s.solved for s in held],
        "listed effects solved (kind, place, size)": [n.solved for n in effects],
        "false findings beside listed effects (cases)": [s.claims for s in held],
    }
    out = ["| | cases, share (95 % interval) |", "|---|---|"]
    out += [f"| {name} | {share(sum(of), len(of))} |" for name, of in rows.items()]
    return "\n".join(out) + "\n"


def _gross(shift: float) -> str:
    return "up to 0.4 %" if shift < 0.4 else "0.4 to 2 %" if shift < 2.0 else "above 2 %"


def _median(values: Iterable[float]) -> float | None:
    v = sorted(values)
    return v[len(v) // 2] if v else None


def calibration(done: list[Score]) -> str:
    """Return a Markdown table of the confidence said and the share of findings that are right."""
    points = [
        (n.confidence, n.found == n.kind and n.placed)
        for s in done
        for n in s.named
        if n.confidence is not None
    ]
    points += [(sure, False) for s in done for _, sure in s.false_alarms]
    out = ["| confidence said | findings | mean | right (kind and place) |", "|---|---:|---:|---|"]
    for low, high in pairwise((0.0, 0.3, 0.5, 0.7, 0.8, 0.9, 0.95, 0.99, 1.01)):
        band = [(c, r) for c, r in points if low <= c < high]
        if band:
            mean = sum(c for c, _ in band) / len(band)
            right = share(sum(r for _, r in band), len(band))
            out.append(
                f"| {low:.2f} to {min(high, 1.0):.2f} | {len(band)} | {mean:.2f} | {right} |"
            )
    return "\n".join(out) + "\n"


def properties(outcomes: list[Outcome]) -> str:
    """Return a Markdown table of what was written of known properties, and what was changed."""
    rows = {"all hidden is on the list": False, "a cause outside the list, or off everywhere": True}
    head = "properties", "written", "changed as well", "within two errors", "changed", "written"
    out = [f"| | {' | '.join(head)} |", "|---" + "|---:" * len(head) + "|"]
    for name, beyond in rows.items():
        of = (o for o in outcomes if beyond == (bool(o.cause) or "real" in o.scenario))
        every = [w for o in of for w in o.known]
        told = [w for w in every if w.deviation]
        changed = [w for w in every if w.truth != 1.0]
        right = sum(w.truth != 1.0 for w in told)
        counts = len(every), len(told), right, sum(w.off < 2.0 for w in told), len(changed), right
        out.append(f"| {name} | " + " | ".join(map(str, counts)) + " |")
    return "\n".join(out) + "\n"


def summary(outcomes: list[Outcome]) -> dict[str, Any]:
    """Return the figures of a run, plain for JSON."""
    done = [o.score for o in outcomes if o.score is not None]
    quiet = [o for o in outcomes if not listed(o) and o.score is not None]
    alarms = [o for o in quiet if o.score is not None and o.score.claims]
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
    if o.scenario == "real":
        return "poor test, model off everywhere"
    if o.cause and not listed(o):
        causes = {c.__name__: family for family, own in FAMILIES.items() for c in own}
        return f"outside: {causes.get(o.cause, o.cause)}"
    if o.scenario in ("nothing", "scatter", "fault", "two effects", "several masses", "twins"):
        words = {"scatter": "wrong properties only", "fault": "faults of sensors only"}
        return words.get(o.scenario, o.scenario)
    kinds = [] if o.score is None else [n.kind for n in o.score.named]
    beside = {"fault": " and a fault", "outside": " and a cause outside", "real": ", poor test"}
    more = next((words for part, words in beside.items() if part in o.scenario), "")
    return (kinds[0] if kinds else "effect") + more


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
    scored = [(o, o.score) for o in outcomes if o.score is not None]
    done = [s for _, s in scored]
    say(goals(outcomes))
    kinds = [(n.kind, n.found or "nothing") for s in done for n in s.named]
    kinds += [("nothing", kind) for s in done for kind, _ in s.false_alarms]
    say(confusion(((hidden(o), claimed(s)) for o, s in scored), "hidden (rows), told (columns)"))
    say(confusion(kinds, "every effect and fault: hidden, named"))
    outside = [(o, s) for o, s in scored if o.cause and not listed(o)]
    say(confusion(((o.cause, claimed(s)) for o, s in outside), "cause outside the list, told"))
    say(confusion(((_gross(o.shift), claimed(s)) for o, s in outside), "it moves a frequency by"))
    say(properties(outcomes))
    say(calibration(done))
    say(json.dumps(summary(outcomes)))


def main() -> int:
    """Print the rows and tables of the cases in a folder."""
    a = argparse.ArgumentParser(prog="python -m benchmarks.discovery.tables", description=__doc__)
    a.add_argument("folder", type=Path, help="of cases, or a record in lines of JSON")
    a.add_argument("--every", type=int, default=1, help="only every so many, of the sorted names")
    a.add_argument("--start", type=int, default=0, help="from which one on")
    o = a.parse_args()
    if o.folder.is_file():
        outcomes = [Outcome.from_line(told) for told in o.folder.read_text().splitlines()]
    else:
        outcomes = [read(p.parent) for p in sorted(o.folder.rglob("run.json"))]
    outcomes = sorted(outcomes, key=lambda one: one.name)[o.start :: o.every]
    for one in outcomes:
        say(line(one))
    report(outcomes)
    return 0


if __name__ == "__main__":
    sys.exit(main())
