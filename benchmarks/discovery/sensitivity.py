"""``python -m benchmarks.discovery.sensitivity NAME [FOLDER]``: what a tuned number decides.

Searches cases whose truth is known with the number as it is and times some factors, and tells
what is said each time. Without NAME: the tables of all numbers, which are docs/numbers.md.
"""

from __future__ import annotations

import argparse
import json
import subprocess
import sys
import tempfile
from dataclasses import fields, is_dataclass
from importlib import import_module
from pathlib import Path
from typing import Any

from .score import score

_WORDS = """# Numbers

Every tuned number of the core, a table for each part, with its unit, its meaning, and where it
comes from: a publication, a physical reason, or the command that calibrates or checks it. Made by
`python -m benchmarks.discovery.sensitivity`; what a number of discovery decides is told by the
command beside it. The coefficients of exact formulas stand where they are used."""
ROOT = Path(__file__).resolve().parents[2]
_IMPORT = "number_table import"
_RUN = f"from {__package__}.sensitivity import change; change({{!r}}, {{!r}})\n"
_RUN += "from trueup.cli import main; main()"


def tables() -> dict[str, Any]:
    """Return the tables of the modules of the core that have any, by their names in lower case."""
    every = sorted(p for p in (ROOT / "core").rglob("*.py") if _IMPORT in p.read_text("utf-8"))
    paths = [p.relative_to(ROOT) for p in every]
    modules = [import_module(".".join(("trueup", *p.with_suffix("").parts))) for p in paths]
    inside = [item for m in modules for item in vars(m).items()]
    return {n.lower(): t for n, t in inside if is_dataclass(t) and not isinstance(t, type)}


def markdown() -> str:
    """Return every number with unit, meaning and source, a line each."""
    out = [_WORDS]
    for room, table in tables().items():
        out += [
            f"\n## {room}\n",
            "| number | value | unit | meaning | source |\n|---|---|---|---|---|",
        ]
        for f in fields(table):
            unit, meaning, source = f.metadata.values()
            source = source.format(f"{room}.{f.name}")
            source = f"`{source}`" if source.startswith("py") else source
            out.append(f"| {f.name} | {f.default} | {unit} | {meaning} | {source} |")
    return "\n".join(out) + "\n"


def change(name: str, factor: float) -> None:
    """Multiply a number of a table, before anything that uses it is imported."""
    table, own = tables()[name.split(".")[0]], name.split(".")[1]
    object.__setattr__(table, own, scaled(getattr(table, own), factor))


def scaled(value: Any, factor: float) -> Any:
    """Return a number, or every one of a tuple, times a factor; a count changes by 1 at least."""
    if isinstance(value, tuple):
        return tuple(scaled(v, factor) for v in value)
    if isinstance(value, int) and factor != 1.0:
        up, new = factor > 1.0, round(value * factor)
        return max(new, value + 1) if up else min(new, value - 1)
    return value * factor


def answer(place: Path, name: str, factor: float) -> dict[str, Any]:
    """Return what a search of a case says with a number changed."""
    test = next(place.glob("*_test.unv"))
    deck = place / test.name.replace("_test.unv", ".bdf")
    with tempfile.TemporaryDirectory() as work:
        command = [
            sys.executable,
            "-c",
            _RUN.format(name, factor),
            "discover",
            str(deck),
            str(test),
        ]
        command += ["--deck-length-unit", "mm", "--json", f"{work}/a", "--out", f"{work}/run", "-q"]
        subprocess.run(command, check=True, cwd=ROOT)
        return dict(json.loads(Path(work, "a").read_text()))


def main() -> int:
    """Tell what is said; the last line is JSON."""
    a = argparse.ArgumentParser(prog=f"python -m {__package__}.sensitivity", description=__doc__)
    a.add_argument("name", nargs="?", help="table.number")
    a.add_argument("folder", nargs="?", type=Path, default=ROOT / "tests/discovery_cases/cases")
    a.add_argument("--factors", type=float, nargs="+", default=[0.8, 1.25])
    o = a.parse_args()
    if not o.name:
        sys.stdout.write(markdown())
        return 0
    solved = dict.fromkeys([1.0, *o.factors], 0)
    places = sorted(p.parent for p in o.folder.resolve().rglob("truth.json"))
    for place in places:
        truth = json.loads((place / "truth.json").read_text())
        for factor in solved:
            said = answer(place, o.name, factor)
            s = score(truth, said)
            solved[factor] += s.solved
            found = [(n.found, n.distance, n.ratio, n.confidence) for n in s.named]
            row = {"case": place.name, "factor": factor, "solved": s.solved, "found": found}
            sys.stdout.write(json.dumps(row | said["judgement"]) + "\n")
            sys.stdout.flush()
    sys.stdout.write(json.dumps({"number": o.name, "cases": len(places), "solved": solved}) + "\n")
    return 0


if __name__ == "__main__":
    sys.exit(main())
