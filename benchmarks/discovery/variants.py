"""``python -m benchmarks.discovery.variants CASE WAY``: the same case told otherwise.

Grids renumbered, sensors and modes shuffled, sensors relabelled, axes turned, units changed, a
breath of noise: what `discover` says must not change, nor with other threads
(``OMP_NUM_THREADS``). Decks are those of
`deck` and of the data folder: small-field cards of one line each. A turned case has its axes
exchanged in deck and test alike, so that springs along the basic axes stay what they are.
"""

from __future__ import annotations

import argparse
import json
import re
import sys
import tempfile
from collections.abc import Callable
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

import numpy as np

from trueup.core.data.dofs import Dofs
from trueup.core.data.geometry import Geometry
from trueup.core.data.measurement import Measurement

from .mesh import Floats, Ints

Json = dict[str, Any]
Card = list[str]

TURN = np.array([[0.0, 0.0, 1.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]])
"""x becomes y, y becomes z, z becomes x."""
_GRIDS = {"GRID": (1,), "CQUAD4": (3, 4, 5, 6), "CBAR": (3, 4), "SPC1": (3,)}
_VECTORS = {"GRID": (3, 4, 5), "CBAR": (5, 6, 7)}
_METRES = {
    "GRID": dict.fromkeys((3, 4, 5), 1e-3),
    "MAT1": {2: 1e6, 3: 1e6, 5: 1e12},
    "PSHELL": {3: 1e-3},
    "PBAR": {3: 1e-6, 4: 1e-12, 5: 1e-12, 6: 1e-12},
}
"""Factors from mm, t, N, s to m, kg, N, s, by card and field."""


@dataclass(frozen=True, eq=False)
class Variant:
    """A case told otherwise, and how places and sizes of its findings come back to mm, t, N."""

    deck: Path
    test: Measurement
    unit: str = "mm"
    turn: Floats | None = None
    labels: dict[int, int] = field(default_factory=dict)

    def back(self, finding: Json) -> Json:
        """Return side, kind, place [mm], sensors, size and interval [mm, t, N] of a finding.

        Sensors stand for their places: of two that are exchanged either may be told first.
        """
        where, magnitude = finding["where"], finding["magnitude"]
        at = [] if where.get("sensors") else where.get("xyz") or []
        length = 1e3 if self.unit == "m" else 1.0
        xyz = np.array(at, dtype=float).reshape(-1, 3) * length
        if self.turn is not None:
            xyz = xyz @ self.turn
        word = next((w for w in _BACK if w in magnitude), None)
        scale = _BACK[word] if word and self.unit == "m" else 1.0
        if scale != 1.0 and word == "stiffness" and min(magnitude.get("components") or [1]) > 3:
            scale *= 1e6
        size = magnitude.get(word) if word else None
        interval = finding.get("interval")
        return {
            "what": (finding["side"], finding["kind"]),
            "xyz": xyz.tolist(),
            "sensors": sorted(self.labels.get(n, n) for n in where.get("sensors") or []),
            "size": None if size is None else scale * float(size),
            "interval": None if interval is None else [scale * float(v) for v in interval],
        }


_BACK = {"mass": 1e-3, "factor": 1.0, "stiffness": 1e-3, "damping": 1e-3}


def cards(text: str, change: Callable[[Card], Card]) -> str:
    """Return a deck with its one-line cards of known names changed and in wide fields."""
    out = []
    for line in text.splitlines():
        name = line[:8].strip()
        if name not in {*_GRIDS, *_VECTORS, *_METRES}:
            out.append(line)
            continue
        fields = [name] + [line[k : k + 8].strip() for k in range(8, 72, 8)]
        new = change(fields)
        halves = [f"{name + '*':<8}", f"{'*':<8}"]
        for k, value in enumerate(new[1:]):
            halves[k // 4] += f"{value:<16}"
        out += [h.rstrip() for h in halves]
    return "\n".join(out) + "\n"


def number(text: str) -> float:
    """Return the value of a field; an exponent may come without its letter."""
    return float(re.sub(r"(?<=[\d.])([+-])", r"e\1", text))


def _copied(case: Path, folder: Path, change: Callable[[Card], Card]) -> Path:
    """Copy the deck of a case with its cards changed."""
    folder.mkdir(parents=True)
    for source in case.glob("*.bdf"):
        (folder / source.name).write_text(cards(source.read_text(), change))
    return folder / _deck(case).name


def _deck(case: Path) -> Path:
    test = next(case.glob("*_test.unv"))
    return case / test.name.replace("_test.unv", ".bdf")


def renumbered(case: Path, folder: Path, test: Measurement, rng: np.random.Generator) -> Variant:
    """Give the grids other numbers, so that they stand in another order."""
    text = "".join(p.read_text() for p in case.glob("*.bdf"))
    ids = [int(line[8:16]) for line in text.splitlines() if line.startswith("GRID ")]
    new = dict(zip(ids, (5 + 3 * rng.permutation(len(ids))).tolist(), strict=True))

    def change(card: Card) -> Card:
        fields = _GRIDS.get(card[0], ())
        return [str(new[int(v)]) if k in fields else v for k, v in enumerate(card)]

    return Variant(_copied(case, folder, change), test)


def shuffled(case: Path, folder: Path, test: Measurement, rng: np.random.Generator) -> Variant:
    """Put sensors, their directions and modes in another order."""
    del folder
    modes = test.modes
    assert modes is not None
    rows, columns = rng.permutation(len(modes.dofs)), rng.permutation(len(modes))
    nodes = rng.permutation(len(test.geometry.ids))
    geometry = replace(
        test.geometry, ids=test.geometry.ids[nodes], xyz=test.geometry.xyz[nodes], elements={},
        element_ids={},
    )  # fmt: skip
    other = replace(
        modes,
        frequencies_hz=modes.frequencies_hz[columns],
        shapes=modes.shapes[rows][:, columns],
        dofs=modes.dofs.take(rows),
        damping=modes.damping[columns],
        generalized_mass=modes.generalized_mass[columns],
    )
    return Variant(_deck(case), replace(test, geometry=geometry, modes=other))


def relabelled(case: Path, folder: Path, test: Measurement, rng: np.random.Generator) -> Variant:
    """Exchange the numbers of the test's nodes among them."""
    del folder
    modes, ids = test.modes, np.sort(test.geometry.ids)
    assert modes is not None
    new = rng.permutation(ids)

    def named(old: Ints) -> Ints:
        return np.asarray(new[np.searchsorted(ids, old)])

    dofs = replace(modes.dofs, node=named(modes.dofs.node))
    geometry = replace(test.geometry, ids=named(test.geometry.ids), elements={}, element_ids={})
    other = replace(test, geometry=geometry, modes=replace(modes, dofs=dofs))
    return Variant(_deck(case), other, labels=dict(zip(new.tolist(), ids.tolist(), strict=True)))


def turned(case: Path, folder: Path, test: Measurement, rng: np.random.Generator) -> Variant:
    """Exchange the axes of deck and test."""
    del rng

    def change(card: Card) -> Card:
        fields = _VECTORS.get(card[0])
        if not fields:
            return card
        vector = TURN @ [number(card[k]) for k in fields]
        new = dict(zip(fields, (f"{v:.9E}" for v in vector), strict=True))
        return [new.get(k, v) for k, v in enumerate(card)]

    modes = test.modes
    assert modes is not None
    axis = modes.dofs.axis @ TURN.T
    component = np.argmax(np.abs(axis), axis=1) + 1
    dofs = Dofs(modes.dofs.node, np.asarray(component, dtype=np.int64), axis)
    geometry: Geometry = replace(test.geometry, xyz=test.geometry.xyz @ TURN.T)
    other = replace(test, geometry=geometry, modes=replace(modes, dofs=dofs))
    return Variant(_copied(case, folder, change), other, turn=TURN)


def in_metres(case: Path, folder: Path, test: Measurement, rng: np.random.Generator) -> Variant:
    """Write the deck in m, kg, N, s."""
    del rng

    def change(card: Card) -> Card:
        factors = _METRES.get(card[0], {})
        return [
            f"{factors[k] * number(v):.9E}" if k in factors and v else v for k, v in enumerate(card)
        ]

    return Variant(_copied(case, folder, change), test, unit="m")


def breathed(case: Path, folder: Path, test: Measurement, rng: np.random.Generator) -> Variant:
    """Add noise of 1e-6 to frequencies and shapes."""
    del folder
    modes = test.modes
    assert modes is not None
    hz = modes.frequencies_hz * (1.0 + 1e-6 * rng.standard_normal(len(modes)))
    level = np.sqrt(np.mean(np.abs(modes.shapes) ** 2, axis=0))
    shapes = modes.shapes + 1e-6 * level * rng.standard_normal(modes.shapes.shape)
    return Variant(
        _deck(case), replace(test, modes=replace(modes, frequencies_hz=hz, shapes=shapes))
    )


def as_it_is(case: Path, folder: Path, test: Measurement, rng: np.random.Generator) -> Variant:
    """Leave everything; for other threads or another machine."""
    del folder, rng
    return Variant(_deck(case), test)


WAYS: dict[str, Callable[[Path, Path, Measurement, np.random.Generator], Variant]] = {
    f.__name__: f for f in (as_it_is, renumbered, shuffled, relabelled, turned, in_metres, breathed)
}


def alike(one: list[Json], other: list[Json], size: float, tenth: float = 0.1) -> list[str]:
    """Return what differs between findings that `Variant.back` gave: nothing, if all is well.

    Kinds and sensors are the same, places within 1e-3 of the structure, sizes within a tenth of
    the interval.
    """
    told: list[str] = []
    kinds, others = (sorted(str(f["what"]) for f in found) for found in (one, other))
    if kinds != others:
        return [f"kinds {kinds} and {others}"]
    left = list(other)
    for f in one:
        twin = min((g for g in left if g["what"] == f["what"]), key=lambda g: _away(f, g))
        left.remove(twin)
        if _away(f, twin) > 1e-3 * size or f["sensors"] != twin["sensors"]:
            told.append(f"{f['what']} at {f['xyz']} {f['sensors']} and {twin['xyz']}")
        elif f["size"] is not None and f["interval"] is not None:
            low, high = f["interval"]
            if abs(f["size"] - twin["size"]) > tenth * (high - low):
                told.append(f"{f['what']} of {f['size']} ({low} to {high}) and {twin['size']}")
    return told


def _away(one: Json, other: Json) -> float:
    p, q = (np.array(f["xyz"] or [[0.0] * 3]).mean(axis=0) for f in (one, other))
    return float(np.linalg.norm(p - q))


def answer(case: Path, way: str) -> Json:
    """Return verdict and findings, in mm, t, N, of a case told in one of the `WAYS`."""
    import trueup

    test = trueup.read_test(next(case.glob("*_test.unv")))
    with tempfile.TemporaryDirectory() as work:
        v = WAYS[way](case, Path(work) / "deck", test, np.random.default_rng(1))
        told = trueup.discover(v.deck, v.test, deck_length_unit=v.unit).to_dict()
    return {"verdict": told["verdict"], "findings": [v.back(f) for f in told["findings"]]}


def main() -> int:
    """Print the answer as a line of JSON."""
    a = argparse.ArgumentParser(prog=f"python -m {__package__}.variants", description=__doc__)
    a.add_argument("case", type=Path)
    a.add_argument("way", choices=WAYS)
    o = a.parse_args()
    sys.stdout.write(json.dumps(answer(o.case, o.way)) + "\n")
    return 0


if __name__ == "__main__":
    sys.exit(main())
