"""What became of one case, and where it is kept: ``result.json`` and ``run.json`` beside it."""

from __future__ import annotations

import json
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from .score import Score, score

Json = dict[str, Any]


@dataclass(frozen=True)
class Outcome:
    """A case and what became of it; `score` is missing where something failed (`note`).

    `seconds` are of one core, `gap` the mean deviations [%] before and after.
    """

    name: str
    structure: str
    scenario: str
    seconds: float
    score: Score | None
    note: str
    gap: tuple[float | None, float | None] = (None, None)
    dofs: int = 0


def keep(place: Path, seconds: float, note: str, result: Json | None) -> None:
    """Leave an answer (or why there is none) in the folder of its case."""
    (place / "run.json").write_text(json.dumps({"seconds": seconds, "note": note}))
    (place / "result.json").write_text(json.dumps(result))


def read(place: Path) -> Outcome:
    """Return what became of the case in a folder that `keep` has written to."""
    truth, run, result = (
        json.loads((place / f"{name}.json").read_text()) for name in ("truth", "run", "result")
    )
    told = truth["case"], truth["structure"], truth["scenario"], run["seconds"]
    if result is None:
        return Outcome(*told, None, run["note"])
    gap = result.get("gap") or {}
    before, after = (
        (gap.get(k) or {}).get("mean_abs_deviation_percent") for k in ("before", "after")
    )
    return Outcome(*told, score(truth, result), "", (before, after), _dofs(place))


def _dofs(place: Path) -> int:
    """Return six for every GRID of the decks of a case."""
    cards = (line for deck in place.glob("*.bdf") for line in deck.read_text().splitlines())
    return 6 * sum(card.startswith("GRID ") for card in cards)
