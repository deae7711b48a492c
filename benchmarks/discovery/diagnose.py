"""Ask why a case was missed: the true hypothesis' objective beside the one that was chosen.

``python -m benchmarks.discovery.diagnose CASE_FOLDER...``: the search runs as it is; then the true
effects are fitted at the candidates nearest to their places. Where the truth fits better than what
was chosen, the search lost it; where it fits worse, the catalogue, the mesh or the evidence did.
"""

from __future__ import annotations

import itertools
import json
import math
import sys
from pathlib import Path
from typing import Any

import numpy as np

from .score import spot_of
from .tables import say


class _Stop(Exception):
    """Carries what the search had when it was judged."""


def searched(place: Path) -> tuple[Any, Any, Any]:
    """Return searcher, hypotheses and judgement of a case."""
    import trueup
    from trueup.core.discovery import discover as engine

    test = next(place.glob("*_test.unv"))
    deck = place / test.name.replace("_test.unv", ".bdf")
    caught: list[Any] = []
    honest = engine.judge

    def judge(searcher: Any, found: Any) -> Any:
        caught.extend((searcher, found, honest(searcher, found)))
        raise _Stop

    engine.judge = judge
    try:
        trueup.discover(deck, test, deck_length_unit="mm")
    except _Stop:
        pass
    finally:
        engine.judge = honest
    return caught[0], caught[1], caught[2]


def nearest(searcher: Any, effect: dict[str, Any], count: int) -> list[Any]:
    """Return suspects of the true kind and size at the places nearest to the true one."""
    from trueup.core.discovery.effects import KINDS
    from trueup.core.discovery.effects.candidates import Suspect

    spot, _ = spot_of(effect)
    sizes = [math.log(effect.get(m.word, 1.0)) for m in KINDS[effect["kind"]].magnitudes]
    wanted, out = effect.get("components"), []
    for number, c in enumerate(searcher.problem.catalogue):
        away = np.linalg.norm(c.xyz - np.array(spot), axis=1)
        for row in np.argsort(away, kind="stable") if c.kind.name == effect["kind"] else ():
            own = c.where[row].get("components")
            if not own or not wanted or list(own) == wanted:
                theta = tuple(sizes if c.tunings > 1 else c.like(sizes).tolist())
                out.append((float(away[row]), Suspect(number, int(row), theta)))
    return [s for _, s in sorted(out, key=lambda o: o[0])[:count]]


def describe(searcher: Any, fit: Any) -> str:
    """Return objective and suspects of a fit in one line."""
    words = []
    for s in fit.suspects:
        c = searcher.problem.catalogue[s.kind]
        x = ", ".join(f"{v:.0f}" for v in c.xyz[s.row])
        words.append(
            f"{c.kind.name} ({x}) {' '.join(f'{math.exp(v):.4g}' for v in s.theta)} "
            f"{c.where[s.row].get('components', '')}"
        )
    return f"{fit.objective:8.1f}  " + "; ".join(words)


def explain(place: Path) -> None:
    """Print what was chosen and how the truth fits."""
    from trueup.core.discovery.likelihood.map_fit import fit

    truth = json.loads((place / "truth.json").read_text())
    searcher, found, verdict = searched(place)
    say(f"== {place.name}: noise scale {verdict.scale:.2f}")
    for k, level in enumerate(found.levels):
        mark = "chosen" if k == verdict.accepted else "level "
        say(f"  {mark} {k}  {describe(searcher, level)}")
    effects = truth["effects"]
    places = [nearest(searcher, e, 24 if len(effects) == 1 else 4) for e in effects]
    for e, p in zip(effects, places, strict=True):
        if not p:
            say(f"  the catalogue has no {e['kind']} {e.get('components', '')}")
    tries = [
        fit(searcher.problem, found.levels[0].nuisance, combination, searcher.active, 15)
        for combination in itertools.product(*[p for p in places if p])
        if combination
    ]
    if tries:
        say(f"  truth     {describe(searcher, min(tries, key=lambda f: float(f.objective)))}")
    names = {k: truth[k] for k in ("effects", "scatter", "faults")}
    say("  hidden    " + json.dumps(names)[:700])


if __name__ == "__main__":
    for argument in sys.argv[1:]:
        explain(Path(argument))
