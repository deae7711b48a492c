"""What a person is told of the sensors."""

from __future__ import annotations

from typing import Any

import numpy as np

from ..observation import Observation
from .faults import Fault
from .findings import Finding
from .sensors import Verdicts
from .wording import test_sentence


def accusations(seen: Observation, tested: Verdicts) -> list[Finding]:
    """Return the findings on the side of the test."""
    return [_accusation(seen, f) for f in tested.faults if f.kind != "doubled"]


def remarks(seen: Observation, tested: Verdicts) -> tuple[str, ...]:
    """Return what is odd about sensors but no finding."""
    nodes = seen.sensors.node
    twice = tuple(
        f"sensor {int(nodes[f.sensors[0]])} reads twice what all the others say, as if two "
        "measurements of it had been added up; its values were halved for the comparison"
        for f in tested.faults
        if f.kind == "doubled"
    )
    odd = np.setdiff1d(nodes[tested.doubtful], nodes[tested.accused])
    if not odd.size:
        return twice
    return (
        *twice,
        f"sensor{'s' if odd.size > 1 else ''} {', '.join(map(str, odd))} may be faulty, or the "
        "model wrong there: too little to say so",
    )


def _accusation(seen: Observation, f: Fault) -> Finding:
    nodes, labels = seen.sensors.node, seen.sensors.labels
    sensors = list(dict.fromkeys(int(nodes[i]) for i in f.sensors))
    rows = np.count_nonzero(np.isin(nodes, sensors))
    where: dict[str, Any] = {
        "sensors": sensors,
        "xyz": seen.xyz[f.sensors[0]].tolist(),
        "region": f"sensor{'s' if len(sensors) > 1 else ''} {' and '.join(map(str, sensors))}",
    }
    names: list[str] = list(map(str, sensors))
    within = f.kind == "sensor_swap" and len(sensors) == 1
    if len(f.sensors) < rows or within:
        names = where["directions"] = [labels[i] for i in f.sensors]
    magnitude: dict[str, Any] = {}
    if f.kind == "sensor_gain":
        magnitude = {"factor": f.factor}
    elif f.kind == "sensor_axis":
        magnitude = {"angle_deg": f.factor, "axis": list(f.axis)}
    interval = None
    if magnitude:
        interval = (f.factor - 1.96 * f.deviation, f.factor + 1.96 * f.deviation)
    return Finding(
        "test",
        f.kind,
        where,
        magnitude,
        interval,
        (),
        f.confidence,
        test_sentence(f.kind, names, f.factor),
    )
