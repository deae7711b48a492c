"""From measured frequency responses to the modes of a test, and to what is told of them."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from ..core.dofs import Dofs
from ..core.errors import InputError
from ..core.measurement import Measurement

if TYPE_CHECKING:
    from ..adapters.universal import Function, UniversalContent
    from ..core.identification import Identification


def with_modes(measurement: Measurement) -> Measurement:
    """Return a test with modes: its own, or else those that its frequency responses show.

    Identified modes are the normalised real ones; their standard errors come along.
    """
    if measurement.modes is not None or measurement.frfs is None:
        return measurement
    from ..core.identification import identify

    found = identify(measurement.frfs, geometry=measurement.geometry)
    poor = [
        f"identified mode {k + 1} ({f:.2f} Hz): {remark}"
        for k, (f, remark) in enumerate(zip(found.modes.frequencies_hz, found.remarks, strict=True))
        if remark
    ]
    rigid = [f"{k + 1} ({found.modes.frequencies_hz[k]:.2f} Hz)"
             for k in np.flatnonzero(found.suspension)]  # fmt: skip
    if rigid:
        poor.append(
            f"identified mode(s) {', '.join(rigid)} move the whole body without deforming it: "
            "motions on the suspension, to which a free model has no partner"
        )
    return replace(
        measurement,
        modes=found.real_modes,
        warnings=(*measurement.warnings, *found.warnings, *poor),
        frequency_std=found.frequency_std,
        damping_std=found.damping_std,
        shape_std=found.shape_std,
    )


def read_responses(paths: Sequence[Path]) -> UniversalContent:
    """Read files that together hold frequency responses.

    Raises
    ------
    InputError
        A file that is missing; no frequency response among what the files hold.
    """
    from ..adapters.universal import read_universal

    missing = [str(p) for p in paths if not p.is_file()]
    if missing:
        raise InputError(f"{missing[0]} does not exist or is not a file")
    content = read_universal(list(paths))
    if content.frfs is None:
        names = " and ".join(content.files)
        said = [_kind(f) for f in content.functions]
        held = [f"{said.count(kind)} × {kind}" for kind in dict.fromkeys(said)]
        held += ["mode shapes"] if content.modes is not None else []
        held += [f"{s.what} (line {s.line}: {s.why})" for s in content.skipped[:1]]
        what = f"; it holds {', '.join(held)}" if held else ""
        raise InputError(
            f"{names}: no frequency response of motion to a force (dataset 58 or 58b){what}; "
            "give the file that holds them"
        )
    return content


def _kind(function: Function) -> str:
    """Say what a function is; of one called a frequency response, why it cannot be used."""
    if function.kind != "frequency response":
        return function.kind
    real = "" if np.iscomplexobj(function.values) else "real "
    return f"{real}frequency response of {function.quantity} per {function.per}"


def identify_tables(found: Identification) -> dict[str, Any]:
    """Return an identification as in result.json, but for the schema and the files."""
    return {
        "modes": [_mode(found, k) for k in range(len(found.modes))],
        "references": _places(found.references),
        "responses": _places(found.modes.dofs),
        "bands": [{"low_hz": b.band.low, "high_hz": b.band.high} for b in found.bands],
        "quantity": found.quantity,
        "lines": len(found.cmif.frequencies_hz),
        "range_hz": [float(f) for f in found.cmif.frequencies_hz[[0, -1]]],
    }


def _mode(found: Identification, k: int) -> dict[str, Any]:
    each: Mapping[str, Any] = {
        "frequency_hz": found.modes.frequencies_hz,
        "damping_ratio": found.modes.damping,
        "frequency_std": found.frequency_std,
        "damping_std": found.damping_std,
        "mpc": found.mpc,
        "mpd": found.mpd,
        "mode_indicator": found.mode_indicator,
        "quality": found.quality,
        "generalized_mass": found.real_modes.generalized_mass,
    }
    return {
        **{key: float(values[k]) for key, values in each.items()},
        "close_pair_possible": bool(found.close_pair_possible[k]),
        "rigid_body_share": _finite(found.rigid_share[k]),
        "suspension": bool(found.suspension[k]),
        "remark": found.remarks[k],
    }


def _finite(value: float) -> float | None:
    return float(value) if np.isfinite(value) else None


def _places(dofs: Dofs) -> list[dict[str, Any]]:
    return [
        {"node": int(node), "direction": label.split(":", 1)[-1]}
        for node, label in zip(dofs.node, dofs.labels, strict=True)
    ]


def identify_headline(result: Mapping[str, Any]) -> str:
    """Return an identification in one sentence."""
    modes, low_high = result["modes"], result["range_hz"]
    many = f"{len(modes)} mode{'' if len(modes) == 1 else 's'}" if modes else "No mode"
    counts = [(len(result[f"{w}s"]), w) for w in ("response", "reference")]
    of = " and ".join(f"{n} {w}{'' if n == 1 else 's'}" for n, w in counts)
    poor = sum(bool(m["remark"]) for m in modes)
    marked = f"; {poor} marked as poor" if poor else ""
    return f"{many} between {low_high[0]:.4g} and {low_high[1]:.4g} Hz from {of}{marked}."
