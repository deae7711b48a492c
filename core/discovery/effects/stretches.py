"""Stretches of an edge beside one another: an end further on, or giving another way."""

from __future__ import annotations

from .candidates import Candidates, Catalogue, Ends, Suspect


def beside(catalogue: Catalogue, suspect: Suspect) -> list[Suspect]:
    """Return stretches that begin or end one place from a suspect's, and those that give otherwise.

    How far a neighbour of a stretch promises to be better shows only once the known parameters
    have followed: one more grid that turns freely changes every mode.
    """
    own = catalogue[suspect.kind]
    if not own.ends:
        return []
    edge, first, last = own.ends[suspect.row]
    rows = _rows(own)
    moved = [(edge, first + a, last + b) for a, b in ((-1, 0), (1, 0), (0, -1), (0, 1))]
    moved += [(edge, first + a, last + a) for a in (-1, 1)]
    out = [Suspect(suspect.kind, rows[e], suspect.theta) for e in moved if e in rows]
    for kind, c in enumerate(catalogue):
        row = _rows(c).get((edge, first, last)) if kind != suspect.kind else None
        if row is not None:
            out.append(Suspect(kind, row, tuple(float(v) for v in c.typical)))
    return out


def _rows(c: Candidates) -> dict[Ends, int]:
    return {e: row for row, e in enumerate(c.ends)}
