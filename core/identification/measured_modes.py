"""The modes of a test: its own, or else those that its frequency responses show."""

from __future__ import annotations

from dataclasses import replace
from typing import TypedDict, Unpack

import numpy as np

from ..data.measurement import Measurement
from ..errors import InputError


class IdentifyOptions(TypedDict, total=False):
    """What an identification can be told, see `identify`."""

    fmin: float
    fmax: float
    max_order: int
    take: tuple[float, ...]
    refuse: tuple[float, ...]
    bands: tuple[tuple[float, float], ...]
    modes: int
    exponential_window: float | str


def with_modes(measurement: Measurement, **options: Unpack[IdentifyOptions]) -> Measurement:
    """Return a test with modes: its own, or else those that its frequency responses show.

    Identified modes are the normalised real ones; their standard errors come along.

    Raises
    ------
    InputError
        Options of an identification where the test has modes; see `identify`.
    """
    if measurement.modes is not None or measurement.frfs is None:
        if options:
            raise InputError(
                f"the test holds modes, so none are identified: {', '.join(options)} would say how"
            )
        return measurement
    from .identify import identify

    found = identify(measurement.frfs, geometry=measurement.geometry, **options)
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
