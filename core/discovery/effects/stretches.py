"""Stretches of an edge beside one another: an end further on, or giving another way."""

from __future__ import annotations

from .candidates import Candidates, Catalogue, Suspect

Ends = tuple[int, int, int]
"""Number of an edge, and of the places on it where a stretch begins and ends."""


def beside(catalogue: Catalogue, suspect: Suspect) -> list[Suspect]:
    """Return stretches that begin or end one place from a suspect's, and those that give otherwise.

    How far a neighbour of a stretch promises to be better shows only once the known parameters
    have followed: one more grid that turns freely changes every mode.
    """
    own = catalogue[suspect.kind]
    ends = _ends(own)
    if not ends:
        return []
    edge, first, last = ends[suspect.row]
    rows = _rows(own)
    moved = [(edge, first + a, last + b) for a, b in ((-1, 0), (1, 0), (0, -1), (0, 1))]
    moved += [(edge, first + a, last + a) for a in (-1, 1)]
    out = [Suspect(suspect.kind, rows[e], suspect.theta) for e in moved if e in rows]
    for kind, c in enumerate(catalogue):
        row = _rows(c).get((edge, first, last)) if kind != suspect.kind else None
        if row is not None:
            out.append(Suspect(kind, row, tuple(float(v) for v in c.typical)))
    return out


def _ends(c: Candidates) -> list[Ends]:
    ends: list[Ends] = c.extra.get("ends", [])
    return ends


def _rows(c: Candidates) -> dict[Ends, int]:
    return {e: row for row, e in enumerate(_ends(c))}
