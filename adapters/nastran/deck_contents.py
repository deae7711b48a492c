"""What a deck holds, in one screen."""

from pathlib import Path
from typing import Any

from ...core.data.geometry import Geometry
from ...core.errors import InputError
from .deck.case_control import CaseControl
from .deck.number_spaces import space_of
from .deck.read_deck import Deck, EigenRequest, seen_from
from .deck_reader import read_deck
from .properties.grids import read_points
from .properties.unit_slips import unit_slips

_FORMAT = "Nastran deck"


def describe_deck(path: Path | str) -> dict[str, Any]:
    """Say what a deck with all its INCLUDE files, or a part of one, holds.

    Numbers that refer to nothing are found by `build_model`; here what cannot be assembled has
    neither mass nor frequency among its magnitudes.

    Returns
    -------
    dict
        ``path``, ``format``, ``contents`` (files, cards by name, units, eigenvalue request, ...),
        ``skipped`` (what, line, why of every kind of card that is not used) and ``warnings``.

    Raises
    ------
    InputError
        A file that cannot be read, a card that is not a card: file, line, field.
    """
    from .assembly.candidate_parameters import properties_of
    from .assembly.magnitudes import magnitudes  # slow to import, and not needed to read a deck

    deck = read_deck(path)
    known = magnitudes(deck)
    held = [
        f"{row.card} {row.id} ({row.elements}): "
        + ", ".join(f"{name} {value:.6g}" for name, value in row.values.items() if value)
        for row in properties_of(deck)
    ]
    size = known.get("size", 0.0)
    slips = unit_slips(deck, size) if isinstance(size, float) else ()
    return {
        "path": str(path),
        "format": _FORMAT,
        "contents": {
            **_contents(deck),
            **({"magnitudes": known} if known else {}),
            **({"properties": held} if held else {}),
        },
        "skipped": list(deck.skipped),
        "warnings": [*deck.warnings, *slips],
    }


def deck_geometry(deck: Deck) -> Geometry:
    """Return grids and elements of a deck for drawing; elements without known matrices too."""
    from .assembly.drawn_model import drawn_geometry

    return drawn_geometry(deck, read_points(deck.bulk))


def _contents(deck: Deck) -> dict[str, Any]:
    known, counts = deck.bulk.definitions, deck.counts
    elements = {n: k for n, k in counts.items() if space_of(n, known) == "element"}
    found = {
        "files": [seen_from(deck.path, f) for f in deck.files] if deck.files[1:] else None,
        "grids": counts.get("GRID"),
        "bounding_box": _box(deck) if counts.get("GRID") else None,
        "elements": elements,
        "other_cards": {n: k for n, k in counts.items() if n not in (*elements, "GRID")},
        "length_unit": deck.length_unit or "not declared",
        "eigenvalue_request": None if deck.eigen is None else _request(deck.eigen),
        "selected_by_case_control": _selected(deck.case),
        "params": deck.params,
    }
    return {k: v for k, v in found.items() if v}


def _box(deck: Deck) -> list[float] | None:
    """Edge lengths of the box around the grids; None where a coordinate system is elsewhere."""
    try:
        xyz = read_points(deck.bulk).xyz
    except InputError:  # a part of a deck: the systems may stand in another file
        return None
    return [float(edge) for edge in xyz.max(axis=0) - xyz.min(axis=0)]


def _request(eigen: EigenRequest) -> dict[str, Any]:
    said = {"from_hz": eigen.v1, "to_hz": eigen.v2, "modes": eigen.nd}
    return {k: v for k, v in said.items() if v is not None} or {"modes": "all"}


def _selected(case: CaseControl) -> dict[str, Any]:
    names = ("subcase", "spc", "mpc", "method", "nsm", "suport1", "temperature")
    sets = {n: getattr(case, n) for n in names if getattr(case, n)}
    matrices = {n: [m for m, _ in getattr(case, n)] for n in ("k2gg", "m2gg")}
    matrices |= {command.lower(): [*names] for command, names in case.not_added}
    return {**sets, **{n: held for n, held in matrices.items() if held}}
