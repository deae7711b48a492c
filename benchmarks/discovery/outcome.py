"""What became of one case, and where it is kept: beside it, and as a line of a record."""

from __future__ import annotations

import json
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

from .known import Written, written
from .score import Named, Score, score

Json = dict[str, Any]


@dataclass(frozen=True)
class Outcome:
    """A case and what became of it; `score` is missing where something failed (`note`).

    `seconds` are of one core, `gap` the mean deviations [%] before and after; `cause` is what is
    hidden from outside the list, `shift` the largest change of a frequency by all hidden [%],
    `known` what the answer makes of every known property.
    """

    name: str
    structure: str
    scenario: str
    seconds: float
    score: Score | None
    note: str
    gap: tuple[float | None, float | None] = (None, None)
    dofs: int = 0
    cause: str = ""
    shift: float = 0.0
    known: tuple[Written, ...] = ()

    def to_line(self) -> str:
        """Return the outcome as a line of JSON."""
        return json.dumps(asdict(self))

    @classmethod
    def from_line(cls, line: str) -> Outcome:
        """Return the outcome that a line of JSON tells."""
        told = json.loads(line)
        if told["score"] is not None:
            named = tuple(Named(**n) for n in told["score"].pop("named"))
            false = tuple((str(k), float(p)) for k, p in told["score"].pop("false_alarms"))
            told["score"] = Score(named=named, false_alarms=false, **told["score"])
        known = tuple(Written(**w) for w in told.pop("known", ()))
        return cls(**{**told, "gap": tuple(told["gap"]), "known": known})


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
    cause = next((str(c["kind"]) for c in truth.get("outside", ())), "")
    shift = float((truth.get("visibility") or {}).get("largest_shift_percent", 0.0))
    if result is None:
        return Outcome(*told, None, run["note"], cause=cause, shift=shift)
    gap = result.get("gap") or {}
    before, after = (
        (gap.get(k) or {}).get("mean_abs_deviation_percent") for k in ("before", "after")
    )
    rest = "", (before, after), _dofs(place), cause, shift, written(truth, result)
    return Outcome(*told, score(truth, result), *rest)


def _dofs(place: Path) -> int:
    """Return six for every GRID of the decks of a case."""
    cards = (line for deck in place.glob("*.bdf") for line in deck.read_text().splitlines())
    return 6 * sum(card.startswith("GRID ") for card in cards)
