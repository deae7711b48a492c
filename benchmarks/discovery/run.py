"""``python -m benchmarks.discovery``: generate cases, run `trueup discover` on them, tabulate.

The run that is published, on cases that nobody has looked at, begun again where it was left:
``python -m benchmarks.discovery --first 7000 --cases 300 --cache FOLDER --record frozen.jsonl``.
"""

from __future__ import annotations

import argparse
import json
import os
import resource
import subprocess
import sys
import tempfile
from concurrent.futures import ProcessPoolExecutor, as_completed
from pathlib import Path

from .calculix import CalculixError
from .case import make, plan
from .measure import Noise
from .outcome import Outcome, keep, read
from .tables import line, report, say


def attempt(seed: int, folder: Path, cache: Path, timeout: float, noise: Noise) -> Outcome:
    """Generate one case, search it and score the answer; what is there already is kept."""
    p = plan(seed)
    try:
        place = make(p, folder, cache, noise)
    except (CalculixError, subprocess.TimeoutExpired, ValueError) as problem:
        note = f"no case: {problem}"[-300:]
        return Outcome(p.name, p.structure, p.scenario, 0.0, None, note)
    if not (place / "run.json").exists():
        search(place, timeout)
    return read(place)


def _spent() -> float:
    """Return the seconds of one core that the children of this process have used."""
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime


def search(place: Path, timeout: float) -> None:
    """Run `trueup discover` on a case folder and keep its answer there."""
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
            keep(place, timeout, f"no answer in {timeout:.0f} s", None)
            return
        seconds = _spent() - start
        if not answer.exists():
            said = (done.stderr.strip().splitlines() or ["no message"])[-1]
            keep(place, seconds, f"exit {done.returncode}: {said}", None)
            return
        keep(place, seconds, "", json.loads(answer.read_text()))


def main() -> int:
    """Run the benchmark; the last line is JSON."""
    a = argparse.ArgumentParser(prog="python -m benchmarks.discovery", description=__doc__)
    a.add_argument("--quick", action="store_true", help="20 cases")
    a.add_argument("--cases", type=int, default=200)
    a.add_argument("--first", type=int, default=0, help="seed of the first case")
    a.add_argument("--seeds", type=int, nargs="*", help="just these seeds")
    a.add_argument("--processes", type=int, default=2)
    a.add_argument("--timeout", type=float, default=300.0)
    a.add_argument("--noise", type=float, default=1.0, help="times the usual scatter of the test")
    a.add_argument("--cache", type=Path, help="where cases and answers stay (default: temporary)")
    a.add_argument("--record", type=Path, help="lines of JSON, one a case; those are kept")
    o = a.parse_args()
    record = o.record.read_text().splitlines() if o.record and o.record.exists() else []
    outcomes = [Outcome.from_line(told) for told in record]
    known = {outcome.name for outcome in outcomes}
    wanted = o.seeds or range(o.first, o.first + (20 if o.quick else o.cases))
    seeds = [s for s in wanted if plan(s).name not in known]
    noise = Noise().times(o.noise)
    with tempfile.TemporaryDirectory() as temporary:
        root = o.cache or Path(temporary)
        with ProcessPoolExecutor(o.processes) as pool:
            jobs = [
                pool.submit(attempt, s, root / "cases", root / "modes", o.timeout, noise)
                for s in seeds
            ]
            for job in as_completed(jobs):
                outcomes.append(job.result())
                say(line(outcomes[-1]))
                if o.record:
                    with o.record.open("a") as file:
                        file.write(outcomes[-1].to_line() + "\n")
    report(outcomes)
    return 0
