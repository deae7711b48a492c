"""The deck completed by what was found, read back, solved and compared again."""

from __future__ import annotations

import shutil
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

from ..core.errors import InputError
from .study import Study

ADOPTED = ("effect", "parameters_only")
"""Verdicts that change the deck."""
_MOVED = 2e-3
"""Parameters that move less than this stay as the deck has them."""


def written(verdict: str, factor: float) -> float:
    """Return the factor by which the completed deck has a known property."""
    return factor if verdict in ADOPTED and abs(factor - 1.0) > _MOVED else 1.0


def completed(
    study: Study,
    deck: Any,
    specs: list[Any],
    model: Any,
    found: Any,
    before: Any,
    work: Path,
    n_modes: int,
) -> tuple[Any, dict[str, Any]]:
    """Write the completed deck, or the deck as it was where completing brings it no nearer.

    Returns
    -------
    found : Discovery
        Its verdict withdrawn where the completed deck does not bear it out.
    done : dict
        See `complete`.
    """
    done = complete(study, deck, specs, model, found, before.placed, work, n_modes)
    if found.verdict in ADOPTED and _no_nearer(before, done["after"]):
        shutil.rmtree(work / "deck")
        found = _withdrawn(found)
        done = complete(study, deck, specs, model, found, before.placed, work, n_modes)
    return found, done


def borne_out(found: Any, agrees: bool) -> Any:
    """Return what was found; nothing where the deck as it is agrees with every mode of the test.

    Dampers and faults of sensors show elsewhere and stay.
    """
    told = any(f.side == "test" or f.kind == "local_damper" for f in found.findings)
    if not agrees or told:
        return found
    return replace(found, verdict="no_gap", findings=(), would_decide=())


def _no_nearer(before: Any, after: Any) -> bool:
    """Whether fewer modes pair, or as many with frequencies that are farther off."""
    from ..core.results import gap

    old, new = gap(before.correlation), gap(after.correlation)
    if new["pairs"] != old["pairs"] or not old["pairs"]:
        return bool(new["pairs"] < old["pairs"])
    return bool(new["mean_abs_deviation_percent"] > old["mean_abs_deviation_percent"])


def _withdrawn(found: Any) -> Any:
    """Return a verdict that the completed deck did not bear out."""
    if found.verdict == "parameters_only":
        return replace(found, verdict="no_gap")
    why = (
        "a finer mesh, or one with consistent mass (PARAM,COUPMASS,1): completed as found, the "
        "deck came no nearer to the test than it was"
    )
    return replace(found, verdict="undecided", would_decide=(why, *found.would_decide))


def complete(
    study: Study,
    deck: Any,
    specs: list[Any],
    model: Any,
    found: Any,
    placed: Any,
    work: Path,
    n_modes: int,
) -> dict[str, Any]:
    """Write the completed deck, read it back, solve it in full, correlate it again."""
    from ..adapters.nastran import (
        build_model,
        read_deck,
        read_deck_text,
        set_values,
        unified_diff,
        write_deck,
    )
    from ..adapters.nastran.adopt import adopt, plain
    from ..adapters.nastran.structure import free_damping
    from ..core import eigen
    from ..core.comparison import compare
    from .pipeline import criteria_of

    assert study.deck is not None
    original = read_deck_text(study.deck)
    text, cards, refused = original, [], []
    if found.verdict in ADOPTED:
        moved = {
            ref: plain(value * m.factor)
            for m in found.parameters
            if written(found.verdict, m.factor) != 1.0
            for ref, value in zip(
                specs[m.number].fields, model.parameters[m.number].deck_values, strict=True
            )
        }
        text = set_values(text, moved)
    for f in found.findings:
        adopted = None
        if f.side == "model" and found.verdict == "effect":
            try:
                adopted = adopt(text, deck, f)
                text = adopted.deck
            except InputError as error:
                refused.append(f"the {f.kind.replace('_', ' ')} was not written: {error}")
        cards.append(list(adopted.cards) if adopted else [])
    top = write_deck(text, work / "deck")
    (work / "changes.diff").write_text(unified_diff(original, text), encoding="utf-8", newline="")
    deck_again = read_deck(top)
    again = build_model(deck_again)
    solution = eigen.solve(again, n_modes=min(n_modes, again.n_free))
    modes = eigen.modes_of(again, solution)
    seen = placed
    if again.dofs.node.shape != model.dofs.node.shape:
        seen = _on(placed, model, again)
    sound = _corrected(seen, found)
    after = compare(again.geometry, modes, sound, criteria_of(study), solution.rigid_body_modes)
    return {
        "after": after,
        "damped": (after, solution, free_damping(deck_again, again)),
        "cards": _standing(cards, text),
        "refused": refused,
        "text": text,
        "deck": str(Path("deck") / top.relative_to((work / "deck").absolute())),
    }


def _standing(cards: list[list[str]], text: Any) -> list[list[str]]:
    """Return the cards that no later effect changed again."""
    there = {
        line.decode(f.encoding, "replace").rstrip()
        for f in text.files
        for line in f.data.splitlines()
    }
    return [[c for c in own if there.issuperset(c.split("\n"))] for own in cards]


def _on(placed: Any, model: Any, again: Any) -> Any:
    """Sensor map for a deck that has further grids."""
    import scipy.sparse as sp

    old = {
        (int(n), int(c)): i
        for i, (n, c) in enumerate(zip(model.dofs.node, model.dofs.component, strict=True))
    }
    rows, columns = [], []
    for j, key in enumerate(zip(again.dofs.node, again.dofs.component, strict=True)):
        i = old.get((int(key[0]), int(key[1])))
        if i is not None:
            rows.append(i)
            columns.append(j)
    P = sp.csr_matrix((np.ones(len(rows)), (rows, columns)), (len(model.dofs), len(again.dofs)))
    seen = replace(placed.observation, matrix=(placed.observation.matrix @ P).tocsr())
    return replace(placed, observation=seen)


def _corrected(placed: Any, found: Any) -> Any:
    """Return the test as sound sensors would have read it, less what cannot be known."""
    from ..core.discovery.faults import corrected, lost

    shapes = corrected(placed.test.shapes, found.corrected_sensors)
    left = ~lost(found.corrected_sensors, len(shapes))
    return replace(placed, test=replace(placed.test, shapes=shapes)).take(left)
