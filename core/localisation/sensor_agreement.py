"""How well each sensor agrees with the model over the modes, and which read the wrong way round."""

from dataclasses import dataclass

import numpy as np

from ..arrays import Bools, Floats, Numbers
from ..correlation.mac import realised
from ..correlation.mode_pairing import Correlation
from ..correlation.sensor_criteria import comac
from ..noun import Noun
from .localisation_numbers import MAPS


@dataclass(frozen=True, eq=False)
class SensorAgreement(Noun):
    """Sensors against the model, over the pairs and the test modes that nearly have one.

    Parameters
    ----------
    comac : (n_sensor,) float
        Coordinate modal assurance criterion, 0..1; NaN where a sensor does not move.
    misfit : (n_sensor,) float
        Rms difference of its readings from the model's, over the rms of the shapes.
    reversed_mac : (n_sensor,) float
        Mean MAC of those modes were the sensor turned round.
    mac : float
        Their mean MAC as it is.
    modes : int
        How many they are.
    suspect : (n_sensor,) bool
        Turned round it explains part of what is missing.
    """

    comac: Floats
    misfit: Floats
    reversed_mac: Floats
    mac: float
    modes: int
    suspect: Bools


def sensor_agreement(
    found: Correlation, analysis_shapes: Floats, test_shapes: Numbers
) -> SensorAgreement | None:
    """Compare the readings of each sensor; None where no test mode resembles an analysis mode.

    As `correlate` had them: `analysis_shapes` (n_sensor, n_analysis), `test_shapes`
    (n_sensor, n_test) real or complex.
    """
    test = realised(test_shapes)
    if found.criteria.rotate == "test":
        length = np.maximum(np.linalg.norm(test, axis=0), np.finfo(float).tiny)
        test = (test / length) @ found.transformation
    elif found.criteria.rotate == "analysis":
        analysis_shapes = analysis_shapes @ found.transformation
    likely = {p.test: p.analysis for p in found.pairs}
    alone = np.isin(np.arange(found.mac.shape[1]), found.unpaired_analysis)
    for k in found.unpaired_test:
        row = np.where(alone, np.nan_to_num(found.mac_rotated[k]), 0.0)
        if row.max(initial=0.0) >= MAPS.likely:
            likely[k] = int(np.argmax(row))
    if not likely:
        return None
    readings = test[:, list(likely)], analysis_shapes[:, list(likely.values())]
    t, a = (s / np.maximum(np.linalg.norm(s, axis=0), np.finfo(float).tiny) for s in readings)
    inner = np.sum(t * a, axis=0)
    a, inner = a * np.where(inner < 0.0, -1.0, 1.0), np.abs(inner)
    turned = np.mean((inner - 2.0 * t * a) ** 2, axis=1)
    whole = float(np.mean(inner**2))
    suspect = turned - whole > MAPS.turned * (1.0 - whole)
    misfit = np.sqrt(np.mean((t - a * inner) ** 2, axis=1) * len(t))
    few = len(likely) < MAPS.few_pairs or len(t) < MAPS.few_sensors
    return SensorAgreement(
        comac(a * inner, t), misfit, turned, whole, len(likely), suspect & (not few)
    )
