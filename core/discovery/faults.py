"""Sensors that do not read what they should, and what they should have read."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ..arrays import Bools, Floats


@dataclass(frozen=True, eq=False)
class FaultKind:
    """A way in which a sensor does not read what it should.

    Parameters
    ----------
    name : str
        The fixed word of result.json.
    label : str
        What the report calls it.
    sentence : str
        A template of ``sensors``, ``others`` (of an exchange) and ``size``.
    magnitude : str
        Word of the size in result.json, "" where there is none.
    exchanges : bool
        Whether half of its sensors read what the other half should.
    like_model : bool
        Whether an error of a model may look like it.
    """

    name: str
    label: str
    sentence: str
    magnitude: str = ""
    exchanges: bool = False
    like_model: bool = True


POLARITY = FaultKind(
    "sensor_polarity",
    "sensor polarity",
    "Sensor {sensors} reads with the wrong sign in every mode: it is wired backwards",
    like_model=False,
)
GAIN = FaultKind(
    "sensor_gain",
    "sensor gain",
    "Sensor {sensors} reads {size:.2f} times what all the others say it should there",
    "factor",
)
SWAP = FaultKind(
    "sensor_swap",
    "swapped sensors",
    "Sensors {sensors} and {others} are swapped: each reads what the other should",
    exchanges=True,
    like_model=False,
)
AXIS = FaultKind(
    "sensor_axis",
    "turned sensor axis",
    "Sensor {sensors} is turned by {size:.0f}° from the axes that the test says",
    "angle_deg",
)
FAULTS: dict[str, FaultKind] = {k.name: k for k in (POLARITY, GAIN, SWAP, AXIS)}


@dataclass(frozen=True, eq=False)
class Fault:
    """A sensor that does not read what it should.

    Parameters
    ----------
    kind : str
        One of `FAULTS`.
    sensors : tuple of int
        Rows concerned.
    reads : (n, n) float or None
        What these rows read of what they should; None where that cannot be undone.
    factor, deviation : float
        What is read over what should be, of a turned sensor the angle [deg]; its standard
        deviation.
    axis : tuple of float
        About which a sensor is turned, in the frame of the analysis.
    confidence : float
        Chance that this is what is wrong.
    """

    kind: str
    sensors: tuple[int, ...]
    reads: Floats | None
    factor: float
    deviation: float
    axis: tuple[float, ...]
    confidence: float


def corrected(shapes: Floats, faults: Sequence[Fault]) -> Floats:
    """Return the shapes as sound sensors would have read them.

    What cannot be known of a sensor that is turned away stays as it is; see `lost`.
    """
    out = np.array(shapes)
    for f in faults:
        if f.reads is not None:
            rows = list(f.sensors)
            out[rows] = np.linalg.solve(f.reads, out[rows])
    return out


def accused(faults: Sequence[Fault], n: int) -> Bools:
    """Return which of the sensors any fault concerns, (n,)."""
    return np.isin(np.arange(n), [i for f in faults for i in f.sensors])


def lost(faults: Sequence[Fault], n: int) -> Bools:
    """Return the sensors whose right readings cannot be had from what they read, (n,)."""
    return accused([f for f in faults if f.reads is None], n)
