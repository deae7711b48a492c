"""From what a run says of sensors, findings and misfit to marks on the structure."""

from collections.abc import Sequence

import numpy as np
from scipy.spatial import cKDTree

from ....core.arrays import Floats
from ....core.data.geometry import Geometry
from ....core.discovery.findings import Finding
from ....core.results.correlation import SensorRow
from ..pictures.scene import Mark
from ..tables.number_formats import general


def sensors(
    rows: Sequence[SensorRow], geometry: Geometry, *, directions: bool = True
) -> list[Mark]:
    """Return one mark a test node, where asked with its measured directions."""
    marks = []
    unit = f" {geometry.length_unit}" if geometry.length_unit else ""
    for node in dict.fromkeys(s.node for s in rows):
        own = [s for s in rows if s.node == node]
        note = f"sensor {node}: {', '.join(dict.fromkeys(s.direction for s in own))}"
        note += f"\nnearest grid {own[0].nearest_grid}"
        note += f", {general(own[0].distance, 3)}{unit} from the model"
        axes = np.array([s.axis for s in own]) if directions else None
        marks.append(Mark(np.array(own[-1].xyz), "sensor", note, axes=axes, name=str(node)))
    return marks


def findings(
    found: Sequence[Finding], geometry: Geometry, sensor_marks: Sequence[Mark]
) -> list[Mark]:
    """Return effects and faults at their places, numbered, after the places that do as well."""
    at_sensor = {m.name: m.xyz for m in sensor_marks}
    credible, numbered = list[Mark](), list[Mark]()
    for k, f in enumerate(found, 1):
        if f.side == "test":
            there = [at_sensor[s] for s in map(str, f.where.sensors or ()) if s in at_sensor]
            numbered += [Mark(xyz, "fault", f.sentence, str(k)) for xyz in there]
            continue
        numbered.append(Mark(np.array(f.where.xyz), "effect", f.sentence, str(k)))
        note = f"explains the data about as well as {k}"
        credible += [Mark(np.array(p.xyz), "credible", note) for p in f.credible_set]
    return credible + numbered


def spread(grids: Sequence[int], values: Floats, geometry: Geometry) -> Floats | None:
    """Return a map by node of the geometry, 0..1 of its largest; None where no grid is there.

    Nodes without a value have that of the nearest node with one.
    """
    index = geometry.index_of(np.array(grids, dtype=np.int64))
    known = index >= 0
    if not known.any():
        return None
    amount = values[known] / max(float(np.max(np.abs(values[known]))), 1e-300)
    nearest = cKDTree(geometry.xyz[index[known]]).query(geometry.xyz)[1]
    return np.asarray(amount[nearest])
