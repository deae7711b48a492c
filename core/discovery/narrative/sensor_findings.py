"""What a person is told of the sensors."""

from dataclasses import replace
from typing import Any

import numpy as np

from ...sensors.sensor_map import Observation
from ..faults import FAULTS, Fault
from ..findings import Finding, Where
from ..likelihood.likelihood_numbers import LIKELIHOOD
from ..sensor_faults.diagnosis import Verdicts
from .narrative_numbers import NARRATIVE


def accusations(seen: Observation, tested: Verdicts) -> list[Finding]:
    """Return the findings on the side of the test."""
    return [_accusation(seen, f) for f in tested.faults]


def remarks(seen: Observation, tested: Verdicts) -> tuple[str, ...]:
    """Return what is odd about sensors but no finding."""
    nodes = seen.sensors.node
    odd = np.setdiff1d(nodes[tested.doubtful], nodes[tested.accused])
    if not odd.size:
        return ()
    return (
        f"sensor{'s' if odd.size > 1 else ''} {', '.join(map(str, odd))} may be faulty, or the "
        "model wrong there: too little to say so",
    )


def _accusation(seen: Observation, f: Fault) -> Finding:
    nodes, labels = seen.sensors.node, seen.sensors.labels
    kind, own = FAULTS[f.kind], f.sensors
    if kind.exchanges:
        pair = own[: len(own) // 2], own[len(own) // 2 :]
        own = sum(sorted(pair, key=lambda rows: [int(nodes[i]) for i in rows]), ())
    sensors = list(dict.fromkeys(int(nodes[i]) for i in own))
    rows = np.count_nonzero(np.isin(nodes, sensors))
    spot = f"sensor{'s' if len(sensors) > 1 else ''} {' and '.join(map(str, sensors))}"
    where = Where.of({"sensors": sensors}, seen.xyz[own[0]], region=spot)
    names = list(map(str, sensors))
    if len(own) < rows or (kind.exchanges and len(sensors) == 1):
        names = [labels[i] for i in own]
        where = replace(where, directions=tuple(names))
    half = len(names) // 2 if kind.exchanges else len(names)
    first, other = ", ".join(names[:half]), ", ".join(names[half:])
    said = kind.sentence.format(sensors=first, others=other, size=f.factor)
    magnitude: dict[str, Any] = {}
    interval = None
    if kind.magnitude:
        magnitude = {kind.magnitude: f.factor, **({"axis": list(f.axis)} if f.axis else {})}
        off = LIKELIHOOD.interval * f.deviation
        interval = (f.factor - off, f.factor + off)
    sure = f.confidence * (NARRATIVE.like_model if kind.like_model else 1.0)
    return Finding("test", f.kind, where, magnitude, interval, (), sure, f"{said}.")
