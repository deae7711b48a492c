"""Faults put into surveys: named, missed, and what is named that is in order, counted.

    python benchmarks/survey_faults.py [SURVEY.uff ...] [--first 5000] [--draws 8] [--fmin 15]

Into each survey (universal files, each a survey that is in order; without any, made ones of
`imperfect_surveys`, of three references, whose frequencies scatter) each fault is put at places
drawn anew, `draws` times with all references, and as often with the first two. A fault counts as
named when its kind is named at every function that it was put into, as partly named when at some;
as a false alarm when a point is named that it was not put into. (Of two references both functions
of a point may be named, where nothing tells which of them is wrong.) "In order" are the surveys as
they are, their halves (every other point) and pairs of references. Nothing is fitted: this is what
`checked` says. Ends with one line of JSON.
"""

from __future__ import annotations

import argparse
import json
import sys
from collections.abc import Callable, Iterator
from dataclasses import replace
from pathlib import Path

import numpy as np
from imperfect_surveys import survey as made

from trueup.adapters.universal import read_universal
from trueup.core.data.frfs import Frfs
from trueup.core.data.geometry import Geometry
from trueup.core.identification.survey.check_survey import checked
from trueup.core.identification.survey.survey_data import prepare

Change = Callable[[np.ndarray, np.random.Generator], np.ndarray]
"""Changes values (n_point, n_reference, n_line) and returns where, (n_point, n_reference) bool."""


def _function(values: np.ndarray, rng: np.random.Generator) -> tuple[int, int]:
    return int(rng.integers(len(values))), int(rng.integers(values.shape[1]))


def _one(change: Callable[[np.ndarray, np.random.Generator], np.ndarray]) -> Change:
    def put(values: np.ndarray, rng: np.random.Generator) -> np.ndarray:
        place = _function(values, rng)
        values[place] = change(values[place], rng)
        return _marked(values, [place])

    return put


def _point(change: Callable[[np.ndarray, np.random.Generator], np.ndarray]) -> Change:
    def put(values: np.ndarray, rng: np.random.Generator) -> np.ndarray:
        o = _function(values, rng)[0]
        values[o] = change(values[o], rng)
        return _marked(values, [(o, slice(None))])

    return put


def _marked(values: np.ndarray, places: list[tuple[object, object]]) -> np.ndarray:
    found = np.zeros(values.shape[:2], bool)
    for place in places:
        found[place] = True
    return found


def _several_turned(values: np.ndarray, rng: np.random.Generator) -> np.ndarray:
    rows = rng.choice(len(values), 4, replace=False)
    places = [(int(o), int(rng.integers(values.shape[1]))) for o in rows]
    for place in places:
        values[place] *= -1.0
    return _marked(values, places)


def _exchanged_at(share: float) -> Change:
    def put(values: np.ndarray, rng: np.random.Generator) -> np.ndarray:
        rows = rng.choice(len(values), max(round(share * len(values)), 1), replace=False)
        pair = rng.choice(values.shape[1], 2, replace=False)
        values[np.ix_(rows, pair)] = values[np.ix_(rows, pair[::-1])]
        return _marked(values, [(o, i) for o in rows for i in pair])

    return put


def _exchanged_points(values: np.ndarray, rng: np.random.Generator) -> np.ndarray:
    pair = rng.choice(len(values), 2, replace=False)
    values[pair] = values[pair[::-1]]
    return _marked(values, [(o, slice(None)) for o in pair])


def _noise(h: np.ndarray, rng: np.random.Generator) -> np.ndarray:
    e = rng.standard_normal(h.shape) + 1j * rng.standard_normal(h.shape)
    return 0.1 * np.abs(h).std() * e


def _dead(h: np.ndarray, rng: np.random.Generator) -> np.ndarray:
    return np.convolve(_noise(h, rng), np.hanning(7), "same")


def _cut(h: np.ndarray, rng: np.random.Generator) -> np.ndarray:
    return h / np.maximum(np.abs(h) / (0.3 * np.abs(h).max()), 1.0)


def _hit_twice(h: np.ndarray, rng: np.random.Generator) -> np.ndarray:
    delay = rng.uniform(0.1, 0.3) * np.arange(h.shape[1])
    return h * (1.0 + rng.uniform(0.3, 0.6) * np.exp(-2j * np.pi * delay))


def _times(factor: float) -> Callable[[np.ndarray, np.random.Generator], np.ndarray]:
    return lambda h, rng: h * factor


FAULTS: dict[str, tuple[str, Change]] = {
    "function of the wrong sign": ("wrong_sign", _one(_times(-1.0))),
    "four functions of the wrong sign": ("wrong_sign", _several_turned),
    "point of the wrong sign": ("wrong_sign", _point(_times(-1.0))),
    "references exchanged at one point": ("swapped_references", _exchanged_at(0.0)),
    "at one point in seven": ("swapped_references", _exchanged_at(0.14)),
    "at one point in four": ("swapped_references", _exchanged_at(0.25)),
    "two points exchanged": ("swapped_points", _exchanged_points),
    "dead function": ("dead_channel", _one(_dead)),
    "noise floor": ("noise_floor", _one(lambda h, rng: h + _noise(h, rng))),
    "overload": ("overload", _one(_cut)),
    "double hit": ("double_hit", _point(_hit_twice)),
    "function 1000 times too large": ("wrong_gain", _one(_times(1e3))),
    "function twice too large": ("wrong_gain", _one(_times(2.0))),
    "function half of what it is": ("wrong_gain", _one(_times(0.5))),
    "point 1000 times too large": ("wrong_gain", _point(_times(1e3))),
    "point twice too large": ("wrong_gain", _point(_times(2.0))),
}  # fmt: skip


def count(
    frfs: Frfs, geometry: Geometry | None, put: Change | None, kind: str, rng: np.random.Generator,
    ranges: list[tuple[float, float]],
) -> dict[str, int]:  # fmt: skip
    """Put a fault in (none: leave it) and count what is said."""
    roving = len(frfs.references) > len(frfs.responses)
    values = np.array(frfs.values.transpose(1, 0, 2) if roving else frfs.values)
    wrong = np.zeros(values.shape[:2], bool) if put is None else put(values, rng)
    given = replace(frfs, values=values.transpose(1, 0, 2) if roving else values)
    o, i = frfs.responses.labels, frfs.references.labels

    def names(places: np.ndarray) -> set[str]:
        return {f"{o[a]}/{i[b]}" for a, b in np.argwhere(places.T if roving else places)}

    truth, points = names(wrong), names(wrong | wrong.any(axis=1, keepdims=True))
    faults = checked(prepare(given, ranges), geometry).faults
    right = {f for fault in faults if fault.kind == kind for f in fault.functions}
    named = {f for fault in faults for f in fault.functions}
    hits = len(truth & right)
    return {
        "put": int(bool(truth)),
        "named": int(bool(truth) and hits == len(truth)),
        "partly": int(0 < hits < len(truth)),
        "false": int(bool(named - points)),
    }


def _given(paths: list[Path], draws: int, first: int) -> Iterator[tuple[Frfs, Geometry | None]]:
    contents = [read_universal([path]) for path in paths]
    for n in range(draws):
        for content in contents:
            assert content.frfs is not None
            yield content.frfs, content.geometry
        if not contents:
            yield made(first + n, "scatter")[0], None


def _parts(frfs: Frfs) -> Iterator[Frfs]:
    """Give the whole survey, and that of the first two of what it has fewer of."""
    yield frfs
    few = min(frfs.values.shape[:2])
    if few > 2:
        yield _taken(frfs, np.arange(2), fewer=True)


def _taken(frfs: Frfs, rows: np.ndarray, fewer: bool) -> Frfs:
    if (len(frfs.responses) < len(frfs.references)) == fewer:
        return replace(frfs, values=frfs.values[rows], responses=frfs.responses.take(rows))
    return replace(frfs, values=frfs.values[:, rows], references=frfs.references.take(rows))


def _in_order(frfs: Frfs) -> Iterator[Frfs]:
    few, many = sorted(frfs.values.shape[:2])
    yield frfs
    for first in (0, 1):
        yield _taken(frfs, np.arange(first, many, 2), fewer=False)
    for pair in ([0, 1], [0, 2], [1, 2]) if few > 2 else ():
        yield _taken(frfs, np.array(pair), fewer=True)


def main() -> None:
    """Run and print."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("surveys", nargs="*", type=Path)
    parser.add_argument("--first", type=int, default=5000)
    parser.add_argument("--draws", type=int, default=8)
    parser.add_argument("--fmin", type=float, default=0.0)
    parser.add_argument("--fmax", type=float, default=np.inf)
    asked = parser.parse_args()
    ranges = [(asked.fmin, asked.fmax)]
    table: dict[str, dict[str, int]] = {}
    rng = np.random.default_rng(asked.first)
    for name, (kind, put) in {**FAULTS, "in order": ("", None)}.items():
        total = dict.fromkeys(("put", "named", "partly", "false", "surveys"), 0)
        for frfs, geometry in _given(asked.surveys, asked.draws if put else 1, asked.first):
            for part in _parts(frfs) if put else _in_order(frfs):
                for key, value in count(part, geometry, put, kind, rng, ranges).items():
                    total[key] += value
                total["surveys"] += 1
        table[name] = total
        sys.stderr.write(f"{name:35s} {total}\n")
    sys.stdout.write(json.dumps(table) + "\n")


if __name__ == "__main__":
    main()
