"""The modes of a test: its own, or else those that its frequency responses show."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from ..data.measurement import Measurement
from .identify import identify


def with_modes(measurement: Measurement) -> Measurement:
    """Return a test with modes: its own, or else those that its frequency responses show.

    Identified modes are the normalised real ones; their standard errors come along.
    """
    if measurement.modes is not None or measurement.frfs is None:
        return measurement
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
        mpc=found.mpc,
    )
