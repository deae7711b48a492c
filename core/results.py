"""Results as plain tables: what stands in result.json."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from .comparison import Comparison
from .correlate import Correlation
from .disagreement import Disagreement
from .modes import Modes
from .parameter import Parameter
from .updating import Iteration, Updated

Table = dict[str, Any]


def correlate_tables(c: Comparison) -> Table:
    """Tables of a comparison; mode numbers count from 1 in their own files."""
    tables = correlation_tables(c.correlation, c.test, c.analysis)
    return {**tables, "alignment": _alignment(c), "warnings": list(c.warnings)}


def correlation_tables(found: Correlation, test: Modes, analysis: Modes) -> Table:
    """Pairs, unpaired modes, clusters and MAC matrices of one correlation."""
    return {
        "pairs": [
            {
                "test": p.test + 1,
                "analysis": p.analysis + 1,
                "test_hz": p.test_hz,
                "analysis_hz": p.analysis_hz,
                "deviation_percent": p.deviation_percent,
                "mac": p.mac,
                "cluster": None if p.cluster is None else p.cluster + 1,
                "rotation_deg": p.rotation_deg,
            }
            for p in found.pairs
        ],
        "unpaired_test": [t + 1 for t in found.unpaired_test],
        "unpaired_analysis": [a + 1 for a in found.unpaired_analysis],
        "clusters": [
            {
                "id": k + 1,
                "analysis": [a + 1 for a in cluster.analysis],
                "test": [t + 1 for t in cluster.test],
            }
            for k, cluster in enumerate(found.clusters)
        ],
        "mac": _matrix(found.mac),
        "mac_rotated": _matrix(found.mac_rotated),
        "test_hz": test.frequencies_hz.tolist(),
        "analysis_hz": analysis.frequencies_hz.tolist(),
        "summary": gap(found),
        "criteria": {
            "mac_min": found.criteria.mac_min,
            "frequency_tolerance": found.criteria.frequency_tolerance,
            "cluster_width": found.criteria.cluster_width,
            "rotate": found.criteria.rotate,
        },
    }


def disagreement_tables(c: Comparison, found: Disagreement) -> Table:
    """Return the maps of a misfit: at grids, by mode and by sensor."""
    ids = c.geometry.ids[found.places]
    maps = {"mass": found.mass, "stiffness": found.stiffness, "ground": found.ground}
    labels = c.observation.sensors.labels
    return {
        "grids": ids.tolist(),
        "values": found.motion.tolist(),
        **{name: values.tolist() for name, values in maps.items()},
        "peaks": [
            {
                "of": name,
                "grid": int(ids[k]),
                "xyz": c.geometry.xyz[found.places[k]].tolist(),
                "explained": float(values[k]),
            }
            for name, values in maps.items()
            for k in [int(np.argmax(values))]
        ],
        "modes": [
            {
                "test": p.test + 1,
                "analysis": p.analysis + 1,
                "shape": float(s),
                "frequency": float(f),
            }
            for p, s, f in zip(
                c.correlation.pairs, found.misfit.by_mode, found.misfit.frequency, strict=True
            )
        ],
        "sensors": [
            {"sensor": label, "misfit": float(m), "comac": float(k)}
            for label, m, k in zip(labels, found.misfit.by_sensor, found.misfit.comac, strict=True)
        ],
    }


def gap(found: Correlation) -> Table:
    """Return how far apart model and test are, in four figures."""
    return {
        "pairs": len(found.pairs),
        "mean_abs_deviation_percent": found.mean_abs_deviation_percent,
        "worst_deviation_percent": found.worst_deviation_percent,
        "mean_mac": found.mean_mac,
    }


def parameter_tables(
    parameters: Sequence[Parameter], done: Updated, written: Sequence[Sequence[float]]
) -> list[Table]:
    """Return one row a parameter; `written` are the values of its fields as in the new deck."""
    return [
        {
            "name": q.name,
            "cards": list(q.handle),
            "initial": list(q.deck_values),
            "updated": list(values),
            "factor": float(factor),
            "standard_error": None if np.isnan(error) else float(error),
            "at_bound": bool(bound),
        }
        for q, factor, error, bound, values in zip(
            parameters, done.factors, done.standard_error, done.at_bound, written, strict=True
        )
    ]


def history_tables(history: Sequence[Iteration]) -> list[Table]:
    """Return one row an iteration; a test mode without partner has no deviation."""
    return [
        {
            "iteration": h.iteration,
            "stage": h.stage + 1,
            "objective": h.objective,
            "factors": h.factors.tolist(),
            "deviations_percent": [None if np.isnan(d) else d for d in h.deviations_percent],
        }
        for h in history
    ]


def _matrix(values: np.ndarray[Any, Any]) -> Table:
    return {
        "test": list(range(1, values.shape[0] + 1)),
        "analysis": list(range(1, values.shape[1] + 1)),
        "values": values.tolist(),
    }


def _alignment(c: Comparison) -> Table:
    move, seen = c.alignment, c.observation
    labels = seen.sensors.labels
    return {
        "rotation": move.rotation.tolist(),
        "translation": move.translation.tolist(),
        "scale": move.scale,
        "rms": c.alignment.rms,
        "sensors": [
            {
                "node": int(node),
                "direction": label.split(":")[1],
                "axis": axis.tolist(),
                "xyz": xyz.tolist(),
                "nearest_grid": int(grid),
                "distance": float(distance),
            }
            for node, label, axis, xyz, grid, distance in zip(
                seen.sensors.node,
                labels,
                seen.sensors.axis,
                seen.xyz,
                seen.nearest_grid,
                seen.distance,
                strict=True,
            )
        ],
    }
