"""What damping and frequency responses say of a discovery, as in result.json."""

from __future__ import annotations

from typing import Any

import numpy as np


def damping_tables(
    found: Any, measured: Any, elastic: Any, before: tuple[Any, ...], after: tuple[Any, ...]
) -> dict[str, Any] | None:
    """Return measured damping ratios beside those foretold; None where no dashpot is about.

    Parameters
    ----------
    found : Discovery
    measured : (n_test,) float
    elastic : (n_test,) bool
        Modes that were weighed.
    before, after : (Comparison, Eigensolution, D or None)
        The deck as it was and as completed.
    """
    from ..core.discovery.damping import of_pairs

    if found.damping is None or (before[2] is None and after[2] is None):
        return None
    foretold = []
    levels = (found.damping.without, found.damping.beside)
    for (compared, solution, D), level in zip((before, after), levels, strict=True):
        phi = solution.vectors
        own = np.zeros((phi.shape[1],) * 2) if D is None else np.asarray(phi.T @ (D @ phi))
        pairs = [(p.test, p.analysis) for p in compared.correlation.pairs if elastic[p.test]]
        of_all = np.zeros(len(measured))
        of_all[elastic] = level
        foretold.append(of_pairs(solution.eigenvalues, own, of_all, pairs))
    rows = [
        {
            "test": j + 1,
            "measured": float(z),
            "before": foretold[0].get(j),
            "after": foretold[1].get(j),
        }
        for j, z in enumerate(measured)
        if np.isfinite(z) and z > 0.0
    ]
    return {
        "modes": rows,
        "typical_factor": {key: _typical(rows, key) for key in ("before", "after")},
    }


def response_tables(gap: Any) -> dict[str, Any]:
    """Return how well measured frequency responses are met."""
    return {
        "responses": [
            {"sensor": s, "before": b, "after": a}
            for s, b, a in zip(gap.sensors, gap.before, gap.after, strict=True)
        ],
        "references": list(gap.references),
        "mean_frac": {"before": float(np.mean(gap.before)), "after": float(np.mean(gap.after))},
        "log_misfit": dict(zip(("before", "parameters", "after"), gap.log_misfit, strict=True)),
        "lines": gap.lines,
        "independent_lines": gap.independent,
    }


def _typical(rows: list[dict[str, Any]], key: str) -> float | None:
    """Return exp of the mean |ln foretold/measured|."""
    off = [abs(np.log(r[key] / r["measured"])) for r in rows if r[key]]
    return float(np.exp(np.mean(off))) if off else None
