"""From what a run says of sensors, findings and misfit to marks on the structure."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np
from scipy.spatial import cKDTree

from ...core.arrays import Floats, Ints
from ...core.geometry import Geometry
from . import discovery, reading
from .formats import general
from .reading import Result
from .scene import Mark

_AXES = {"X": 0, "Y": 1, "Z": 2}


def sensors(
    rows: Sequence[Result],
    geometry: Geometry,
    xyz: Floats | None,
    misfit_of: Result | None = None,
    *,
    directions: bool = True,
) -> list[Mark]:
    """One mark a test node, with its measured directions.

    Parameters
    ----------
    rows : sequence of mapping
        ``alignment.sensors`` of a result.
    geometry : Geometry
    xyz : (n_row, 3) float, optional
        Positions row by row (or one a node, in order of appearance); default: nearest grids.
    misfit_of : mapping, optional
        A result whose ``misfit.sensors`` colours the marks.
    directions : bool
        Draw the measured directions.
    """
    rows = [{**s, "node": str(s.get("node"))} for s in rows]
    nodes = list(dict.fromkeys(s["node"] for s in rows))
    places = _places(rows, nodes, geometry, xyz)
    amount = _sensor_misfit(misfit_of or {})
    marks = []
    for node in nodes:
        if node not in places:
            continue
        own = [s for s in rows if s["node"] == node]
        axes = [a for s in own if (a := _axis(s)) is not None]
        said = ", ".join(dict.fromkeys(_direction_text(s.get("direction")) for s in own))
        note = f"sensor {node}: {said}" if said else f"sensor {node}"
        if own[0].get("nearest_grid") is not None:
            note += f"\nnearest grid {own[0]['nearest_grid']}"
        if reading.number(own[0].get("distance")) is not None:
            unit = f" {geometry.length_unit}" if geometry.length_unit else ""
            note += f", {general(own[0]['distance'], 3)}{unit} from the model"
        marks.append(
            Mark(
                places[node],
                "sensor",
                note,
                axes=np.array(axes) if axes and directions else None,
                value=amount.get(node),
                name=node,
            )
        )
    return marks


def findings(
    found: Sequence[Result], geometry: Geometry, sensor_marks: Sequence[Mark]
) -> list[Mark]:
    """Effects and faults at their places, numbered, after the places that do as well."""
    at_sensor = {m.name: m.xyz for m in sensor_marks}
    credible: list[Mark] = []
    numbered: list[Mark] = []
    for k, f in enumerate(found, 1):
        note = str(f.get("sentence") or f"{discovery.kind(f)}, {discovery.where(f)}")
        place = reading.part(f, "where")
        if f.get("side") == "test":
            named = reading.texts(place, "sensors")
            numbered += [Mark(at_sensor[s], "fault", note, str(k)) for s in named if s in at_sensor]
            continue
        centre = _point(place.get("xyz"))
        if centre is None:
            centre = _middle(geometry, _grids(place, geometry))
        if centre is not None:
            numbered.append(Mark(centre, "effect", note, str(k)))
        for xyz in _credible(f.get("credible_set"), geometry):
            credible.append(Mark(xyz, "credible", f"explains the data about as well as {k}"))
    return credible + numbered


def misfit(result: Result, geometry: Geometry | None, of: str = "values") -> Floats | None:
    """Return a map of the misfit by node of the geometry, 0..1 of its largest; None without any.

    Nodes without a value have that of the nearest node with one.
    """
    if geometry is None:
        return None
    told = reading.part(result, "misfit")
    grids, values = reading.numbers(told.get("grids")), reading.numbers(told.get(of))
    rows = [
        (g, v)
        for g, v in zip(grids, values, strict=False)
        if g is not None and v is not None and abs(g) < 2**53
    ]
    if not rows:
        return None
    index = geometry.index_of(np.array([int(g) for g, _ in rows], dtype=np.int64))
    amount = np.array([v for _, v in rows])
    known = index >= 0
    if not known.any():
        return None
    amount = amount[known] / max(float(np.max(np.abs(amount))), 1e-300)
    nearest = cKDTree(geometry.xyz[index[known]]).query(geometry.xyz)[1]
    return np.asarray(amount[nearest])


def direction(value: object) -> Floats | None:
    """Return the unit vector of ``+Z``, ``-x``, ``Z`` or of a vector; None for another word."""
    if isinstance(value, str):
        letter = value.strip().lstrip("+-").upper()
        if letter not in _AXES:
            return None
        axis = np.zeros(3)
        axis[_AXES[letter]] = -1.0 if value.strip().startswith("-") else 1.0
        return axis
    vector = reading.numbers(value)
    if len(vector) != 3 or None in vector:
        return None
    axis = np.array(vector, dtype=float)
    length = float(np.linalg.norm(axis))
    return axis / length if length > 0.0 else None


def _axis(row: Result) -> Floats | None:
    told = direction(row.get("axis"))
    return direction(row.get("direction")) if told is None else told


def _direction_text(value: object) -> str:
    if value is None:
        return ""
    if isinstance(value, str):
        return value
    return "(" + ", ".join(general(v, 3) for v in reading.numbers(value)) + ")"


def _places(
    rows: Sequence[Result], nodes: Sequence[str], geometry: Geometry, xyz: Floats | None
) -> dict[str, Floats]:
    """Return positions as given, as told in the rows (``xyz``), or of the nearest grids."""
    if xyz is not None:
        xyz = np.asarray(xyz, dtype=float).reshape(-1, 3)
        if len(xyz) == len(rows):
            return {s["node"]: p for s, p in zip(reversed(rows), xyz[::-1], strict=True)}
        if len(xyz) == len(nodes):
            return dict(zip(nodes, xyz, strict=True))
    near = {s["node"]: reading.identifiers([s.get("nearest_grid")]) for s in rows}
    grids = {n: g[0] for n, g in near.items() if g}
    index = geometry.index_of(np.array(list(grids.values()), dtype=np.int64))
    places = {n: geometry.xyz[k] for n, k in zip(grids, index, strict=True) if k >= 0}
    told = {s["node"]: _point(s.get("xyz")) for s in rows}
    return places | {n: p for n, p in told.items() if p is not None}


def _sensor_misfit(result: Result) -> dict[str, float]:
    rows = reading.records(reading.part(result, "misfit"), "sensors")
    amounts = {str(r.get("node")): reading.number(r.get("value")) for r in rows}
    known = {n: v for n, v in amounts.items() if v is not None}
    most = max(known.values(), default=0.0)
    return {n: v / most for n, v in known.items()} if most > 0.0 else {}


def _grids(place: Mapping[str, object], geometry: Geometry) -> Ints:
    named = reading.identifiers(place.get("grids"))
    index = geometry.index_of(np.array(named, dtype=np.int64))
    return np.asarray(index[index >= 0])


def _middle(geometry: Geometry, index: Ints) -> Floats | None:
    return np.asarray(geometry.xyz[index].mean(axis=0)) if len(index) else None


def _point(value: object) -> Floats | None:
    if isinstance(value, (list, tuple)) and value and isinstance(value[0], (list, tuple)):
        points = [_point(v) for v in value]
        known = [p for p in points if p is not None]
        return np.asarray(np.mean(known, axis=0)) if known else None
    found = reading.numbers(value)
    return np.array(found, dtype=float) if len(found) == 3 and None not in found else None


def _credible(value: object, geometry: Geometry) -> list[Floats]:
    """Places: grid numbers, points, or mappings that hold ``xyz`` or ``grids``."""
    if isinstance(value, Mapping):
        value = [value]
    if not isinstance(value, (list, tuple)):
        return []
    points: list[Floats] = []
    for entry in value:
        if isinstance(entry, Mapping):
            place = reading.part(entry, "where") or entry
            point = _point(place.get("xyz"))
            points += [point] if point is not None else list(geometry.xyz[_grids(place, geometry)])
        elif isinstance(entry, (list, tuple)):
            point = _point(entry)
            points += [] if point is None else [point]
        else:
            points += list(geometry.xyz[_grids({"grids": [entry]}, geometry)])
    return points
